#include <drev/elements/curve.hpp>

#include "core/law/ranged.hpp"

namespace drev {

Ranged SpeedGate::over(const Ranged& speed) const {
  const auto ramp = [&](const Ranged& inside) { return smaller(1.0, -smaller(0.0, -inside / speed_ramp)); };
  Ranged g(1.0);
  if (gated() && !std::isnan(from_speed)) g = ramp(speed - from_speed);
  if (gated() && !std::isnan(to_speed)) g = g * ramp(to_speed - speed);
  return g;
}

}  // namespace drev
