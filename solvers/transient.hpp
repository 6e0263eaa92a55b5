#pragma once
/// Integrates a System in time by an implicit scheme with constant steps, hitting breakpoints and output
/// times exactly, and keeps the energy balance.
#include <functional>
#include <string>
#include <vector>

#include "solvers/energy_monitor.hpp"
#include "solvers/observer.hpp"

namespace drev {

struct TransientOptions {
  StepScheme scheme = average_acceleration();
  double step = 0.0;       ///< s, > 0; cut evenly where a breakpoint or output time asks for it
  double t_start = 0.0;    ///< s
  double t_end = 0.0;      ///< s, > t_start
  StepOptions newton = {};
  /// A step that does not converge is halved up to this many times; then the run ends with an error.
  int max_halvings = 12;
  /// Largest energy error that passes without warning, relative to the run's energy scale [-].
  double energy_tolerance = 1e-2;
  /// A run whose energy grows by this factor over everything that was put in is stopped as unstable [-].
  double energy_growth_limit = 1e6;
  /// Called every 100 steps with the part done, 0..1; return false to stop the run.
  std::function<bool(double)> progress = {};
};

enum class RunStatus {
  success,
  energy_error,  ///< it ran, but the balance is off by more than the tolerance: do not trust it
  unstable,      ///< stopped: energy grew from nothing
  no_convergence,///< stopped: a step could not be solved however small
  not_finite,    ///< stopped: a state or force is NaN or infinite
  interrupted    ///< stopped by the caller
};
const char* to_text(RunStatus status);

struct RunSummary {
  RunStatus status = RunStatus::success;
  std::string reason;        ///< a sentence: what went wrong, when and where; empty on success
  std::string scheme;
  double step = 0.0;         ///< s, as asked for; 0: the method's own
  double t_end = 0.0;        ///< s, reached
  long steps = 0;            ///< accepted
  long halved = 0;           ///< steps that did not converge and were halved
  long iterations = 0;       ///< Newton
  long load_passes = 0;
  long factorizations = 0;
  long contact_changes = 0;  ///< located changes of a law's piece (exact propagation)
  /// Seconds by phase, if StepOptions::time_phases asked for them: loads, linear, contacts, balance,
  /// observers.
  std::vector<std::pair<std::string, double>> phases;
  bool newton_on_contacts = true;  ///< false: sparse tangent
  EnergyBalance energy;
  bool ok() const { return status == RunStatus::success; }
  std::string brief_report() const;
};

/// Runs from the state given (its acceleration is made consistent first) and leaves the last accepted
/// state in it. Observers see every accepted step. Throws ModelError for bad options; a run that ends
/// early says so in the summary and leaves what it had.
RunSummary simulate(const System& system, const TransientOptions& options, State& state,
                    const std::vector<Observer*>& observers = {});

/// The same from the model's initial conditions.
RunSummary simulate(const System& system, const TransientOptions& options,
                    const std::vector<Observer*>& observers = {});

}  // namespace drev
