#pragma once
/// A system at another nominal speed.
#include <drev/core/system.hpp>

namespace drev {

/// The same system with its reference shaft at the constant speed [rad/s], not 0. Throws ModelError where it has no
/// reference shaft.
System at_speed(const System& system, double speed);

}  // namespace drev
