#pragma once
/// A system at another nominal speed.
#include <drev/core/system.hpp>

namespace drev {

/// The same system with its reference shaft at the constant speed [rad/s], not 0, and with constant forces over the
/// unknowns [N m or N], positive forward; empty: none. Throws ModelError where it has no reference shaft.
System at_speed(const System& system, double speed, const Vector& forces = {});

}  // namespace drev
