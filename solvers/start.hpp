#pragma once
/// Where a run starts: as the model's initial conditions say, in static equilibrium, or in the periodic steady
/// state, so that its figures are not those of an artificial start.
///
///   rest      the initial conditions of the nodes, which are rest where nothing else is given
///   static    the equilibrium under the mean of what acts over the cycle, moving with the nominal motion;
///             without a cycle, under what acts at t = 0
///   periodic  the periodic motion of the cycle at t = 0 (periodic_response.hpp)
///
/// Where harmonic balance finds no periodic motion (teeth that rattle), the model is run from its static start for
/// as long as it takes to settle, in whole cycles, and the state there is taken; how much it still changes from
/// cycle to cycle is stated as its error. Of a chaotic motion that does not vanish: the start is no steady state then, and
/// FoundStart::unsettled() says so.
///
/// The cycle is the first of these in which everything repeats: the one given, 1, 2 and 4 turns of the reference
/// shaft, the period that all loads' harmonics in time share.
#include <drev/core/system.hpp>
#include <drev/solvers/method.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drev {

enum class Start { rest, static_equilibrium, periodic };

/// "rest", "static", "periodic".
const char* to_text(Start start);
/// The start of that name; nullopt: there is none.
std::optional<Start> start_of(const std::string& name);
/// Every start's name.
std::vector<std::string> start_names();

/// The first of these cycles in which all that acts where nothing deviates repeats, at the speed of the start [s]; 0: none is known.
double load_cycle(const System& system);

struct StartOptions {
  double cycle = 0.0;       ///< s, to be tried first; 0: none
  double duration = 0.0;    ///< s, of the run: the nominal speed must be constant over it for a cycle
  double tolerance = 1e-6;  ///< of the periodic motion, as in PeriodicOptions
  Method method = {};       ///< of the run that settles, where harmonic balance finds none
  std::function<bool(double)> progress = {};  ///< of that run; return false to stop
};

struct FoundStart {
  System system;       ///< with these initial conditions
  std::string how;     ///< what it is, with its residual; a sentence without full stop
  double cycle = 0.0;  ///< s; 0: none
  /// Of a periodic start: PeriodicResponse::error; of one that a run settled on, the largest change of a deviation
  /// or rate over the last cycle beside the largest of them.
  double error = 0.0;
  bool by_run = false;  ///< a periodic start taken from a run, since harmonic balance found no motion
  /// Of a periodic start by harmonic balance without nonlinear laws: the mode that grows beside it (Growth::text()); empty: none
  /// does. Not looked for where a load may depend on the speed in a way that load_damping() does not know.
  std::string growing = {};
  /// Why a periodic start is no steady state: a mode grows, or the run changes by more than kSettledPart from cycle to cycle at its
  /// end. A sentence without full stop; empty: it is one, or was not asked for.
  std::string unsettled() const;
};

/// Throws SolverError with the reason where there is no such state: a part that floats, loads that do not
/// repeat, a run-up, a mode without damping, an element with a history.
FoundStart find_start(const System& system, Start start, const StartOptions& options);

}  // namespace drev
