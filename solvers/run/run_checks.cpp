#include "solvers/run/run_checks.hpp"

#include <cmath>

namespace drev {

void check_span(double t_start, double t_end, ParameterCheck& check) {
  check.finite("t_start", t_start, "s");
  if (!(t_end > t_start) || !std::isfinite(t_end))
    check.fail("t_end", to_text(t_end), "s", "must be greater than t_start = " + to_text(t_start));
}

void check_observers(const std::vector<Observer*>& observers, const std::string& place,
                     const System* system) {
  std::vector<Finding> findings;
  ParameterCheck check(place, findings);
  for (std::size_t i = 0; i < observers.size(); ++i) {
    const std::string name = "observers[" + std::to_string(i) + "]";
    if (observers[i] == nullptr)
      check.fail(name, "null", "", "must point to an observer");
    else if (system != nullptr && !observers[i]->fits(*system))
      check.fail(name, "made for another system", "",
                 "must be made for the system that runs, or one it is a copy of");
  }
  if (!findings.empty()) throw ModelError(std::move(findings));
}

void check_state(const System& system, const State& state, ParameterCheck& check) {
  if (state.z.size() != system.size() || state.v.size() != system.size())
    check.fail("state", std::to_string(state.z.size()), "unknowns",
               "must have " + std::to_string(system.size()));
  else if (!state.z.allFinite() || !state.v.allFinite() || !state.history.allFinite())
    check.fail("state", "not finite", "", "must be finite");
  if (state.history.size() != system.history_size())
    check.fail("state's history", std::to_string(state.history.size()), "numbers",
               "must have " + std::to_string(system.history_size()));
}

}  // namespace drev
