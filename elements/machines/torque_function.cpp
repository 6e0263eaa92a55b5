#include <drev/core/element.hpp>
#include <drev/elements/machines/torque_function.hpp>

#include <array>

#include "core/law/ranged.hpp"

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

std::optional<LoadSlopes> TorqueFunction::steepest(const LoadRanges& over) const {
  if (!params_.formula) return std::nullopt;
  const std::array<Ranged, 3> variables = variables_of(over);
  return slopes_of(params_.gate.over(variables[1]) * params_.formula->over(variables));
}

}  // namespace drev
