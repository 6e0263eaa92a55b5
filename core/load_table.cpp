#include <drev/core/error.hpp>
#include <drev/core/load_table.hpp>

#include <cmath>

namespace drev {

LoadStretch LoadTable::stretch(double angle, double direction) const {
  constexpr double kSameSlope = 1e-13;  // relative to the steepest
  const double argument = angle + phase;
  const std::size_t n = arguments.size();
  const double nudge = on_knot(period, argument);
  const double beyond = argument + (direction > 0.0 ? nudge : -nudge);
  const double base = period * std::floor((beyond - arguments[0]) * (1.0 / period));
  const double inverse_spacing = evenly_spaced ? static_cast<double>(n) / period : 0.0;
  const std::size_t i = table_segment(arguments, inverse_spacing, beyond - base);
  const double slope = slopes[i];
  LoadStretch s{.torque = values[i] + slope * (argument - base - arguments[i]), .angle_slope = slope};
  double steepest = 0.0;
  for (const double other : {slopes.front(), slope, slopes.back()})
    steepest = std::max(steepest, std::abs(other));
  const auto same = [&](std::size_t j) { return std::abs(slopes[j] - slope) <= kSameSlope * steepest; };
  const auto knot = [&](std::size_t j, double turns) { return base + turns * period + arguments[j]; };
  std::size_t low = i, high = i, steps = 0;
  double turns_low = 0.0, turns_high = 0.0;
  const auto raise = [&] {
    if (++high == n) high = 0, turns_high = 1.0;
  };
  for (raise(); steps < n && same(high); ++steps) raise();
  if (steps == n) return s;
  const auto before = [&](std::size_t j) { return j == 0 ? n - 1 : j - 1; };
  for (; same(before(low)); low = before(low))
    if (low == 0) turns_low = -1.0;
  s.low = knot(low, turns_low) - phase;
  s.high = knot(high, turns_high) - phase;
  return s;
}

std::string LoadTable::fault() const {
  constexpr double kAgree = 1e-9;  // relative
  const std::size_t n = arguments.size();
  if (n < 2 || values.size() != n || slopes.size() != n)
    return std::to_string(n) + " arguments, " + std::to_string(values.size()) + " values, " +
           std::to_string(slopes.size()) + " slopes; must be as many of each, at least 2";
  const double spacing = period / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const double step = (last ? arguments[0] + period : arguments[i + 1]) - arguments[i];
    const std::string knot = "knot " + std::to_string(i) + " at " + to_text(arguments[i]) + " rad: ";
    if (!(step > 0.0)) return knot + "the next one must lie beyond it, all within one period";
    const double rise = values[last ? 0 : i + 1] - values[i];
    const double size = std::abs(values[i]) + std::abs(values[last ? 0 : i + 1]);
    if (std::abs(slopes[i] * step - rise) > kAgree * size)
      return knot + "slope " + to_text(slopes[i]) + " N m/rad, but the values rise by " +
             to_text(rise / step) + " N m/rad";
    const double even = arguments[0] + static_cast<double>(i) * spacing;
    if (evenly_spaced && !(std::abs(arguments[i] - even) < 0.25 * spacing))
      return knot + "evenly_spaced is true, but its place would be " + to_text(even) + " rad";
  }
  return "";
}

}  // namespace drev
