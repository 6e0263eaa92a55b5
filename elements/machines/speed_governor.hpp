#pragma once
/// SpeedGovernor: the torque by which a governor answers a deviation of the speed from the nominal one.
///
///   tau = -K_p q' - K_i q           on the RIGHT side; q' = w - w_n, q = int (w - w_n) dt, q = 0 at t = 0
///
/// K_p: proportional gain, or from the speed droop: K_p = rated_torque/(droop rated_speed). K_i: integral gain, which
/// takes the lasting deviation away; 0 leaves the droop. The integral of the speed's deviation is the deviation of the
/// angle, so that the governor is linear, in every method, exactly. The torque acts at the node at once: LIMIT, an
/// actuator's lag and limits of the torque are left out, and at vibratory frequencies it acts like a damper of K_p,
/// which a real one with its lag does not.
///
/// Step dT of the load on an inertia J: J y'' + K_p y' + K_i y = -dT; sigma = K_p/(2 J), w_d^2 = K_i/J - sigma^2,
///   speed deviation -dT/(J w_d) exp(-sigma t) sin(w_d t); without K_i: -dT/K_p (1 - exp(-K_p t/J)).
#include <drev/core/element.hpp>
#include <drev/elements/not_given.hpp>

#include <cmath>

namespace drev {

class SpeedGovernor final : public Element {
 public:
  struct Params {
    double proportional_gain = kNotGiven;  ///< K_p [N m s/rad], >= 0; or the three below
    double integral_gain = 0.0;            ///< K_i [N m/rad], >= 0
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
  void check(ParameterCheck& check) const override {
    const Params& p = params_;
    check.non_negative("integral_gain", p.integral_gain, "N m/rad");
    if (!std::isnan(p.proportional_gain)) {
      check.non_negative("proportional_gain", p.proportional_gain, "N m s/rad");
      if (!std::isnan(p.droop))
        check.fail("droop", to_text(p.droop), "",
                   "must not be there beside proportional_gain; give one of them");
      return;
    }
    if (!(p.droop > 0.0 && p.droop <= 1.0))
      check.fail("droop", to_text(p.droop), "", "must be > 0 and <= 1; or give proportional_gain");
    check.positive("rated_torque", p.rated_torque, "N m");
    check.positive("rated_speed", p.rated_speed, "rad/s");
  }
  void describe(int nodes, Terms& terms) const override {
    LocalRow b = LocalRow::Zero(nodes);
    b[0] = 1.0;
    terms.deviation_damping = proportional_gain() * b * b.transpose();
    terms.stiffness(0, 0) = params_.integral_gain;
    if (params_.integral_gain > 0.0)
      terms.speed_ratio_constraints.push_back({.b = b, .holds_deviation = true});
    terms.outputs.push_back(
        {.suffix = "", .stiffness = params_.integral_gain * b, .damping = proportional_gain() * b});
  }

 private:
  Params params_;
};

}  // namespace drev
