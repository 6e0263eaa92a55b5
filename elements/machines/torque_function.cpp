#include <drev/core/element.hpp>
#include <drev/elements/machines/torque_function.hpp>

namespace drev {

void TorqueFunction::check(ParameterCheck& check) const {
  const Params& p = params_;
  if (bool(p.torque) == p.formula.has_value())
    check.fail("torque", p.torque ? "both" : "nothing", "",
               "exactly one of torque and formula must be given");
  check.all_finite("breakpoints", p.breakpoints, "s");
  p.gate.check(check);
}

void TorqueFunction::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

}  // namespace drev
