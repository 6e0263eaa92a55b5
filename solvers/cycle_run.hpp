#pragma once
/// A run in time over whole cycles, to find what a train does where no periodic motion that is known is stable.
/// Internal to sweep_nonlinear().
///
/// It ends as soon as its motion repeats (cycle_decay.hpp). Figures are then of whole repetitions, each compared with
/// the one before: what they change by, and will by the ratio at which cycles come closer, is their error. A run that
/// does not repeat in the first half of its cycles has the figures of the second, in which it may repeat still.
///
/// Parts that float freely keep their mean speed (speed_hold.hpp).
///
/// Means of a motion that repeats are integrals over the steps (Gauss's rule on the motion inside each), and its extremes are
/// located (Peaks). Statistics are of the ends of steps and four points inside each, one in each quarter, in places
/// that differ from step to step: steps that keep time with the teeth sample a stiffness that jumps without bias.
#include <drev/core/channel.hpp>
#include <drev/core/state.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solvers/speed_hold.hpp"

namespace drev {

struct CycleRunOptions {
  double period = 0.0;     ///< of a cycle [s]
  int cycles = 0;          ///< at most, before what is watched of a motion that repeats; >= 40
  double tolerance = 0.0;  ///< of the figures of a motion that repeats, beside each channel's largest value
  std::vector<std::string> channels = {};   ///< whose figures are found
  int samples = 0;                          ///< of a motion that repeats
  std::vector<FloatingPart> floating = {};  ///< parts whose mean speed is kept
  std::function<bool()> go_on = {};         ///< asked before each cycle; false: end
};

struct CycleRunResult {
  SweptRun run;  ///< without its speed
  /// Unknowns of a motion that repeats at `samples` even times (or some more, a whole number a cycle), the first where
  /// a cycle begins.
  std::vector<Vector> motion;
  bool ended = false;  ///< by go_on: there is nothing
};

/// Where a run begins.
struct RunStart {
  double speed = 0.0;  ///< of the reference shaft, > 0 [rad/s]
  Vector z, v;         ///< empty: the model's initial conditions
};

/// system: at its speed; the cycle begins at the state given. A run that fails has its reason.
CycleRunResult run_cycles(const System& system, State start, const CycleRunOptions& options);

/// A run from each start, side by side on threads (0: one for each processor), each the same whatever their number;
/// options: without period and go_on; turns: of the reference shaft in a cycle. progress: asked by this thread, false ends
/// all; there is nothing then.
std::optional<std::vector<CycleRunResult>> run_at_speeds(const System& system,
                                                         const std::vector<RunStart>& starts, double turns,
                                                         const CycleRunOptions& options, int threads,
                                                         const std::function<bool(double)>& progress);

}  // namespace drev
