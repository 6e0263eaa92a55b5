#include "solvers/at_speed.hpp"

#include "core/system_builder.hpp"

namespace drev {

System at_speed(const System& system, double speed, const Vector& forces) {
  return SystemBuilder::at_speed(system, speed, forces);
}

}  // namespace drev
