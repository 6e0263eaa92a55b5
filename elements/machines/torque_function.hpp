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
/// g: the gate by speed (curve.hpp), 1 where none is given.
#include <drev/core/element_interface.hpp>
#include <drev/core/law/load_response.hpp>
#include <drev/elements/curve.hpp>
#include <drev/elements/formula.hpp>

#include <array>
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
    SpeedGate gate = {};                   ///< over the actual speed w
  };
  explicit TorqueFunction(Params params) : params_(std::move(params)) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "torque function"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int /*nodes*/, Terms& terms) const override;

  LoadResponse evaluate(const LoadInput& in) const override {
    return response_of(in, [&](const Dual& angle, const Dual& speed) {
      const Dual f = params_.formula ? params_.formula->at(std::array{angle, speed, Dual(in.t)})
                                     : params_.torque({angle, speed, in.t});
      if (!params_.gate.gated()) return f;
      const CurvePoint gate = params_.gate.at(speed.value);
      return Dual(gate.value, 0.0, gate.slope) * f;
    });
  }
  std::vector<double> breakpoints() const override { return params_.breakpoints; }
  /// Of a formula; nobody knows those of a function.
  std::optional<LoadSlopes> steepest(const LoadRanges& over) const override;

 private:
  Params params_;
};

}  // namespace drev
