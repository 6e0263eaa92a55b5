#pragma once
/// TorqueCurve: a torque over the speed of a node, linear between points: a motor, a brake, a pump.
///
///   tau = g(w) scale table(w)       on the RIGHT side: positive drives the node in the positive sense
///
/// w: actual speed of the node, with its sign; constant before the first and behind the last point. g: the gate by
/// speed (curve.hpp), 1 where none is given: a starter that lets go, a brake that holds up to a speed. About the nominal
/// speed it damps with -dtau/dw (a falling motor curve damps, a rising one drives vibration).
#include <drev/core/element_interface.hpp>
#include <drev/core/load.hpp>
#include <drev/elements/curve.hpp>

#include <algorithm>
#include <vector>

namespace drev {

class TorqueCurve final : public Element, public Load {
 public:
  struct Params {
    std::vector<double> speeds = {};   ///< ascending [rad/s], at least 2
    std::vector<double> torques = {};  ///< at these [N m]
    double scale = 1.0;                ///< factor of the torques [-], finite
    SpeedGate gate = {};               ///< over the actual speed w
  };
  explicit TorqueCurve(Params params) : params_(std::move(params)) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "torque curve"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int /*nodes*/, Terms& terms) const override;

  LoadResponse evaluate(const LoadInput& in) const override {
    const CurvePoint gate = params_.gate.at(in.speed), tau = ungated(in.speed);
    return {.torque = gate.value * tau.value,
            .dtorque_dspeed = gate.value * tau.slope + gate.slope * tau.value};
  }
  std::optional<LoadSlopes> steepest(const LoadRanges& over) const override;

 private:
  CurvePoint ungated(double speed) const {
    const std::vector<double>&w = params_.speeds, &tau = params_.torques;
    if (speed < w.front()) return {params_.scale * tau.front(), 0.0};
    if (speed >= w.back()) return {params_.scale * tau.back(), 0.0};
    const auto i = static_cast<std::size_t>(std::upper_bound(w.begin(), w.end(), speed) - w.begin());
    const double slope = params_.scale * (tau[i] - tau[i - 1]) / (w[i] - w[i - 1]);
    return {params_.scale * tau[i - 1] + slope * (speed - w[i - 1]), slope};
  }

  Params params_;
};

}  // namespace drev
