#pragma once
/// One method with its knob, running it, and which one suits a system.
///
/// The choice follows what the system is, not taste:
///   - linear or piecewise linear (why_not_exact() finds nothing), and not too stiff for the time that is
///     simulated: exact propagation. Nothing is cheaper at any accuracy (docs/which_method.md).
///   - piecewise linear but too stiff, too large or too long for that: average acceleration at the model's
///     step. Exact propagation takes about p = 20 (omega_max T / 3) products; it is too dear where both
///     p is more than the steps T / step of the other, and p (20 + unknowns + 10 contacts) > 2e10 (about
///     half a minute).
///   - anything else: average acceleration at the model's step; the reason names the element.
#include <functional>
#include <string>
#include <vector>

#include "solvers/exact_propagation.hpp"

namespace drev {

struct Method {
  std::string name = "average_acceleration";  ///< "exact", or what step_scheme() knows
  double step = 0.0;       ///< s; 0 for exact; with a tolerance the largest step, 0: no limit
  double tolerance = 0.0;  ///< relative; 0: constant steps
  bool exact() const { return name == "exact"; }
};

/// "exact, tolerance 1e-8", "hht:0.1, step 0.001 s".
std::string to_text(const Method& method);

struct MethodRunOptions {
  double t_start = 0.0, t_end = 0.0;  ///< s
  double energy_tolerance = 0.0;      ///< relative; 0: the method's own
  std::function<bool(double)> progress = {};
};

/// Throws ModelError for a name that is no method, and as simulate() and propagate() do.
RunSummary run_method(const System& system, const Method& method, const MethodRunOptions& options,
                      State& state, const std::vector<Observer*>& observers = {});
/// The same from the model's initial conditions.
RunSummary run_method(const System& system, const Method& method, const MethodRunOptions& options,
                      const std::vector<Observer*>& observers = {});

struct MethodChoice {
  Method method;
  std::string reason;  ///< one sentence without full stop
};

/// duration: to be simulated [s]; step: of a stepping method, if it comes to that [s].
MethodChoice choose_method(const System& system, double duration, double step);

/// max(sqrt |M^-1 K|, |M^-1 C|) [1/s], contacts closed, within some percent from below (20 steps of the power
/// method). Throws SolverError where M is singular.
double fastest_rate(const System& system);

}  // namespace drev
