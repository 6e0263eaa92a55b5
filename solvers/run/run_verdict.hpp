#pragma once
/// How runs end: what goes into RunSummary's status and reason. Shared by single runs and runs of many.
#include <drev/solvers/run/run_summary.hpp>

#include <cmath>

namespace drev {

/// Ends a run, unless it ended before.
void end_run(RunSummary& summary, const std::string& system, double t, RunStatus status,
             const std::string& what);
/// Ends a run whose energy is not finite as that, another as unstable.
void end_growing_run(RunSummary& summary, const std::string& system, double t, const EnergyBalance& balance,
                     double growth_limit);
/// Ends a run as unstable where its energy grew from nothing beyond the limit, as not finite where it is so.
inline void check_growth(RunSummary& summary, const std::string& system, double t,
                         const EnergyBalance& balance, double growth_limit) {
  const bool grew = balance.imbalance > growth_limit * balance.given && balance.given > 0.0;
  if (grew || !std::isfinite(balance.imbalance)) end_growing_run(summary, system, t, balance, growth_limit);
}
/// The verdict on summary.energy of a run that came to its end.
void judge_energy(RunSummary& summary, double tolerance);

}  // namespace drev
