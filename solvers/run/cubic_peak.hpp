#pragma once
/// Extremum inside a step of the cubic through the values and rates at its ends.
///
///   y(s) = y_0 + d_0 s + (3 D - 2 d_0 - d_1) s^2 + (d_0 + d_1 - 2 D) s^3,   d = rate h,  D = y_1 - y_0
///
/// Error of the value: h^4 |y''''| / 384.
#include <drev/core/law/law_piece.hpp>

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

/// Whether the cubic is monotone for certain: slopes of the rise's sign, of at most three times its size (F. N. Fritsch,
/// R. E. Carlson 1980, doi:10.1137/0717021).
inline bool cubic_is_monotone(double y_0, double rate_0, double y_1, double rate_1, double h) {
  const double steepest = 3.0 * (y_1 - y_0), d_0 = h * rate_0, d_1 = h * rate_1;
  return d_0 * (steepest - d_0) >= 0.0 && d_1 * (steepest - d_1) >= 0.0;
}

/// Where between two extrema the slope of a cubic, whose rates at both ends have the same sign, is furthest from them, as a part
/// of the step; none where the cubic is monotone.
inline std::optional<double> cubic_dip(double y_0, double rate_0, double y_1, double rate_1, double h) {
  const double rise = y_1 - y_0, d_0 = h * rate_0, d_1 = h * rate_1;
  const double b = 3 * rise - 2 * d_0 - d_1, a = d_0 + d_1 - 2 * rise;
  // The slope d_0 + 2 b s + 3 a s^2 turns at -b/(3 a), and has two roots if its sign there is not that of the ends.
  const double ends = d_0 + d_1;
  const bool turns = a * ends > 0.0 && b * ends < 0.0 && std::abs(b) < 3 * std::abs(a);
  if (!(d_0 * d_1 >= 0.0 && turns && b * b > 3 * a * d_0)) return std::nullopt;
  return -b / (3 * a);
}

/// max |s (1-s)^2|: how far an end slope d raises a cubic above both ends, or lowers it below, over d.
inline constexpr double kCubicBulge = 4.0 / 27.0;

/// The interval that the cubic stays in: between its ends where it is monotone, else an end slope d raises it above, or lowers
/// it below, both ends by at most max |s (1-s)^2| d = 4/27 d.
inline Interval cubic_reach(double y_0, double rate_0, double y_1, double rate_1, double h) {
  const double low = std::min(y_0, y_1), high = std::max(y_0, y_1);
  if (cubic_is_monotone(y_0, rate_0, y_1, rate_1, h)) return {low, high};
  const double up = kCubicBulge * h * std::max(rate_0, 0.0) + kCubicBulge * h * std::max(-rate_1, 0.0);
  const double down = kCubicBulge * h * std::max(-rate_0, 0.0) + kCubicBulge * h * std::max(rate_1, 0.0);
  return {low - down, high + up};
}

}  // namespace drev
