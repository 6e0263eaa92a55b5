#include "solvers/run/run_verdict.hpp"

#include <drev/core/error.hpp>

#include <cmath>
#include <sstream>

namespace drev {

void end_run(RunSummary& summary, const std::string& system, double t, RunStatus status,
             const std::string& what) {
  if (summary.status != RunStatus::success) return;
  summary.status = status;
  std::ostringstream text;
  text.precision(12);
  text << system << ": at t = " << t << " s: " << what;
  summary.reason = text.str();
}

void end_growing_run(RunSummary& summary, const std::string& system, double t, const EnergyBalance& b,
                     double growth_limit) {
  if (!std::isfinite(b.imbalance)) return end_run(summary, system, t, RunStatus::not_finite, "the energy");
  end_run(summary, system, t, RunStatus::unstable,
          "energy grew from nothing to more than " + to_text(growth_limit) +
              " times what was put in; take a smaller step or a method that damps");
}

void judge_energy(RunSummary& summary, double tolerance) {
  const EnergyBalance& b = summary.energy;
  if (summary.status != RunStatus::success) return;
  const double error = b.relative_error();
  if (std::abs(error) <= tolerance) return;
  std::ostringstream text;
  text << "the energy balance is off by " << 100.0 * error << " % ("
       << (error > 0 ? "gained from nothing" : "lost by the method") << ", worst at t = " << b.worst_time
       << " s; at most " << 100.0 * tolerance << " % passes): take a smaller step";
  summary.status = RunStatus::energy_error;
  summary.reason = text.str();
}

}  // namespace drev
