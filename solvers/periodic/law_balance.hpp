#pragma once
/// Harmonic balance of a drivetrain in the inputs of its laws alone, over the angle psi = phi/turns of a cycle:
///
///   x(psi) = Re sum_n X_n exp(i n psi), n = 0..H        W = w/turns, d/dt = W d/dpsi
///   R_n = X_n - B_x' S_n^-1 (p_n - B_y Y_n[x]) = 0      S_n = K + i n W C - (n W)^2 M
///
/// x: deflections of the nonlinear laws, twists of nodes whose loads follow them, deviations of nodes that a
/// mesh stiffness follows. Everything linear is eliminated by one sparse factorisation for each harmonic
/// (complex_elimination.hpp), so that Newton's matrix has (2H + 1) rows for each law, whatever the size of
/// the train. S_n contains each law at its closed stiffness with the loss factor kLoss, which Y_n subtracts
/// again, so that no harmonic meets an undamped resonance of the mesh.
///
/// Y_n is Galerkin's integral 1/pi int y exp(-i n psi) dpsi, by the 8-point Gauss rule over panels that end
/// where a law has a kink or a jump, and where its next piece takes over (bounds in x and x'). It is free of aliasing, and errors of the low harmonics decrease as H^-4
/// where forces have kinks and as H^-3 where they jump (with sampling as N^-2 and N^-1). The tangent comes
/// from the same integrals of the slopes of the laws.
///
/// Parts that float: mean_equilibrium.hpp. Source: M. Krack, J. Gross, Harmonic Balance for Nonlinear Vibration
/// Problems, Springer, 2019, chapters 2 and 3.
#include <Eigen/Core>
#include <array>
#include <complex>
#include <optional>

#include "solvers/periodic/mean_equilibrium.hpp"
#include "solvers/periodic/order_content.hpp"

namespace drev {

class LawBalance {
 public:
  static constexpr double kLoss = 0.2;  ///< loss factor of each law's closed stiffness in S_n [-]
  static constexpr int kPoints = 8;     ///< Gauss points in a panel
  using Complex = std::complex<double>;

  /// turns: turns of the reference shaft in a cycle. balance: as in LinearSweepOptions. What this method
  /// cannot treat is added to findings.
  LawBalance(const System& system, double turns, const std::string& balance, std::vector<Finding>& findings);

  const System& system() const { return system_; }
  double turns() const { return turns_; }
  int inputs() const { return static_cast<int>(inputs_.size()); }
  int harmonics() const { return harmonics_; }
  /// Number of unknowns, which are X_0, Re X_1, Im X_1, ... of each input.
  Eigen::Index size() const { return inputs() * (2 * harmonics_ + 1); }
  void set_harmonics(int harmonics);
  /// X with another number of harmonics: truncated, or extended by zeros.
  Vector resized(const Vector& x, int from, int to) const;

  /// X with every contact closed on the flank that the mean load presses on. False: S is singular.
  bool linear_start(double speed, Vector& x);
  /// R at the speed of the reference shaft [rad/s]. False: S is singular, or a force is not finite.
  bool residual(const Vector& x, double speed, Vector& r);
  /// dR/dX at the point at which residual() was last called.
  const Eigen::MatrixXd& tangent();
  /// dR/dw by finite differences.
  bool speed_slope(const Vector& x, double speed, Vector& r_w);
  /// Turns a solution with H harmonics into one with 2 H, in place: the upper half is corrected harmonic by
  /// harmonic, the lower half by the tangent. False: the corrections do not converge. harmonics() is 2 H
  /// afterwards.
  bool double_harmonics(double speed, Vector& x);

  /// A stretch of the cycle that holds no kink inside.
  struct Panel {
    double from = 0.0, to = 0.0;
    bool constant = false;  ///< true: the slopes of all terms are constant, equal to those at the first point
  };
  struct Slopes {
    double x = 0.0, rate = 0.0, angle = 0.0;
    bool operator==(const Slopes&) const = default;
  };
  /// The panels of the point at which residual() was last called.
  const std::vector<Panel>& panels() const { return panels_; }
  /// The slopes dy/dx, dy/dx' and dy/dangle of a term at a point of a panel.
  const Slopes& slopes(std::size_t panel, int point, std::size_t term) const {
    return slopes_[(panel * kPoints + static_cast<std::size_t>(point)) * terms_.size() + term];
  }
  /// A law, or a load that follows its node.
  struct Term {
    const ScalarTerm* law = nullptr;
    const LoadTerm* load = nullptr;
    int x = 0, angle = -1;         ///< numbers of the inputs; angle -1: none, or it does not deviate
    std::vector<Entry> row;        ///< row of x, and of the force, over the unknowns
    std::vector<Entry> angle_row;  ///< row of the deviation of the node that the term follows
    double stiffness = 0.0;        ///< closed stiffness that S contains [unit of force per unit of x]
    std::vector<LawBound> bounds;  ///< where its slopes may jump: kinks, and bounds of pieces that follow x'
    std::optional<Gap> gap;
  };
  const std::vector<Term>& terms() const { return terms_; }
  /// A place at which x crosses a kink of a term and the force jumps there by [y] towards growing x.
  struct Jump {
    std::size_t term = 0, panel = 0;  ///< it lies where this panel begins
    double psi = 0.0, impulse = 0.0;  ///< impulse: [y]/|x'|, integral of dy/dx over time
  };
  /// The jumps in the motion at which residual() was last called.
  const std::vector<Jump>& jumps() const { return jumps_; }
  /// Whether no law with a gap leaves its flank in the motion at which residual() was last called.
  bool closed() const { return closed_; }

  /// The motion of all unknowns: z is unknowns x (H + 1).
  bool motion(const Vector& x, double speed, Eigen::MatrixXcd& z);
  /// Unbalanced mean torque of each floating part in the motion at which motion() was last called.
  const Vector& left_over() const { return left_over_; }
  const MeanEquilibrium& mean() const { return *mean_; }
  /// The response of a term's law to its input and angle in the motion X at psi.
  ScalarResponse respond(const Term& term, const Vector& x, double speed, double psi) const;
  /// Deflection of a law at psi: its input x minus its offset e.
  double deflection(const Term& term, const Vector& x, double speed, double psi) const {
    return value(x, term.x, speed, psi).x - offset(term, psi);
  }
  /// The values of the inputs in a state z.
  Vector inputs_of(const Vector& z) const;
  /// Y_n of a term in the motion at which residual() was last called.
  Complex force_line(std::size_t term, const Vector& x, int n) const;
  /// The value Re sum_n X_n exp(i n psi) of an input, and its time derivative.
  struct Value {
    double x = 0.0, rate = 0.0;
  };
  Value value(const Vector& x, int input, double speed, double psi) const;
  /// Mean power that a law turns into heat in the motion at which residual() was last called [W].
  double heat(std::size_t term) const { return heat_[static_cast<Eigen::Index>(term)]; }
  /// -1 where the reference shaft turns backwards, else 1.
  double direction() const { return direction_; }

 private:
  double offset(const Term& term, double psi) const;
  Eigen::MatrixXcd offset_lines() const;
  void find_terms(std::vector<Finding>& findings);
  bool set_speed(double speed);
  ScalarInput law_input(const Term& term, Value x, double angle, double speed, double psi) const;
  ScalarResponse respond(const Term& term, Value x, double angle, double speed, double psi) const;
  double angle_of(const Term& term, const Vector& x, double speed, double psi) const {
    return term.angle < 0 ? 0.0 : value(x, term.angle, speed, psi).x;
  }
  void find_panels(const Vector& x, double speed, const Eigen::MatrixXd& values,
                   const Eigen::MatrixXd& rates);
  void add_bounds(const Vector& x, double speed, const Eigen::MatrixXd& values, const Eigen::MatrixXd& rates,
                  std::vector<double>& cuts);
  void add_jump(std::size_t term, double kink, const Vector& x, double speed, double psi);
  void add_knots(const Vector& x, double speed, std::vector<double>& cuts) const;
  void known_knots();
  void find_forces(const Vector& x, double speed);
  Complex line(const Vector& x, int input, int n) const;
  void law_slopes_over(std::size_t term, Eigen::MatrixXcd& lines) const;
  bool stiffness(int n, double speed);

  const System& system_;
  double turns_, direction_ = 1.0;
  Assembler assembler_;
  std::optional<OrderContent> content_;
  std::vector<std::vector<Entry>> load_rows_;
  std::vector<Term> terms_;
  std::vector<std::vector<Entry>> inputs_;
  int harmonics_ = 0;
  Vector mass_, damping_, stiffness_, loss_, damping_here_, stiffness_here_;
  ComplexElimination elimination_;
  std::optional<MeanEquilibrium> mean_;
  std::vector<double> fixed_knots_;  // psi at which an offset kinks
  // B_x' S^-1 p and B_x' S^-1 B_y of each harmonic at the speed of the last call of set_speed().
  double speed_ = 0.0;
  int known_harmonics_ = -1;
  std::vector<Eigen::VectorXcd> known_;
  std::vector<Eigen::MatrixXcd> compliance_;
  // Results at the point at which residual() was last called.
  std::vector<Panel> panels_;
  std::vector<Jump> jumps_;
  std::vector<Slopes> slopes_;
  Eigen::MatrixXcd forces_;  // terms x (H + 1), without the closed stiffness
  Vector heat_, left_over_;
  bool closed_ = true;
  Eigen::MatrixXd tangent_;
  Eigen::MatrixXd table_;  // cosines and sines at the points of equal panels
  int even_ = 0;           // number of equal panels in the table
};

}  // namespace drev
