#pragma once
/// EngineOrderTorque: a torque made of engine orders, on one node.
///
///   tau = mean + sum A_i cos(order_i theta + phase_i)
///
/// on the RIGHT side: positive drives the node forward. theta is the node's actual angle (nominal
/// + deviation); twist_feedback = false takes the nominal one. Orders are per revolution of the
/// node; a four-stroke engine has half orders.
#include <drev/core/element.hpp>
#include <drev/core/load.hpp>
#include <drev/elements/harmonic.hpp>

namespace drev {

class EngineOrderTorque final : public Element, public Load {
 public:
  struct Params {
    std::vector<Harmonic> harmonics = {};  ///< order > 0, amplitude [N m], phase [rad]
    double mean = 0.0;                     ///< N m
    bool twist_feedback = true;
  };
  explicit EngineOrderTorque(Params params) : params_(std::move(params)) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "engine order torque"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override {
    check.finite("mean", params_.mean, "N m");
    check_harmonics(check, "harmonics", params_.harmonics, "N m", false);
  }
  void describe(int /*nodes*/, Terms& terms) const override { terms.loads.push_back({0, this}); }

  LoadResponse evaluate(const LoadInput& in) const override {
    const double twist = params_.twist_feedback ? in.deviation : 0.0;
    const CurvePoint p = sum_at(params_.harmonics, in.nominal_angle + twist);
    return {.torque = params_.mean + p.value, .dtorque_dangle = params_.twist_feedback ? p.slope : 0.0};
  }
  bool depends_on_motion() const override { return params_.twist_feedback; }

 private:
  Params params_;
};

}  // namespace drev
