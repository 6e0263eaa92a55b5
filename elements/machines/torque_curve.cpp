#include <drev/core/element.hpp>
#include <drev/elements/machines/torque_curve.hpp>

#include <algorithm>

#include "core/law/ranged.hpp"

namespace drev {

void TorqueCurve::check(ParameterCheck& check) const {
  const Params& p = params_;
  if (p.speeds.size() < 2 || p.torques.size() != p.speeds.size())
    check.fail("curve",
               std::to_string(p.speeds.size()) + " speeds, " + std::to_string(p.torques.size()) + " torques",
               "", "must be as many of each, at least 2");
  check.increasing("curve.speed", p.speeds, "rad/s");
  check.all_finite("curve.torque", p.torques, "N m");
  check.finite("scale", p.scale, "");
  p.gate.check(check);
}

void TorqueCurve::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

std::optional<LoadSlopes> TorqueCurve::steepest(const LoadRanges& over) const {
  const Interval& w = over.speed;
  const CurvePoint low = ungated(w.low), high = ungated(w.high);
  Ranged torque(Interval{std::min(low.value, high.value), std::max(low.value, high.value)});
  Interval slope{std::min(low.slope, high.slope), std::max(low.slope, high.slope)};
  for (std::size_t i = 0; i < params_.speeds.size(); ++i) {
    const double knot = params_.speeds[i];
    if (!(knot >= w.low && knot <= w.high)) continue;
    const CurvePoint at =
        ungated(knot);  // with the slope ahead of it; that behind it is an earlier knot's, or the lower end's
    torque.value = hull(torque.value, {at.value, at.value});
    slope = hull(slope, {at.slope, at.slope});
  }
  torque.by[1] = slope;
  return slopes_of(params_.gate.over(Ranged::variable(1, w)) * torque);
}

}  // namespace drev
