#pragma once
/// TorqueFunction: a torque as a formula of a node's speed and angle and of the time: a fan, a pump, a brake, a motor.
///
///   tau = g(w) f(theta, w, t)       on the RIGHT side: positive drives the node in the positive sense
///
/// theta, w: actual angle and speed of the node; t: time. On a translational node a force [N], position and speed. f is
/// written over Dual numbers, so that its slopes by angle and speed, which Newton's method, sweeps and exact propagation
/// need, come by forward differentiation; a model file's `expression` is compiled to the same. It must be pure. Where it
/// kinks or jumps over the time, breakpoints say so; kinks over angle and speed (abs, min, max) cost steps.
///
/// Gate by speed: g = 0 below from_speed and above to_speed, 1 between, and straight over `speed_ramp` inside each end,
/// so that the torque is continuous:
///   g = clamp((w - from_speed)/speed_ramp, 0, 1) clamp((to_speed - w)/speed_ramp, 0, 1)
#include <drev/core/element.hpp>
#include <drev/core/law/dual.hpp>
#include <drev/core/load.hpp>
#include <drev/elements/formula.hpp>
#include <drev/elements/not_given.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <optional>

namespace drev {

/// What the formula sees.
struct TorqueVariables {
  Dual angle, speed;  ///< theta [rad], w [rad/s] (m, m/s)
  double t = 0.0;     ///< s
};

class TorqueFunction final : public Element, public Load {
 public:
  struct Params {
    std::function<Dual(const TorqueVariables&)> torque = {};  ///< f [N m]; pure, callable from any thread
    /// Instead of the function, of the variables angle [rad], speed [rad/s] and time [s], by these numbers.
    std::optional<Formula> formula = {};
    std::vector<double> breakpoints = {};  ///< times at which f jumps or kinks [s]
    double from_speed = kNotGiven;         ///< rad/s; not given: no lower end
    double to_speed = kNotGiven;           ///< rad/s, > from_speed; not given: no upper end
    double speed_ramp = kNotGiven;         ///< rad/s, > 0; needed with either of them
  };
  explicit TorqueFunction(Params params) : params_(std::move(params)) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "torque function"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override {
    const Params& p = params_;
    if (bool(p.torque) == p.formula.has_value())
      check.fail("torque", p.torque ? "both" : "nothing", "",
                 "exactly one of torque and formula must be given");
    check.all_finite("breakpoints", p.breakpoints, "s");
    const bool from = !std::isnan(p.from_speed), to = !std::isnan(p.to_speed);
    if (from) check.finite("from_speed", p.from_speed, "rad/s");
    if (to) check.finite("to_speed", p.to_speed, "rad/s");
    if (from || to) check.positive("speed_ramp", p.speed_ramp, "rad/s");
    if (!from && !to && !std::isnan(p.speed_ramp))
      check.fail("speed_ramp", to_text(p.speed_ramp), "rad/s", "needs from_speed or to_speed");
    if (from && to && !(p.to_speed - p.from_speed >= 2.0 * p.speed_ramp))
      check.fail(
          "to_speed", to_text(p.to_speed), "rad/s",
          "must be above from_speed, " + to_text(p.from_speed) + " rad/s, by two speed_ramps at least");
  }
  void describe(int /*nodes*/, Terms& terms) const override { terms.loads.push_back({0, this}); }

  LoadResponse evaluate(const LoadInput& in) const override {
    const Dual angle(in.nominal_angle + in.deviation, 1.0, 0.0), speed(in.speed, 0.0, 1.0);
    const Dual f = params_.formula ? params_.formula->at(std::array{angle, speed, Dual(in.t)})
                                   : params_.torque({angle, speed, in.t});
    const Dual tau = gated() ? gate(speed) * f : f;
    return {.torque = tau.value, .dtorque_dangle = tau.by_x, .dtorque_dspeed = tau.by_x_dot};
  }
  std::vector<double> breakpoints() const override { return params_.breakpoints; }

 private:
  bool gated() const { return !std::isnan(params_.speed_ramp); }
  Dual gate(const Dual& speed) const {
    const auto ramp = [&](const Dual& inside) {
      return inside.value <= 0.0                  ? Dual(0.0)
             : inside.value >= params_.speed_ramp ? Dual(1.0)
                                                  : inside / params_.speed_ramp;
    };
    Dual g = 1.0;
    if (!std::isnan(params_.from_speed)) g *= ramp(speed - params_.from_speed);
    if (!std::isnan(params_.to_speed)) g *= ramp(params_.to_speed - speed);
    return g;
  }
  Params params_;
};

}  // namespace drev
