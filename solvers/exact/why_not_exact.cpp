// What of a system forbids exact propagation: one sentence each, with what to use instead.
#include <drev/solvers/exact/exact_propagation.hpp>

namespace drev {

std::optional<std::string> why_not_exact(const System& system) {
  const auto name = [&](ElementId e) { return system.element_instances()[idx(index(e))].name; };
  for (const GeneralTerm& g : system.generals())
    return name(g.element) +
           " is a general element, whose force and history the series does not know; take an implicit method";
  if (system.reference() && !system.reference()->piecewise_quadratic)
    return "the reference motion is an unknown function; constant_speed and run_up are known";
  for (int k = 0; k < system.prescribed_count(); ++k)
    if (system.prescribed()[idx(k)].at && !system.prescribed()[idx(k)].piecewise_quadratic)
      return "the motion of " + system.node_names()[idx(system.prescribed_node(k))] +
             " is an unknown function; one with constant acceleration between its breakpoints can "
             "say so (Motion::piecewise_quadratic)";
  return std::nullopt;
}

}  // namespace drev
