#include "solvers/run/run_verdict.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>

#include <cmath>
#include <sstream>

namespace drev {

std::string at_time(const std::string& system, double t) {
  std::ostringstream text;
  text.precision(12);
  text << system << ": at t = " << t << " s: ";
  return text.str();
}

void end_run(RunSummary& summary, const std::string& system, double t, RunStatus status,
             const std::string& what) {
  if (!summary.ok()) return;
  summary.status = status;
  summary.reason = at_time(system, t) + what;
}

void end_interrupted(RunSummary& summary, const std::string& system, double t) {
  end_run(summary, system, t, RunStatus::interrupted, "interrupted");
}

std::string what_is_not_finite(const Assembler& assembler, const EvaluatedState& from,
                               const EvaluatedState& to) {
  const System& system = assembler.system();
  EvaluatedState before;
  before.state = from.state;
  assembler.external(before.state.z, before.state.v, before.p);
  for (int k = 0; k < system.size(); ++k)
    if (!std::isfinite(before.p[k])) return "the load on " + system.unknown_name(k);
  evaluate_laws(assembler, before);
  for (std::size_t j = 0; j < before.responses.size(); ++j)
    if (!std::isfinite(before.responses[j].y))
      return "the force of " + system.element_instances()[idx(index(system.scalars()[j].element))].name;
  for (int k = 0; k < system.size(); ++k)
    if (!std::isfinite(to.state.z[k]) || !std::isfinite(to.state.v[k]))
      return "the motion of " + system.unknown_name(k);
  return "";
}

void end_not_finite(RunSummary& summary, const Assembler& assembler, const EvaluatedState& from,
                    const EvaluatedState& to) {
  const std::string what = what_is_not_finite(assembler, from, to);
  end_run(summary, assembler.system().name(), from.state.t, RunStatus::not_finite,
          (what.empty() ? "the energy" : what) + " is not finite");
}

void check_start(RunSummary& summary, const System& system, const State& state) {
  if (!state.a.allFinite())
    end_run(summary, system.name(), state.t, RunStatus::not_finite, "the initial acceleration is not finite");
}

void end_growing_run(RunSummary& summary, const std::string& system, double t, double growth_limit) {
  end_run(summary, system, t, RunStatus::unstable,
          "energy grew from nothing to more than " + to_text(growth_limit) +
              " times what was put in; take a smaller step or a method that damps");
}

void judge_energy(RunSummary& summary, double tolerance) {
  const EnergyBalance& b = summary.energy;
  if (!summary.ok()) return;
  const double error = b.relative_error();
  if (std::abs(error) <= tolerance) return;
  std::ostringstream text;
  text << "the energy balance is off by " << 100.0 * error << " % ("
       << (error > 0 ? "gained from nothing" : "lost by the method") << ", worst at t = " << b.worst_time
       << " s; at most " << 100.0 * tolerance << " % passes): "
       << (summary.step > 0.0 && summary.tolerance == 0.0 ? "take a smaller step"
                                                          : "ask for a smaller tolerance");
  summary.status = RunStatus::energy_error;
  summary.reason = text.str();
}

}  // namespace drev
