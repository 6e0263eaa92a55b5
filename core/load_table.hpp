#pragma once
/// A load that is linear in pieces of its angle, said once: as a table. What is linear about a point of it,
/// its stretch, follows from the table.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

namespace drev {

/// A load over a stretch of its angle: torque + time_slope (t - t_0) + angle_slope (theta - theta_0),
/// for low <= theta <= high and up to the load's next breakpoint. theta is the actual angle, or the
/// nominal one of a load that does not depend on motion. The load is continuous at low and high.
struct LoadStretch {
  double torque = 0.0;       ///< at t_0, theta_0 [N m or N]
  double time_slope = 0.0;   ///< N m/s
  double angle_slope = 0.0;  ///< N m/rad
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// A periodic curve of the angle, straight between knots.
struct LoadTable {
  std::span<const double> arguments, values, slopes;  ///< rad, N m, N m/rad to the right of each knot
  double period = 0.0, phase = 0.0;                   ///< rad; entered at theta + phase
  /// Knot k stands at first + k period/n to within a quarter of that: table_loads.hpp then looks it up
  /// without a call.
  bool evenly_spaced = false;

  /// The stretch about an angle. Knots where the slope does not change are passed over. Within rounding of a
  /// knot the stretch ahead of it: above it where direction > 0, else below.
  LoadStretch stretch(double angle, double direction) const;
  /// How near to a knot an argument stands on it [rad].
  static double on_knot(double period, double argument) {
    return 1e-13 * std::max(period, std::abs(argument));
  }
  /// What is wrong with the table: sizes, order of the arguments, slopes, spacing; empty if nothing is.
  std::string fault() const;
};

/// The last knot at or below u, else the first. inverse_spacing: of an evenly spaced table [1/rad], else 0.
inline std::size_t table_segment(std::span<const double> a, double inverse_spacing, double u) {
  const std::size_t n = a.size();
  if (inverse_spacing > 0.0) {
    const double guess = (u - a[0]) * inverse_spacing;
    std::size_t i = guess > 0.0 ? std::min(static_cast<std::size_t>(guess), n - 1) : 0;
    while (i > 0 && u < a[i]) --i;
    while (i + 1 < n && u >= a[i + 1]) ++i;
    return i;
  }
  const auto after = std::upper_bound(a.begin(), a.end(), u);
  return after == a.begin() ? 0 : static_cast<std::size_t>(after - a.begin()) - 1;
}

}  // namespace drev
