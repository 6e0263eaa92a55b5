#pragma once
/// How runs end: what goes into RunSummary's status and reason. Shared by single runs and runs of many.
#include "solvers/transient.hpp"

namespace drev {

/// Ends a run, unless it ended before.
void end_run(RunSummary& summary, const std::string& system, double t, RunStatus status,
             const std::string& what);
/// Ends it as unstable where its energy grew from nothing beyond the limit, or is not finite.
void check_growth(RunSummary& summary, const std::string& system, double t, const EnergyBalance& balance,
                  double growth_limit);
/// The verdict on summary.energy of a run that came to its end.
void judge_energy(RunSummary& summary, double tolerance);

}  // namespace drev
