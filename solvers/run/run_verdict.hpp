#pragma once
/// How runs end: what goes into RunSummary's status and reason. Shared by stepping, exact propagation and
/// lockstep: the same fault has the same message in each.
#include <drev/core/weights.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/run_summary.hpp>

#include <algorithm>
#include <string>

namespace drev {

/// "<system>: at t = <t> s: ", where every message about a run begins.
std::string at_time(const std::string& system, double t);

/// Why the matrix of a step of length h [s] could not be factored: which of mass, damping and stiffness, summed
/// with these weights, spoils it. A whole sentence.
std::string why_no_factor(const System& system, const std::string& scheme, double h, const Weights& weights);

/// Ends a run, unless it ended before.
void end_run(RunSummary& summary, const std::string& system, double t, RunStatus status,
             const std::string& what);
/// Ends a run that its caller stopped.
void end_interrupted(RunSummary& summary, const std::string& system, double t);

/// What is not finite in a step from -> to: a load, its slope or a law's force at the assembler's time and the motion
/// before the step, or where that leads by then (z + v dt), else the motion of an unknown at the step's end, each by its
/// name; empty: none of these.
std::string what_is_not_finite(const Assembler& assembler, const EvaluatedState& from,
                               const EvaluatedState& to);
/// Ends a run as not finite: at from's time with the first of these, else with a law whose force, energy or power is
/// not a number at a later time of the step, else with the energy.
void end_not_finite(RunSummary& summary, const Assembler& assembler, const EvaluatedState& from,
                    const EvaluatedState& to);
/// Ends a run whose first point has an acceleration that is not finite, and says what of it; at the assembler's time.
void check_start(RunSummary& summary, const Assembler& assembler, const EvaluatedState& start);

/// Whether the energy from nothing is more than the limit [-] times what was put in. Two steps in succession of
/// which that is true are unstable: one alone may be a load that sets in on parts at rest, which an explicit
/// step does not move yet, so that no work is seen although they start.
inline bool grew(const EnergyBalance& balance, double growth_limit) {
  return balance.imbalance > std::max(kNoEnergy, growth_limit * balance.given) && balance.given > 0.0;
}
/// Ends a run as unstable: its energy grew from nothing beyond the limit.
void end_growing_run(RunSummary& summary, const std::string& system, double t, double growth_limit);
/// The verdict on summary.energy of a run that came to its end. tolerance: relative to the energy [-].
void judge_energy(RunSummary& summary, double tolerance);

}  // namespace drev
