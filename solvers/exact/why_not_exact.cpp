// What in a system, or in the options, forbids exact propagation: one sentence each, with what to use instead.
#include <drev/core/law/friction.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include "solvers/run/run_checks.hpp"

namespace drev {

std::optional<std::string> why_not_exact(const System& system, bool steps) {
  const auto name = [&](ElementId e) { return system.element_instances()[idx(index(e))].name; };
  for (const GeneralTerm& g : system.generals())
    return name(g.element) + " is a general element, whose force and history the series does not know" +
           (steps ? "; take an implicit method" : "");
  if (auto why = system.why_not_varying_inertia("exact propagation", steps)) return why;
  for (const FrictionTerm& f : system.frictions()) {
    if (f.friction->rigid())
      for (const Entry& e : f.nodes)
        if (system.node_map(e.index).prescribed >= 0)
          return name(f.element) + " is a lossy gear with a given motion of " +
                 system.node_names()[idx(e.index)] + ": put a shaft between, or take an ideal gear";
    bool moves = false;
    for (const Entry& e : f.nodes) moves = moves || system.node_map(e.index).prescribed < 0;
    if (!moves) return name(f.element) + " rubs between nodes whose motion is given: leave it out";
  }
  if (system.reference() && !system.reference()->piecewise_quadratic)
    return "the reference motion is an unknown function; constant_speed and run_up are known";
  for (int k = 0; k < system.prescribed_count(); ++k)
    if (system.prescribed()[idx(k)].at && !system.prescribed()[idx(k)].piecewise_quadratic)
      return "the motion of " + system.node_names()[idx(system.prescribed_node(k))] +
             " is no polynomial of time, which is what the series knows" +
             (steps ? "; take dormand_prince or an implicit method" : "");
  return std::nullopt;
}

void check_propagation(const System& system, const ExactOptions& o, const State& state) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/exact", findings);
  check.within("tolerance", o.tolerance, o.kTolerance.low, o.kTolerance.high, "");
  check_span(o.t_start, o.t_end, check);
  check.non_negative("energy_tolerance", o.energy_tolerance, "");
  check_state(system, state, check);
  if (const auto why = why_not_exact(system)) check.fail("model", "", "", *why);
  if (!findings.empty()) throw ModelError(findings);
}

}  // namespace drev
