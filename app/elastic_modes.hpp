#pragma once
/// solve_modes(), for models that may have no elastic mode at all.
#include "solvers/modes.hpp"

namespace drev::app {

inline ModeSet find_modes(const System& system, const ModesOptions& options) {
  ModeSet none;
  none.contact = options.contact;
  none.rigid_modes = system.rigid_mode_count(options.contact);
  return system.size() > none.rigid_modes ? solve_modes(system, options) : none;
}

}  // namespace drev::app
