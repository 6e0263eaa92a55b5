#pragma once
/// What exact propagation begins with.
#include <drev/core/state.hpp>

namespace drev {

class System;

/// The acceleration at a state, a = M^-1 (p - C v - K z - B y - friction), with what dry friction carries there: its
/// torques and states into the history, stuck contacts at no slip. Throws SolverError for a node without inertia, and
/// where a freewheel turns in the direction that it locks.
void evaluate_start(const System& system, State& state);

}  // namespace drev
