#pragma once
/// SpeedGovernor: the torque by which a governor answers a deviation of the speed from the nominal one.
///
///   tau = -K_p q' - K_i q           on the RIGHT side; q' = w - w_n, q = int (w - w_n) dt, q = 0 at t = 0
///
/// K_p: proportional gain, or from the speed droop: K_p = rated_torque/(droop rated_speed). K_i: integral gain, which
/// takes the lasting deviation away; 0 leaves the droop. Its integral is the deviation of the angle: the governor is linear, in
/// every method, exactly. Channel: -tau, of the LEFT side, as a spring's. LIMIT: limits of the torque are left out.
///
/// An actuator with a lag T follows by T tau' + tau = -K_p q' - K_i q. Without one the governor acts at vibratory
/// frequencies like a damper of K_p, which a real one does not. The lag is one node more (`ELEMENT_1`), whose matrices
///
///   M = (0, m)   C = (0, -a r; -a r, m (1/T + P))   K = (K_p/T + a^2, -m P/T; -m P/T, m P/T)      r = sqrt(m)
///   k = K_p/T - K_i,   a^2 = k/T/(P - 1/T),   m = (k + a^2) T/P
///
/// seen from the governed node are (K_p s + K_i)/(1 + T s) exactly: a factor (s + P) that both numerator and
/// denominator have cancels; P = 2/T where k > 0, else 1/(2 T). It needs K_i > 0; tau = -K_i q(0) at the start.
///
/// Step dT of the load on an inertia J: J y'' + K_p y' + K_i y = -dT; sigma = K_p/(2 J), w_d^2 = K_i/J - sigma^2,
///   speed deviation -dT/(J w_d) exp(-sigma t) sin(w_d t); without K_i: -dT/K_p (1 - exp(-K_p t/J)).
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>

#include <Eigen/Core>
#include <cmath>

namespace drev {

class SpeedGovernor final : public Element {
 public:
  struct Params {
    double proportional_gain = kNotGiven;  ///< K_p [N m s/rad], >= 0; or the three below
    double integral_gain = 0.0;            ///< K_i [N m/rad], >= 0
    double actuator_lag = 0.0;             ///< T [s], >= 0; 0: none
    double droop = kNotGiven;              ///< speed fall at rated torque over rated speed [-], 0 to 1, not 0
    double rated_torque = kNotGiven;       ///< N m, > 0
    double rated_speed = kNotGiven;        ///< rad/s, > 0
  };
  explicit SpeedGovernor(Params params) : params_(params) {}

  const Params& params() const { return params_; }
  double proportional_gain() const {
    const Params& p = params_;
    return std::isnan(p.proportional_gain) ? p.rated_torque / (p.droop * p.rated_speed) : p.proportional_gain;
  }
  std::string_view type() const override { return "speed governor"; }
  int min_nodes() const override { return 1; }
  std::vector<NodeKind> internal_nodes() const override {
    return std::vector<NodeKind>(params_.actuator_lag > 0.0 ? 1 : 0, NodeKind::rotational);
  }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  /// The matrices above; node 1 is the actuator's.
  static void add_lag(double lag, double k_p, double k_i, Eigen::MatrixXd& damping, Terms& terms);
  Params params_;
};

}  // namespace drev
