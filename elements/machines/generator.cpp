#include <drev/core/element.hpp>
#include <drev/elements/machines/generator.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

void Generator::check(ParameterCheck& check) const {
  const Params& p = params_;
  check.finite("torque", p.torque, "N m");
  check.non_negative("synchronous_stiffness", p.synchronous_stiffness, "N m/rad");
  check.non_negative("synchronous_damping", p.synchronous_damping, "N m s/rad");
  check.finite("fault_torque", p.fault_torque, "N m");
  check.finite("fault_torque_double", p.fault_torque_double, "N m");
  check.positive("grid_frequency", p.grid_frequency, "Hz");
  if (faults()) check.non_negative("fault_time", p.fault_time, "s");
  if (!std::isnan(p.fault_decay)) check.positive("fault_decay", p.fault_decay, "s");
  if (!faults() && (p.fault_torque != 0.0 || p.fault_torque_double != 0.0))
    check.fail("fault_time", "NaN", "s", "must be given with the torque of a short circuit");
}

void Generator::describe(int nodes, Terms& terms) const {
  LocalRow b = LocalRow::Zero(nodes);
  b[0] = 1.0;
  terms.loads.push_back({0, this, "gap"});
  if (params_.synchronous_stiffness == 0.0 && params_.synchronous_damping == 0.0) return;
  terms.stiffness(0, 0) = params_.synchronous_stiffness;
  terms.deviation_damping = params_.synchronous_damping * b * b.transpose();
  if (params_.synchronous_stiffness > 0.0)
    terms.speed_ratio_constraints.push_back({.b = b, .holds_deviation = true});
  terms.outputs.push_back({.suffix = "synchronous",
                           .stiffness = params_.synchronous_stiffness * b,
                           .damping = params_.synchronous_damping * b});
}

std::optional<LoadSlopes> Generator::steepest(const LoadRanges& over) const {
  const Params& p = params_;
  const double since = over.t.low - p.fault_time;
  if (!faults() || over.t.high < p.fault_time) return LoadSlopes{};
  // |d/dt e^(-t/T) (A_1 sin w t + A_2 sin 2 w t)| <= e^(-t/T) (|A_1| (w + 1/T) + |A_2| (2 w + 1/T))
  const double w = kTwoPi * p.grid_frequency, fades = std::isnan(p.fault_decay) ? 0.0 : 1.0 / p.fault_decay;
  const double steepest =
      std::abs(p.fault_torque) * (w + fades) + std::abs(p.fault_torque_double) * (2.0 * w + fades);
  return LoadSlopes{.by_time = std::exp(-fades * std::max(0.0, since)) * steepest};
}

}  // namespace drev
