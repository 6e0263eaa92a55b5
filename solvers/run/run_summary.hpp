#pragma once
/// RunSummary: how a run ended and what it did.
#include <drev/solvers/run/energy_balance.hpp>

#include <string>
#include <utility>
#include <vector>

namespace drev {

enum class RunStatus {
  success,
  energy_error,    ///< it ran, but the balance is off by more than the tolerance: do not trust it
  unstable,        ///< stopped: energy grew from nothing
  no_convergence,  ///< stopped: a step could not be solved however small
  not_finite,      ///< stopped: a state or force is NaN or infinite
  interrupted      ///< stopped by the caller
};
const char* to_text(RunStatus status);

/// A friction contact sticks, slides or is open from here on.
struct FrictionEvent {
  double t = 0.0;       ///< s
  std::string element;  ///< its name
  std::string becomes;  ///< to_text(FrictionState)
};

struct RunSummary {
  RunStatus status = RunStatus::success;
  std::string reason;  ///< a sentence: what went wrong, when and where; empty on success
  /// Sentences without full stop on what a figure may be wrong by although the run came to its end; to be shown
  /// before any figure.
  std::vector<std::string> warnings;
  /// Torques of elements so stiff that rounding of their angles leaves less than five digits: the channel, and the error
  /// that it leaves, of its unit (solvers/run/stiff_twists.hpp).
  std::vector<std::pair<std::string, double>> rounding;
  std::string scheme;
  double step = 0.0;       ///< s, as asked for; 0: the method's own
  double tolerance = 0.0;  ///< as asked for; 0: constant steps
  double t_end = 0.0;      ///< s, reached
  long steps = 0;          ///< accepted
  long halved = 0;         ///< steps that did not converge and were shortened
  long rejected = 0;       ///< controlled steps whose error or energy was too large
  long solves = 0;         ///< linear solves with a step or mass matrix: the work
  long located = 0;        ///< passed kinks of laws that a step ended at
  long fallbacks = 0;      ///< steps with a force inside its jump
  /// Controlled steps of 1e-9 of the run, accepted although their error is above its share: a jump inside
  /// that is no contact change nor breakpoint (a stepped mesh stiffness).
  long forced = 0;
  long iterations = 0;  ///< Newton
  long load_passes = 0;
  long factorizations = 0;
  long contact_changes = 0;   ///< located changes of a law's piece (exact propagation)
  long friction_changes = 0;  ///< of dry friction, between sticking and sliding either way
  static constexpr std::size_t kMostFrictionEvents = 1000;
  std::vector<FrictionEvent> friction_events;  ///< of those, the first kMostFrictionEvents, in time
  /// Seconds by phase, if StepOptions::time_phases asked for them: loads, linear, contacts, balance,
  /// observers.
  std::vector<std::pair<std::string, double>> phases;
  bool newton_on_contacts = true;  ///< false: sparse tangent
  EnergyBalance energy;
  bool ok() const { return status == RunStatus::success; }
  std::string brief_report() const;
};

}  // namespace drev
