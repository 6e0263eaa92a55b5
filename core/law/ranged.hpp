#pragma once
/// Ranged: where a number lies over ranges of the time, angle and speed, and where its slopes by them do, carried through a
/// formula: interval arithmetic with forward differentiation. A formula written over any scalar then bounds itself.
///
///   f(x) in f([x_low, x_high]),    df/dx_i in f'([x]) [dx/dx_i]
///
/// Bounds hold but for rounding; where a number stands in a formula more than once they are wider than need be.
/// Source: R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval Analysis, SIAM, 2009, chapters 2 and 3.
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace drev {

inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
inline Interval operator+(const Interval& a, const Interval& b) { return {a.low + b.low, a.high + b.high}; }
inline Interval operator*(const Interval& a, const Interval& b) {
  // Nothing times what is unbounded is nothing: a slope that is zero stays so.
  const auto product = [](double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : x * y; };
  const double corners[] = {product(a.low, b.low), product(a.low, b.high), product(a.high, b.low),
                            product(a.high, b.high)};
  const auto [low, high] = std::minmax_element(std::begin(corners), std::end(corners));
  return {*low, *high};
}
inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}
/// The largest size in it.
inline double size_of(const Interval& a) { return std::max(std::abs(a.low), std::abs(a.high)); }

struct Ranged {
  Interval value{0.0, 0.0};
  std::array<Interval, 3> by{Interval{0.0, 0.0}, Interval{0.0, 0.0}, Interval{0.0, 0.0}};

  Ranged() = default;
  Ranged(double v) : value{v, v} {}  // NOLINT: implicit by intent, as constants stand in formulas
  explicit Ranged(const Interval& v) : value(v) {}
  /// Variable i of the formula.
  static Ranged variable(std::size_t i, const Interval& range) {
    Ranged r(range);
    r.by[i] = {1.0, 1.0};
    return r;
  }
  /// f(a), f' within slope there.
  static Ranged chain(const Ranged& a, const Interval& f, const Interval& slope) {
    Ranged r(f);
    for (std::size_t i = 0; i < r.by.size(); ++i) r.by[i] = slope * a.by[i];
    return r;
  }
  Ranged operator-() const { return chain(*this, -value, {-1.0, -1.0}); }
  friend Ranged operator+(const Ranged& a, const Ranged& b) {
    Ranged r(a.value + b.value);
    for (std::size_t i = 0; i < r.by.size(); ++i) r.by[i] = a.by[i] + b.by[i];
    return r;
  }
  friend Ranged operator-(const Ranged& a, const Ranged& b) { return a + -b; }
  friend Ranged operator*(const Ranged& a, const Ranged& b) {
    Ranged r(a.value * b.value);
    for (std::size_t i = 0; i < r.by.size(); ++i) r.by[i] = a.by[i] * b.value + a.value * b.by[i];
    return r;
  }
  friend Ranged operator/(const Ranged& a, const Ranged& b) { return a * inverse(b); }
  static Ranged inverse(const Ranged& a) {
    if (a.value.low <= 0.0 && a.value.high >= 0.0) return chain(a, {}, {});
    const Interval f{1.0 / a.value.high, 1.0 / a.value.low};
    return chain(a, f, -(f * f));
  }
};

namespace ranges {

/// Of a function that rises all over.
template <class F>
Interval rising(const Interval& x, const F& f) {
  return {f(x.low), f(x.high)};
}
inline Interval cos(const Interval& x) {
  if (!(x.high - x.low < 2.0 * kPi)) return {-1.0, 1.0};
  Interval f{std::min(std::cos(x.low), std::cos(x.high)), std::max(std::cos(x.low), std::cos(x.high))};
  // A multiple n of pi within: the top where n is even.
  for (double n = std::ceil(x.low / kPi); n * kPi <= x.high; n += 1.0)
    std::fmod(n, 2.0) == 0.0 ? f.high = 1.0 : f.low = -1.0;
  return f;
}
inline Interval sin(const Interval& x) { return cos({x.low - 0.5 * kPi, x.high - 0.5 * kPi}); }
/// x^n; of x >= 0 where n is no whole number.
inline Interval pow(const Interval& x, double n) {
  if (n == 0.0) return {1.0, 1.0};
  if (n < 0.0) {
    const Interval below = pow(x, -n);
    if (below.low <= 0.0 && below.high >= 0.0) return {};
    return {1.0 / below.high, 1.0 / below.low};
  }
  const bool whole = n == std::floor(n), even = std::fmod(n, 2.0) == 0.0;
  const auto f = [n](double at) { return std::pow(at, n); };
  if (!whole) return rising({std::max(0.0, x.low), std::max(0.0, x.high)}, f);
  if (!even || x.low >= 0.0) return rising(x, f);
  if (x.high <= 0.0) return rising(-x, f);
  return {0.0, f(std::max(-x.low, x.high))};
}

}  // namespace ranges

inline Ranged sqrt(const Ranged& a) {
  const Interval f = ranges::pow(a.value, 0.5);
  return Ranged::chain(a, f, {0.5 / f.high, f.low > 0.0 ? 0.5 / f.low : Interval{}.high});
}
inline Ranged exp(const Ranged& a) {
  const Interval f = ranges::rising(a.value, [](double x) { return std::exp(x); });
  return Ranged::chain(a, f, f);
}
inline Ranged log(const Ranged& a) {
  if (!(a.value.low > 0.0)) return Ranged::chain(a, {}, {});
  return Ranged::chain(a, ranges::rising(a.value, [](double x) { return std::log(x); }),
                       {1.0 / a.value.high, 1.0 / a.value.low});
}
inline Ranged sin(const Ranged& a) { return Ranged::chain(a, ranges::sin(a.value), ranges::cos(a.value)); }
inline Ranged cos(const Ranged& a) { return Ranged::chain(a, ranges::cos(a.value), -ranges::sin(a.value)); }
inline Ranged tan(const Ranged& a) {
  const Interval c = ranges::cos(a.value);
  if (c.low <= 0.0 && c.high >= 0.0) return Ranged::chain(a, {}, {});
  return Ranged::chain(a, ranges::rising(a.value, [](double x) { return std::tan(x); }),
                       ranges::pow(c, -2.0));
}
inline Ranged tanh(const Ranged& a) {
  const Interval f = ranges::rising(a.value, [](double x) { return std::tanh(x); });
  return Ranged::chain(a, f, Interval{1.0, 1.0} + -ranges::pow(f, 2.0));
}
inline Ranged atan(const Ranged& a) {
  return Ranged::chain(a, ranges::rising(a.value, [](double x) { return std::atan(x); }),
                       ranges::pow(Interval{1.0, 1.0} + ranges::pow(a.value, 2.0), -1.0));
}
inline Ranged abs(const Ranged& a) {
  if (a.value.low >= 0.0) return a;
  if (a.value.high <= 0.0) return -a;
  return Ranged::chain(a, {0.0, size_of(a.value)}, {-1.0, 1.0});
}
inline Ranged pow(const Ranged& a, double n) {
  return Ranged::chain(a, ranges::pow(a.value, n), Interval{n, n} * ranges::pow(a.value, n - 1.0));
}
/// The lesser of two; the slopes are those of either where either may be it.
inline Ranged smaller(const Ranged& a, const Ranged& b) {
  if (a.value.high <= b.value.low) return a;
  if (b.value.high <= a.value.low) return b;
  Ranged r(Interval{std::min(a.value.low, b.value.low), std::min(a.value.high, b.value.high)});
  for (std::size_t i = 0; i < r.by.size(); ++i) r.by[i] = hull(a.by[i], b.by[i]);
  return r;
}

/// The slopes of a torque as a formula of the angle, speed and time, in this order.
inline LoadSlopes slopes_of(const Ranged& torque) {
  return {size_of(torque.by[2]), size_of(torque.by[0]), size_of(torque.by[1])};
}
inline std::array<Ranged, 3> variables_of(const LoadRanges& over) {
  return {Ranged::variable(0, over.angle), Ranged::variable(1, over.speed), Ranged::variable(2, over.t)};
}

}  // namespace drev
