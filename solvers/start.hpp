#pragma once
/// Where a run starts: as the model's initial conditions say, in static equilibrium, or in the periodic steady
/// state, so that its figures are not those of an artificial start.
///
///   rest      the initial conditions of the nodes, which are rest where nothing else is given
///   static    the equilibrium under the mean of what acts over the cycle, moving with the nominal motion;
///             without a cycle, under what acts at t = 0
///   periodic  the periodic motion of the cycle at t = 0 (periodic_response.hpp)
///
/// The cycle is the first of these in which everything repeats: the one given, 1, 2 and 4 turns of the reference
/// shaft, the period that all loads' harmonics in time share.
#include <drev/core/system.hpp>

#include <string>

namespace drev {

enum class Start { rest, static_equilibrium, periodic };

/// "rest", "static", "periodic".
const char* to_text(Start start);

struct StartOptions {
  double cycle = 0.0;       ///< s, to be tried first; 0: none
  double duration = 0.0;    ///< s, of the run: the nominal speed must be constant over it for a cycle
  double tolerance = 1e-6;  ///< of the periodic motion, as in PeriodicOptions
};

struct FoundStart {
  System system;       ///< with these initial conditions
  std::string how;     ///< what it is, with its residual; a sentence without full stop
  double cycle = 0.0;  ///< s; 0: none
  double error = 0.0;  ///< of the periodic motion: as in PeriodicResponse
};

/// Throws SolverError with the reason where there is no such state: a part that floats, loads that do not
/// repeat, a run-up, an undamped resonance, no convergence.
FoundStart find_start(const System& system, Start start, const StartOptions& options);

}  // namespace drev
