#pragma once
/// The largest half ranges of a nonlinear sweep, section by section, among the motions that a train can have: those that are
/// stable (or not judged) and the runs in time at the speeds asked for, whose errors are known; beside it the highest
/// point of such a curve between these speeds, where it is above.
#include <drev/solvers/nonlinear_sweep.hpp>

#include <string>

#include "app/base/json_values.hpp"

namespace drev::app {

/// A table; empty: no section has a motion.
std::string largest_as_text(const NonlinearSweep& sweep);
/// The list `largest` of an object of kind "branches".
Json largest_objects(const NonlinearSweep& sweep);

}  // namespace drev::app
