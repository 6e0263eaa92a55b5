#pragma once
/// Extremum inside a step of the cubic through the values and rates at its ends.
///
///   y(s) = y_0 + d_0 s + (3 D - 2 d_0 - d_1) s^2 + (d_0 + d_1 - 2 D) s^3,   d = rate h,  D = y_1 - y_0
///
/// Error of the value: h^4 |y''''| / 384.
#include <algorithm>
#include <cmath>
#include <optional>

namespace drev {

struct CubicPeak {
  double value = 0.0;
  double s = 0.0;  ///< part of the step, 0..1
};

/// None where the rates at the ends have the same sign.
inline std::optional<CubicPeak> cubic_peak(double y_0, double rate_0, double y_1, double rate_1, double h) {
  if (!(rate_0 * rate_1 < 0.0)) return std::nullopt;
  const double d_0 = rate_0 * h, d_1 = rate_1 * h, rise = y_1 - y_0;
  const double b = 3 * rise - 2 * d_0 - d_1, a = d_0 + d_1 - 2 * rise;
  // The root of d_0 + 2 b s + 3 a s^2 between 0 and 1, where the slope changes sign once.
  const double root = std::sqrt(std::max(b * b - 3 * a * d_0, 0.0));
  const double s = d_0 / (d_0 > 0.0 ? root - b : -root - b);
  if (!(s > 0.0 && s < 1.0)) return std::nullopt;
  return CubicPeak{y_0 + s * (d_0 + s * (b + s * a)), s};
}

}  // namespace drev
