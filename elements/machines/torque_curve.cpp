#include <drev/core/element.hpp>
#include <drev/elements/machines/torque_curve.hpp>

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

}  // namespace drev
