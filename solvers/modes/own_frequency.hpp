#pragma once
/// Modes of systems whose elements have a complex stiffness k*(f): each mode with k* at its own frequency, under the load that these
/// elements carry in time, without the internal nodes of their chains. Internal to modes.cpp and damped_modes.cpp.
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

namespace drev {

/// Undamped, with Re k*: mode m is the m-th one of the system that has it at the frequency of that mode. Throws SolverError where no
/// such frequency is found.
ModeSet modes_at_own_frequency(const System& system, const ModesOptions& options);

/// Damped. Real lambda have Re k*(0): a loss factor states nothing about what does not swing. Throws SolverError where a mode is lost.
DampedModeSet damped_modes_at_own_frequency(const System& system, const DampedModesOptions& options);

}  // namespace drev
