#pragma once
/// How runs end: what goes into RunSummary's status and reason. Shared by single runs and runs of many.
#include <cmath>

#include "solvers/transient.hpp"

namespace drev {

/// Ends a run, unless it ended before.
void end_run(RunSummary& summary, const std::string& system, double t, RunStatus status,
             const std::string& what);
/// Ends it as unstable: its energy grew from nothing beyond the limit, or is not finite.
void end_growing_run(RunSummary& summary, const std::string& system, double t, const EnergyBalance& balance,
                     double growth_limit);
/// Does that where it is so.
inline void check_growth(RunSummary& summary, const std::string& system, double t,
                         const EnergyBalance& balance, double growth_limit) {
  if (!std::isfinite(balance.imbalance) || balance.imbalance > growth_limit * balance.given)
    end_growing_run(summary, system, t, balance, growth_limit);
}
/// The verdict on summary.energy of a run that came to its end.
void judge_energy(RunSummary& summary, double tolerance);

}  // namespace drev
