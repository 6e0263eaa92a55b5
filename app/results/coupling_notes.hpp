#pragma once
/// What a sweep with contacts takes couplings of rubber for.
#include <drev/solvers/nonlinear_sweep.hpp>

#include <string>
#include <vector>

namespace drev::app {

/// Sentences on couplings whose stiffness follows what they carry, or which lose: motions with contacts have them as runs in
/// time do, at `at_mean_torque` and `at_amplitude` and with their chain, where a linear sweep takes each speed's.
std::vector<std::string> coupling_notes(const System& system, const NonlinearSweep& sweep);

}  // namespace drev::app
