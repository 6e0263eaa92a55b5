#pragma once
/// How two statements of one law or load are compared: where, and when they agree.
#include <drev/core/law/law_piece.hpp>

#include <cmath>

namespace drev {

inline constexpr double kAgree = 1e-9;      ///< relative to the size of the terms
inline constexpr double kNearBound = 1e-6;  ///< beside a bound: of the range, or of its own place
inline constexpr double kPartsOfRange[] = {kNearBound, 0.1, 0.4, 0.8, 1.0 - kNearBound};

inline bool agree(double a, double b, double size) { return std::abs(a - b) <= kAgree * size; }

/// The point at a part f of a range, 0 < f < 1; an infinite side is entered by the scale of the other one.
inline double inside(const Interval& r, double f) {
  const double beyond = f / (1.0 - f), before = (1.0 - f) / f;
  const bool low = std::isfinite(r.low), high = std::isfinite(r.high);
  if (low && high) return r.low + f * (r.high - r.low);
  if (low) return r.low + (r.low != 0.0 ? std::abs(r.low) : 1.0) * beyond;
  if (high) return r.high - (r.high != 0.0 ? std::abs(r.high) : 1.0) * before;
  return beyond - before;
}

/// The part of a range that lies within a turn or so of an angle inside it: within its own size, at least 1 rad.
inline Interval near_angle(double low, double high, double angle) {
  const double reach = std::fmax(1.0, std::abs(angle));
  return {std::fmax(low, angle - reach), std::fmin(high, angle + reach)};
}

}  // namespace drev
