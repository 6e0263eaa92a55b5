#pragma once
/// Checks of what every run is given: the state it starts from, its span of time and its observers.
#include <drev/core/error.hpp>
#include <drev/core/state.hpp>

#include <string>
#include <vector>

namespace drev {

class Observer;

/// Findings for a state that does not fit the system: sizes, numbers that are not finite.
void check_state(const System& system, const State& state, ParameterCheck& check);
/// Reports a run that has no beginning or no time: t_start finite, t_end finite and greater [s].
void check_span(double t_start, double t_end, ParameterCheck& check);
/// Throws ModelError for observers that are null or do not fit the system that is to run (where it is known), each with
/// its place in the list.
void check_observers(const std::vector<Observer*>& observers, const std::string& place,
                     const System* system = nullptr);

}  // namespace drev
