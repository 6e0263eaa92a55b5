#pragma once
/// A method in time by its name and its tolerance or step, and running it.
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

}  // namespace drev
