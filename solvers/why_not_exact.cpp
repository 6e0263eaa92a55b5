// What of a system forbids exact propagation: one sentence each, with what to use instead.
#include "solvers/exact_propagation.hpp"

namespace drev {

std::optional<std::string> why_not_exact(const System& system) {
  const auto name = [&](ElementId e) { return system.placements()[at(index(e))].name; };
  for (const GeneralTerm& g : system.generals())
    return name(g.element) + " is a general element, whose force is not linear in pieces";
  for (const ScalarTerm& s : system.scalars()) {
    if (s.force->pieces().empty())
      return name(s.element) + ": its law " + std::string(s.force->why_no_pieces());
    if (s.phase_node >= 0) return name(s.element) + ": its law follows an angle";
  }
  for (const LoadTerm& l : system.loads())
    if (system.node_map(l.node).unknown >= 0 && !l.load->stretch(0.0, 0.0, 1.0) &&
        !l.load->series())
      return name(l.element) +
             ": its torque is an unknown function; give it as a table over time (linear between "
             "its points), a cam torque or engine orders";
  if (system.reference() && !system.reference()->piecewise_quadratic)
    return "the reference motion is an unknown function; constant_speed and run_up are known";
  for (int k = 0; k < system.prescribed_count(); ++k)
    if (system.prescribed()[at(k)].at && !system.prescribed()[at(k)].piecewise_quadratic)
      return "the motion of " + system.node_names()[at(system.prescribed_node(k))] +
             " is an unknown function; one with constant acceleration between its breakpoints can "
             "say so (Motion::piecewise_quadratic)";
  return std::nullopt;
}

}  // namespace drev
