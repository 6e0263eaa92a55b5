#pragma once
/// Dual: a number with its derivatives with respect to x and x_dot, carried through a formula (forward
/// differentiation). A formula written over any scalar then gives its slopes without being written again.
///
///   f(Dual) = f(value) + f'(value) (by_x, by_x_dot)
///
/// Functions are found by their unqualified names: `using std::sin; ... sin(x)`. Comparisons are those of the
/// values.
#include <cmath>
#include <compare>

namespace drev {

struct Dual {
  double value = 0.0, by_x = 0.0, by_x_dot = 0.0;

  Dual() = default;
  Dual(double v) : value(v) {}  // NOLINT: implicit by intent, as constants stand in formulas
  Dual(double v, double x, double x_dot) : value(v), by_x(x), by_x_dot(x_dot) {}

  /// f(a), f' = slope there.
  static Dual chain(const Dual& a, double f, double slope) { return {f, slope * a.by_x, slope * a.by_x_dot}; }

  Dual operator-() const { return {-value, -by_x, -by_x_dot}; }
  friend Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.by_x + b.by_x, a.by_x_dot + b.by_x_dot};
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.by_x - b.by_x, a.by_x_dot - b.by_x_dot};
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.by_x * b.value + a.value * b.by_x,
            a.by_x_dot * b.value + a.value * b.by_x_dot};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double q = a.value / b.value;
    return {q, (a.by_x - q * b.by_x) / b.value, (a.by_x_dot - q * b.by_x_dot) / b.value};
  }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }
  friend std::partial_ordering operator<=>(const Dual& a, const Dual& b) { return a.value <=> b.value; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
};

inline Dual sqrt(const Dual& a) {
  const double f = std::sqrt(a.value);
  return Dual::chain(a, f, 0.5 / f);
}
inline Dual exp(const Dual& a) {
  const double f = std::exp(a.value);
  return Dual::chain(a, f, f);
}
inline Dual log(const Dual& a) { return Dual::chain(a, std::log(a.value), 1.0 / a.value); }
inline Dual sin(const Dual& a) { return Dual::chain(a, std::sin(a.value), std::cos(a.value)); }
inline Dual cos(const Dual& a) { return Dual::chain(a, std::cos(a.value), -std::sin(a.value)); }
inline Dual tanh(const Dual& a) {
  const double f = std::tanh(a.value);
  return Dual::chain(a, f, 1.0 - f * f);
}
inline Dual atan(const Dual& a) {
  return Dual::chain(a, std::atan(a.value), 1.0 / (1.0 + a.value * a.value));
}
/// Slope 0 at 0.
inline Dual abs(const Dual& a) {
  return Dual::chain(a, std::abs(a.value), a.value > 0.0 ? 1.0 : a.value < 0.0 ? -1.0 : 0.0);
}
inline Dual pow(const Dual& a, double n) {
  return Dual::chain(a, std::pow(a.value, n), n == 0.0 ? 0.0 : n * std::pow(a.value, n - 1.0));
}

}  // namespace drev
