#pragma once
/// The steady vibration of a linear system at one speed: what sweep_linear() calls at every speed, on its grid
/// and between. Equations: linear_sweep.hpp.
#include <drev/core/assembler.hpp>
#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <array>

#include "solvers/linear/lane_elimination.hpp"
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
    Eigen::MatrixXcd twist;      ///< the same
    Vector mean, twist_mean, heat;
    Vector unbalanced, load_sum;  ///< of each floating part: left over; sum of |mean torque|
    double input_power = 0.0, dissipated_power = 0.0;
  };

  /// Everything wrong goes to findings; the object is of no use then.
  LinearResponse(const System& system, const LinearSweepOptions& options, const std::vector<double>& orders,
                 std::vector<Finding>& findings);

  /// speed: > 0, of the reference shaft [rad/s]. only: >= 0: number of the one order that is wanted.
  void vibration(double speed, Point& point, int only = -1);
  /// Throws SolverError where the static stiffness is singular although no part floats.
  void mean(double speed, Point& point);

  const std::vector<Section>& sections() const { return sections_; }
  const std::vector<std::string>& floating() const { return mean_->floating(); }
  OrderContent& content() { return *content_; }
  /// Damping with the loads' mean slopes at the speed, on the pattern.
  const Vector& damping_at(double speed);

 private:
  void check_model(bool close_contacts, std::vector<Finding>& findings) const;
  /// Adds the complex stiffnesses at a frequency [rad/s], > 0, to what it factors: Re k* b b' to the stiffness,
  /// Im k*/omega b b' to the damping.
  void add_frequency_terms(double omega);
  /// What the complex stiffnesses carry at the speed, where they follow it: the mean torque from the equilibrium, the
  /// amplitude by solving A = A(response under A) of each, one after the other until all hold. Throws SolverError.
  void find_carried_loads(double speed);
  /// sqrt(sum |X_h|^2) of term t in the response under the loads that are set.
  double amplitude_of(std::size_t t, double speed);
  std::vector<double> load_means(double speed);
  /// Deviations under mean loads at the speed, >= 0; unbalanced and load_sum are those of a Point.
  std::vector<double> mean_motion(double speed, const std::vector<double>& means, Vector& unbalanced,
                                  Vector& load_sum);
  /// The sections' means from deviations.
  void find_means(const std::vector<double>& z, Point& point) const;
  /// What each load of mean 1 leads to alone, and the drag of a speed of 1 rad/s.
  void find_mean_of_parts(Eigen::Index loads);
  void find_active(double speed, int only);
  /// The same at the frequencies of all lanes, to damping_lanes_ and stiffness_lanes_.
  void spread_frequency_terms(const Lanes& w);
  /// Of a frequency term beside what the matrices give, with the internal nodes that are held at rest.
  std::complex<double> beyond(std::size_t term, double omega) const;
  /// Internal nodes of elements that know their complex stiffness without them, which nothing else touches.
  std::vector<bool> find_held();
  /// The amplitudes at up to kLanes orders of those numbered in active_, from place `first` on.
  void solve_orders(double speed, std::size_t first, Point& point);
  /// One lane by the elimination with pivots, b -> x; false: singular, and x = 0.
  bool solve_lane(int lane, double omega);

  const System& system_;
  Assembler assembler_;
  std::vector<double> orders_;
  std::vector<Section> sections_;
  std::optional<OrderContent> content_;
  double direction_ = 1.0;  // sign of the reference shaft's speed
  Vector mass_, damping_, stiffness_, damping_here_, stiffness_here_;
  Vector damping_before_, stiffness_before_;      // of the last speed
  bool plain_ = false;                            // nothing was added to them there
  Vector damping_at_omega_, stiffness_at_omega_;  // with complex stiffnesses; unused without
  /// Places of the pattern that frequency terms add to, which term each, and how often.
  std::vector<int> slots_, slot_terms_;
  std::vector<double> slot_times_;
  std::vector<bool> term_held_;      // of each frequency term: its element's internal nodes are
  std::vector<bool> term_constant_;  // what is beyond them is the same at all frequencies
  bool all_constant_ = false;        // and under all loads, of each term
  std::optional<ComplexElimination> elimination_;
  std::optional<LaneElimination> lanes_;
  bool follows_mean_ = false, follows_amplitude_ = false;  // some complex stiffness
  std::vector<CarriedLoad> carried_;                       // of each frequency term
  std::vector<double> twist_squares_;  // |X_h|^2 of each, summed over the orders that were solved
  Point trial_;
  std::optional<LaneSections> rows_;
  std::vector<int> active_;                        // numbers of the orders that any load has
  LaneArray damping_lanes_, stiffness_lanes_;      // with complex stiffnesses, of each lane; unused without
  bool spread_ = false;                            // they hold the values of this speed
  LaneArray beyond_re_, beyond_im_, beyond_over_;  // of each frequency term; Im over |w|
  LaneArray re_, im_, p_re_, p_im_;                // the solution, and its right side
  std::optional<MeanEquilibrium> mean_;
  /// A column a load, and one of the speed: sections' means, their twists', unbalanced of a Point; its load_sum.
  Eigen::MatrixXd mean_of_parts_, sum_of_parts_;
  Vector given_means_, mean_figures_;
  std::vector<std::vector<Entry>> load_rows_;  // of each of content()'s loads
  std::vector<std::complex<double>> z_;
};

}  // namespace drev
