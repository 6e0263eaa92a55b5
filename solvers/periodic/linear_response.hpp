#pragma once
/// The steady vibration of a linear system at one speed. sweep_linear() calls it at every speed of its grid
/// and between them. Equations: linear_sweep.hpp.
#include <drev/core/assembler.hpp>
#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <array>

#include "solvers/linear/complex_stiffnesses.hpp"
#include "solvers/linear/lane_elimination.hpp"
#include "solvers/modes/damped_pairs.hpp"
#include "solvers/periodic/lane_sections.hpp"
#include "solvers/periodic/mean_equilibrium.hpp"
#include "solvers/periodic/order_content.hpp"
#include "solvers/periodic/section_rows.hpp"

namespace drev {

class LinearResponse {
 public:
  using Section = SectionRows;
  struct Point {
    Eigen::MatrixXcd amplitude;  ///< orders x sections
    Eigen::MatrixXcd twist;      ///< orders x sections
    Vector mean, twist_mean, heat;
    Vector unbalanced, load_sum;  ///< for each floating part: unbalanced mean torque; sum of |mean torque|
    double input_power = 0.0, dissipated_power = 0.0;
  };

  /// All faults are added to findings; if there are any, the object must not be used.
  LinearResponse(const System& system, const LinearSweepOptions& options, const std::vector<double>& orders,
                 std::vector<Finding>& findings);

  /// speed: speed of the reference shaft [rad/s], > 0. only: number of the one order to be solved; -1: all
  /// orders.
  /// Where an order meets a mode that nothing damps, what the mode does not move has the values beside it (Resonance).
  void vibration(double speed, Point& point, int only = -1);
  /// At a speed at which an order meets a mode that nothing damps: from the responses at two distances beside it, towards
  /// which amplitudes grow as one over the distance if the loads excite the mode.
  static constexpr double kNear = 1e-7;  ///< distance from the speed at which that is, relative to it [-]
  struct Resonance {
    bool excited = false;  ///< false: the loads do no work on the mode, and the response is bounded
    std::vector<bool> unbounded = {};  ///< for each section: the mode moves it
    Point near = {};                   ///< response to the order next to the speed
  };
  Resonance resonance(double speed, int order);
  /// Whether the last response is one of several, under as many amplitudes that a complex stiffness may follow: the one with the
  /// largest.
  bool several_amplitudes() const { return several_amplitudes_; }
  /// Throws SolverError where the static stiffness is singular although no part floats.
  void mean(double speed, Point& point);
  /// Right side of the one order that vibration() solved last, and the sections' amplitudes where z is the motion there; both as
  /// if the reference shaft turned forwards.
  Eigen::VectorXcd forces() const;
  Eigen::RowVectorXcd amplitudes_of(const Eigen::VectorXcd& z);
  /// Sign of the reference shaft's speed: backwards amplitudes are complex conjugates.
  double direction() const { return direction_; }

  const std::vector<Section>& sections() const { return sections_; }
  const std::vector<std::string>& floating() const { return mean_->floating(); }
  OrderContent& content() { return *content_; }
  /// Damping values on the pattern, with the loads' mean slopes at the speed.
  const Vector& damping_at(double speed);
  bool follows_mean_torque() const { return follows_mean_; }
  const ComplexStiffnesses& complex_stiffnesses() const { return *complex_; }
  /// ComplexStiffnesses::beyond() for a mode of frequency omega > 0 [rad/s] at the speed: under the mean torque there, and the
  /// amplitude of the element's own matrices.
  std::complex<double> mode_stiffness(std::size_t term, double speed, double omega);
  /// The matrices of a mode of frequency omega > 0 [rad/s] at the speed, with the loads' damping there. part: 0 to 1, of the way from
  /// the mean torque in time to that at the speed.
  ModeMatrices mode_matrices(double speed, double omega, double part = 1.0);

 private:
  void check_model(bool close_contacts, std::vector<Finding>& findings) const;
  /// Adds the complex stiffnesses at a frequency omega > 0 [rad/s] to the matrices to be factored: Re k* b b'
  /// to the stiffness, Im k*/omega b b' to the damping.
  void add_frequency_terms(double omega);
  /// Finds the loads that the complex stiffnesses carry at the speed, where they depend on them: the mean
  /// torque from the static equilibrium; the amplitude by solving A = A(response under A), the largest, for one after the
  /// other until all are satisfied. Throws SolverError.
  void find_carried_loads(double speed);
  /// sqrt(sum |X_h|^2) of term t in the response under the loads that are set.
  double amplitude_of(std::size_t t, double speed);
  /// The mean torques of these loads, where complex stiffnesses depend on them.
  void find_mean_torques(double speed);
  std::vector<double> load_means(double speed);
  /// Deviations under mean loads at the speed, >= 0; unbalanced and load_sum are those of a Point.
  std::vector<double> mean_motion(double speed, const std::vector<double>& means, Vector& unbalanced,
                                  Vector& load_sum);
  /// Finds the means of the sections from the mean deviations z.
  void find_means(const std::vector<double>& z, Point& point) const;
  /// Finds the mean results of each load alone, at a mean of 1, and those of the drag at a speed of 1 rad/s.
  void find_mean_of_parts(Eigen::Index loads);
  void find_active(double speed, int only);
  /// vibration() with infinite amplitudes, and no heat, of the orders without a solution, which lost_orders_ tells.
  void solve(double speed, Point& point, int only);
  /// Size of the motion of the one order that was solved last; infinite: there is no solution.
  double motion() const;
  /// Adds the complex stiffnesses at the frequencies w_ to the stiffness and to the imaginary part of the sets.
  void spread_frequency_terms(int sets);
  /// Of a frequency term, under the load that it carries.
  std::complex<double> beyond(std::size_t term, double omega) const;
  /// The unknowns, one flag each, that a section looks at other than by its complex stiffness.
  std::vector<bool> looked_at() const;
  /// Solves for the amplitudes at up to LaneSections::kFrequencies of the orders numbered in active_, from place
  /// `first` on.
  void solve_orders(double speed, std::size_t first, Point& point);
  /// Finds frequencies and right sides of these orders; returns their number. Lanes of the last set that are not used
  /// repeat the first frequency, without load.
  int give_orders(double speed, std::size_t first);
  /// Solves the orders given, those with a lost pivot one by one; lost_: not 0 where the matrix is singular.
  template <class Value>
  void solve_lanes(int used, const LaneDynamics<Value>& dynamics);
  /// Solves one lane by the elimination with pivoting, b -> x; false: the matrix is singular, and x = 0.
  bool solve_lane(int set, int lane);
  /// Whether the solution z_ changes by its own size where the frequency changes by rounding: dz/d(ln omega) =
  /// S^-1 2 omega^2 M z. What is left of it is rounding then, unless it is without limit.
  bool is_resonant(double omega);
  void add_twist_squares(int used);

  const System& system_;
  Assembler assembler_;
  std::vector<double> orders_;
  std::vector<Section> sections_;
  std::optional<OrderContent> content_;
  double direction_ = 1.0;  // sign of the reference shaft's speed
  Vector mass_, damping_, stiffness_, damping_here_, stiffness_here_;
  Vector damping_before_, stiffness_before_;  // values of the last speed
  bool plain_ = false;                        // nothing was added to the values of the last speed
  // Values with complex stiffnesses; unused without them.
  Vector damping_at_omega_, stiffness_at_omega_, mode_loss_, mode_stiffness_;
  std::optional<ComplexStiffnesses> complex_;
  bool all_constant_ = false;  // true: every term is constant over frequency, whatever load it carries
  std::optional<ComplexElimination> elimination_;
  std::optional<LaneElimination> lanes_;
  // True: some complex stiffness depends on the mean torque, or on the amplitude.
  bool follows_mean_ = false, follows_amplitude_ = false, several_amplitudes_ = false;
  std::vector<CarriedLoad> carried_;   // load that each frequency term carries
  std::vector<double> twist_squares_;  // |X_h|^2 of each term, summed over the orders that were solved
  Point trial_;
  std::optional<LaneSections> rows_;
  std::vector<int> lost_orders_;  // numbers of the orders at which the matrix was singular
  std::vector<int> active_;       // numbers of the orders in which any load has content
  /// Real parts of the complex stiffnesses with the rest of K, and their imaginary parts: common to all frequencies
  /// where they do not depend on these, otherwise of each lane.
  Vector stiffness_common_, loss_common_;
  LaneArray stiffness_lanes_, loss_lanes_;
  bool spread_ = false;              // true: the common ones hold the values of this speed
  LaneArray beyond_re_, beyond_im_;  // beyond() of each frequency term at w_
  LaneArray re_, im_, p_re_, p_im_;  // the solution, and the right side, of each set of lanes
  std::array<LaneRow, kLaneSets> w_{}, lost_{};
  std::vector<std::complex<double>> given_;  // amplitudes of each load at w_
  std::optional<MeanEquilibrium> mean_;
  /// One column for each load and one for the speed. mean_of_parts_: means of the sections, of their twists,
  /// and Point::unbalanced; sum_of_parts_: Point::load_sum.
  Eigen::MatrixXd mean_of_parts_, sum_of_parts_;
  Vector given_means_, mean_figures_;
  std::vector<std::vector<Entry>> load_rows_;       // row of each load of content() over the unknowns
  std::vector<std::vector<std::size_t>> together_;  // numbers of the loads on one unknown, of several each
  std::vector<std::complex<double>> z_;
};

}  // namespace drev
