#pragma once
/// Integrates a System in time, with constant steps or with steps controlled by their estimated error, and
/// keeps the energy balance. Breakpoints of loads and known motions are hit exactly.
#include <drev/core/range.hpp>
#include <drev/core/state.hpp>
#include <drev/solvers/run/run_summary.hpp>
#include <drev/solvers/stepping/step_options.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drev {

class Observer;

struct TransientOptions {
  StepScheme scheme = average_acceleration();
  /// s, > 0; cut evenly where a breakpoint or output time asks for it. A method that is stable for small
  /// steps only refuses one above its limit. With a tolerance: the first and largest step, 0: chosen.
  double step = 0.0;
  /// 0: constant steps. Else the sum of the local errors that the method may make over the run, relative to
  /// the largest deviation and rate so far [-]: steps follow from it (step_control.hpp). The motion itself
  /// may amplify what was made.
  double tolerance = 0.0;
  static constexpr Range kTolerance{1e-13, 0.1};  ///< of controlled steps
  /// End steps where a law passes a kink (located_step.hpp). Default: with a tolerance only. Without it, a
  /// method of higher order than 2 loses that order at every contact change, and a force that jumps
  /// (MeshDamping::contact_only) reduces every method to order 1.
  std::optional<bool> locate_contacts = {};
  double t_start = 0.0;  ///< s
  double t_end = 0.0;    ///< s, > t_start
  StepOptions newton = {};
  /// A step that does not converge is shortened up to this many times; then the run ends with an error. A
  /// force that jumps and still leaves no solution is taken inside its jump, and counted (fallbacks).
  int max_halvings = 12;
  /// Largest energy error that passes without warning, relative to the run's energy scale [-]. A controlled
  /// step that takes more than its share of it is made again with half the length, up to three times.
  double energy_tolerance = 1e-2;
  /// A run whose energy grows by this factor over everything that was put in is stopped as unstable [-].
  double energy_growth_limit = 1e6;
  /// Called every 100 steps with the part done, 0..1; return false to stop the run.
  std::function<bool(double)> progress = {};
};

/// Throws ModelError for options and a state that do not fit the system.
void check_options(const System& system, const TransientOptions& options, const State& state);

/// Runs from the state given (its acceleration is made consistent first) and leaves the last accepted
/// state in it. Observers see every accepted step. Throws ModelError for bad options; a run that ends
/// early says so in the summary and leaves what it had.
RunSummary simulate(const System& system, const TransientOptions& options, State& state,
                    const std::vector<Observer*>& observers = {});

/// The same from the model's initial conditions.
RunSummary simulate(const System& system, const TransientOptions& options,
                    const std::vector<Observer*>& observers = {});

}  // namespace drev
