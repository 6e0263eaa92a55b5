#pragma once
/// Exact propagation: between located contact changes, to rounding where the model is linear in pieces, to
/// the tolerance where it is smooth.
///
/// Between changes M z'' + C z' + K z + sum b_j y_j = p, and each step is its Taylor series, carried to
/// the degree at which it is exact to the tolerance (taylor_series.hpp). Contact changes are roots of
/// polynomials, isolated with a certificate (roots.hpp): none is missed, and the step ends there.
/// Step and degree follow from the series' own decay; there is no step to choose. Mesh stiffness by phase
/// and damping that grows with penetration are products of series (expanded_laws.hpp). Where tables are all that
/// bends inside a step, the knots that angles pass act on its end by one backward sweep (kink_response.hpp). Beside
/// torques that are functions, engine orders, and laws of one's own that are smooth between their kinks, all enter by
/// their projection on polynomials along the path (legendre_projection.hpp).
///
/// What it needs: motions that are piecewise quadratic, no general elements. why_not_exact() says what of
/// a model is not so. A law's jump or kink that it tells of neither by pieces(), kinks() nor next_knot()
/// is passed by short steps.
///
/// Limits: the step is bounded by the fastest mode (omega h <= 3), so that models with very stiff
/// parts are expensive. Rounding grows with the motion's own sensitivity: past the horizon of a rattling
/// system only statistics are comparable, with any method.
#include <drev/core/error.hpp>
#include <drev/core/range.hpp>
#include <drev/core/state.hpp>
#include <drev/solvers/run/run_summary.hpp>

#include <functional>
#include <optional>
#include <string>

namespace drev {

class Observer;

/// A law went over from one piece to another.
struct ContactChange {
  double t = 0.0;        ///< s
  int law = 0;           ///< of System::scalars()
  int from = 0, to = 0;  ///< of its pieces()
};

struct ExactOptions {
  /// Error that the series' truncation may add over the whole run, relative to the largest
  /// deflection and speed so far [-], before the motion itself amplifies it. Shared out evenly over
  /// the time.
  double tolerance = 1e-10;
  static constexpr Range kTolerance{1e-15, 1e-2};
  double t_start = 0.0;  ///< s
  double t_end = 0.0;    ///< s, > t_start
  /// Largest energy error that passes, relative to the run's energy scale [-]. 0: 1e-6, or twice the tolerance
  /// where that is more: energies are quadratic in the motion, whose error the tolerance allows.
  double energy_tolerance = 0.0;
  /// Called every 100 steps with the part done, 0..1; return false to stop the run.
  std::function<bool(double)> progress = {};
  /// Called at every change of a piece.
  std::function<void(const ContactChange&)> on_change = {};
};

/// What keeps the system from being propagated exactly, and what to use instead; nullopt: nothing. steps: a method of
/// steps can be taken in its place, and is advised.
std::optional<std::string> why_not_exact(const System& system, bool steps = true);
/// Throws ModelError with all that propagate() refuses of a system, its options and its start.
void check_propagation(const System& system, const ExactOptions& options, const State& state);

/// A run that could not go on, with what there is of it; its status is success as long as it went.
class RunError : public SolverError {
 public:
  RunError(const SolverError& error, RunSummary so_far) : SolverError(error), summary(std::move(so_far)) {}
  RunSummary summary;
};

/// Runs from the state given and leaves the last state in it. Observers see the end of every step,
/// contact changes and breakpoints among them, and points between, those they ask for among them: to watch
/// a run does not change it. Throws ModelError
/// for bad options and for a system that why_not_exact() refuses, RunError (with time and element) if laws change
/// without end at one time, or friction has no solution. RunSummary.scheme is "exact".
RunSummary propagate(const System& system, const ExactOptions& options, State& state,
                     const std::vector<Observer*>& observers = {});

/// The same from the model's initial conditions.
inline RunSummary propagate(const System& system, const ExactOptions& options,
                            const std::vector<Observer*>& observers = {}) {
  State state = State::initial(system, options.t_start);
  return propagate(system, options, state, observers);
}

}  // namespace drev
