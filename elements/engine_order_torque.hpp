#pragma once
/// EngineOrderTorque: a torque made of engine orders, on one node.
///
///   tau = mean + sum A_i cos(order_i theta + phase_i)
///
/// on the RIGHT side: positive drives the node forward. theta is the node's actual angle (nominal
/// + deviation); twist_feedback = false takes the nominal one. Orders are per revolution of the
/// node; a four-stroke engine has half orders.
#include <drev/core/element_interface.hpp>
#include <drev/core/law/harmonic_load.hpp>
#include <drev/elements/harmonic.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace drev {

class EngineOrderTorque final : public Element, public HarmonicLoad {
 public:
  struct Params {
    std::vector<Harmonic> harmonics = {};  ///< order > 0, amplitude [N m], phase [rad]
    double mean = 0.0;                     ///< N m
    bool twist_feedback = true;
  };
  explicit EngineOrderTorque(Params params) : params_(std::move(params)) {
    for (const Harmonic& h : params_.harmonics)
      terms_.push_back({h.order, h.amplitude * std::cos(h.phase), -h.amplitude * std::sin(h.phase)});
    std::sort(terms_.begin(), terms_.end(), [](auto& a, auto& b) { return a.order < b.order; });
  }

  const Params& params() const { return params_; }
  std::string_view type() const override { return "engine order torque"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int /*nodes*/, Terms& terms) const override;

  LoadResponse evaluate(const LoadInput& in) const override {
    const double twist = params_.twist_feedback ? in.deviation : 0.0;
    LoadResponse r = orders().at(in.nominal_angle + twist);
    if (!params_.twist_feedback) r.dtorque_dangle = 0.0;
    return r;
  }
  bool depends_on_motion() const override { return params_.twist_feedback && !terms_.empty(); }
  /// A mean alone is constant: exact propagation has nothing to project then.
  std::optional<LoadStretch> stretch(double /*t*/, double /*angle*/, double /*direction*/) const override {
    if (!terms_.empty()) return std::nullopt;
    return LoadStretch{.torque = params_.mean};
  }
  LoadOrders orders() const override { return {params_.mean, terms_}; }

 private:
  Params params_;
  std::vector<LoadOrder> terms_;  // the same, by ascending order
};

}  // namespace drev
