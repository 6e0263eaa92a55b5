#include "solvers/strength/iacs_m68.hpp"

#include <drev/core/units.hpp>
#include <drev/solvers/strength/section_strength.hpp>

#include <cmath>
#include <limits>

namespace drev {

double polar_section_modulus(double diameter, double bore) {
  return kPi * (std::pow(diameter, 4) - std::pow(bore, 4)) / (16.0 * diameter);
}

namespace iacs_m68 {

double size_factor(double diameter) { return 0.35 + 0.93 * std::pow(1e3 * diameter, -0.2); }

double speed_factor(double speed_ratio) {
  constexpr double kNearRated = 0.9;
  if (!(speed_ratio <= kHighestRatio)) return std::numeric_limits<double>::quiet_NaN();
  return speed_ratio < kNearRated ? 3.0 - 2.0 * speed_ratio * speed_ratio : 1.38;
}

Permissible permissible_stress(double tensile_strength, double shape_factor, double diameter,
                               double speed_ratio) {
  constexpr double kMega = 1e6;
  const double continuous = kMega * (tensile_strength / kMega + 160.0) / 18.0 * shape_factor *
                            size_factor(diameter) * speed_factor(speed_ratio);
  return {continuous, 1.7 * continuous / std::sqrt(shape_factor)};
}

BarredRange barred_range(double critical_speed, double speed_ratio) {
  return {16.0 * critical_speed / (18.0 - speed_ratio), (18.0 - speed_ratio) * critical_speed / 16.0};
}

}  // namespace iacs_m68
}  // namespace drev
