#pragma once
/// A method in time by its name and its tolerance or step: running it, and which one suits a system.
#include <drev/solvers/run/run_summary.hpp>

#include <functional>
#include <string>
#include <vector>

namespace drev {

class Observer;
class System;
struct MethodRow;
struct State;

/// The name of exact propagation among the methods.
inline constexpr const char* kExact = "exact";

/// Every method in time: exact propagation, and the step schemes.
const std::vector<MethodRow>& methods();

struct Method {
  std::string name = "average_acceleration";  ///< kExact, or what step_scheme() knows
  double step = 0.0;       ///< s; 0 for exact; with a tolerance the largest step, 0: no limit
  double tolerance = 0.0;  ///< relative; 0: constant steps
  bool exact() const { return name == kExact; }
  bool controlled() const { return !exact() && tolerance > 0.0; }
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

/// Which method in time suits a system.
///
/// The choice follows what the system is, not taste:
///   1. exact propagation, where why_not_exact() finds nothing, for any duration: a long run takes long with every
///      method, and nothing is cheaper (docs/which_method.md) but where the fastest modes are at rest: try_methods().
///   2. dormand_prince with steps controlled to 1e-4, where exact propagation cannot be used (general
///      elements, motions that are unknown functions) and it is affordable.
///   3. sdirk4, controlled likewise: implicit, for what is too stiff, too large or too long for 2.
///   4. average acceleration at the model's step, where errors cannot be estimated: a general element has a
///      history, whose error no estimate sees, or the mass matrix is singular.
///
/// Affordable: 70 (20 + unknowns + 10 contacts) <= 1.5e10 products in all steps of 3/omega of the fastest mode, about half
/// a minute.
struct MethodChoice {
  Method method;
  std::string reason;  ///< one sentence without full stop
  /// What exact propagation would cost, 25 (20 + unknowns + 10 contacts) products in each of these steps; 0 where it cannot
  /// be used.
  double exact_work = 0.0;
};

inline constexpr double kControlledTolerance = 1e-4;  ///< of stepping methods, unless another is asked for

/// duration: to be simulated [s]; step: where it comes to constant steps [s].
MethodChoice choose_method(const System& system, double duration, double step);

/// Laws that have a gap or pieces.
long contact_count(const System& system);

/// max(sqrt |M^-1 K|, |M^-1 C|) [1/s], contacts closed, general elements as at the start, within some percent
/// from below (20 steps of the power method). Throws SolverError where M is singular.
double fastest_rate(const System& system);

/// How many steps a run must take at least: the constant ones asked for; else 3/omega of the fastest mode each, which
/// exact propagation and explicit methods follow, or of the slowest elastic mode for implicit methods. 0: not known.
double least_steps(const System& system, const Method& method, double duration);

/// Whether the chosen method is far more expensive than another that keeps the accuracy: both are tried.
///
///   1. The chosen method runs 1,000 steps, fewer where they are expensive, up to five times as many while its steps
///      still grow behind the start. What it would cost over the whole run follows from the last half of them.
///      Below two seconds it stays.
///   2. The other controlled methods, at the tolerance 1e-4, run 4,000 steps or less in the same way. Where one
///      would be cheap enough, every force and torque must agree with the first at 32 times of its trial, to
///      1e-3 of its peak there, or to 1e-6 of the largest peak.
///   3. One that costs less than a twentieth is taken; less than a quarter where the first would take more than half a
///      minute.
///
/// Costs are counts times weights in nanoseconds that were measured once, no clocks: the same system gives the
/// same answer every time, on every machine.
///
///   exact      products (20 + unknowns + 10 contacts) 2
///              + steps (8000 + 30 unknowns + 4 x 12 (loads + projected laws) 100)
///   stepping   solves (10 (20 + unknowns + 10 contacts) 2 + loads 100)
///
/// The second factor is what a product costs (as above); 4 passes over 12 nodes evaluate the loads of a step.
struct MethodTrial {
  MethodChoice choice;  ///< with the reason of a change; else as it was
  double chosen_ns =
      0.0;                ///< of the whole run with the method first chosen; 0: it came to the end, or failed
  double other_ns = 0.0;  ///< the same of the cheapest other one that keeps the accuracy; 0: none
};

/// A change is made where the chosen method costs more than so many times as much as another: in runs of up to, and of
/// more than, half a minute.
inline constexpr double kTooExpensive = 20.0, kTooExpensiveLong = 4.0;
inline constexpr double kLongRun = 30e9;  ///< half a minute [ns]

/// chosen: by choose_method(), for the same system and duration [s]. progress: returns false to stop trying.
/// Throws nothing of its own: a method that fails in its trial is no candidate.
MethodTrial try_methods(const System& system, const MethodChoice& chosen, double duration,
                        const std::function<bool()>& progress = {});

}  // namespace drev
