#pragma once
/// State: everything that changes. A value: a copy is a checkpoint, one assignment a roll-back.
#include <drev/core/system.hpp>

namespace drev {

struct State {
  double t = 0.0;  ///< s
  Vector z, v, a;  ///< unknown deviations [rad or m], rates, accelerations
  Vector history;  ///< of the general elements and of dry friction

  /// At rest or as the model's initial conditions say; a is zero until a solver makes it consistent.
  static State initial(const System& system, double t = 0.0);
};

}  // namespace drev
