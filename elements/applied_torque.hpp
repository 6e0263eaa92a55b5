#pragma once
/// AppliedTorque: a torque that is a function of time, on one node.
///
///   tau(t) on the RIGHT side: positive drives the node forward
///
/// On a translational node a force [N].
///
/// A function, with the times at which it jumps or kinks as breakpoints (at a jump it must give the
/// value after it); or a TimeTable, which knows its own; or harmonics, sum A cos(2 pi f t + phase).
#include <drev/core/element_interface.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/harmonic.hpp>
#include <drev/elements/time_table.hpp>

#include <functional>
#include <optional>

namespace drev {

class AppliedTorque final : public Element, public Load {
 public:
  struct Params {
    std::function<double(double t)> torque = {};  ///< N m over s; pure, callable from any thread
    std::vector<double> breakpoints = {};         ///< of the function [s]
    std::optional<TimeTable> table = {};          ///< instead of the function: s -> N m
    std::vector<Harmonic> harmonics = {};         ///< or these: order = frequency f [Hz], N m, rad
  };
  explicit AppliedTorque(Params params);

  const Params& params() const { return params_; }
  std::string_view type() const override { return "applied torque"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int /*nodes*/, Terms& terms) const override;

  LoadResponse evaluate(const LoadInput& in) const override {
    if (params_.table) return {.torque = params_.table->at(in.t).value};
    return {.torque = params_.torque ? params_.torque(in.t) : sum_at(sum_, kTwoPi * in.t).value};
  }
  bool depends_on_motion() const override { return false; }
  std::vector<double> frequencies() const override {
    std::vector<double> all;
    for (const Harmonic& h : params_.harmonics) all.push_back(h.order);
    return all;
  }
  std::optional<LoadStretch> stretch(double t, double /*angle*/, double /*direction*/) const override {
    if (!params_.table) return std::nullopt;
    const CurvePoint p = params_.table->at(t);
    return LoadStretch{.torque = p.value, .time_slope = p.slope};
  }
  std::vector<double> breakpoints() const override {
    std::vector<double> all = params_.breakpoints;
    if (params_.table) {
      const std::vector<double> knots = params_.table->breakpoints();
      all.insert(all.end(), knots.begin(), knots.end());
    }
    return all;
  }

 private:
  Params params_;
  std::vector<Harmonic> sum_;  // the harmonics, one of each frequency
};

}  // namespace drev
