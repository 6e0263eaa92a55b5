#pragma once
/// How long what the start of a run excited takes to die away.
#include <drev/core/system.hpp>

#include <string>

namespace drev {

/// What is left of a motion of its own that counts as settled [-].
inline constexpr double kSettledPart = 1e-3;

struct Settling {
  double time = 0.0;   ///< s; infinite: it never settles, or it is not known
  std::string reason;  ///< which motion takes the longest, or why not; a sentence without full stop
};

/// ln(1 / kSettledPart) times the largest time constant -1 / Re lambda of the damped modes, contacts closed, and
/// of the rates of free parts that something drags on; a free rotation that nothing drags on carries no
/// torque, and is left out. Of 400 unknowns at most: beyond, time is infinite and reason says so.
Settling settling_time(const System& system);

}  // namespace drev
