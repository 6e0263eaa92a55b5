#pragma once
/// Arithmetic of truncated Taylor series in extended precision, coefficient by coefficient.
#include <array>
#include <cmath>

namespace coverage {

using Real = long double;
constexpr Real kTurn = 6.283185307179586476925286766559005768L;
constexpr int kMostDegree = 36;

struct Series {
  std::array<Real, kMostDegree + 3> c{};
  Real& operator[](int k) { return c[static_cast<std::size_t>(k)]; }
  Real operator[](int k) const { return c[static_cast<std::size_t>(k)]; }
};

/// Coefficient k of a b.
inline Real product(const Series& a, const Series& b, int k) {
  Real sum = 0;
  for (int j = 0; j <= k; ++j) sum += a[j] * b[k - j];
  return sum;
}

/// cos and sin of a series, one degree after the other.
struct Rotation {
  Series cosine, sine;
  void extend(const Series& angle, int k) {
    if (k == 0) {
      cosine[0] = std::cos(angle[0]), sine[0] = std::sin(angle[0]);
      return;
    }
    Real c = 0, s = 0;
    for (int j = 1; j <= k; ++j) {
      c -= static_cast<Real>(j) * angle[j] * sine[k - j];
      s += static_cast<Real>(j) * angle[j] * cosine[k - j];
    }
    cosine[k] = c / static_cast<Real>(k), sine[k] = s / static_cast<Real>(k);
  }
};

/// A polynomial of s and its degree.
struct Poly {
  Series a;
  int degree = 0;
  Real value(Real s) const {
    Real y = a[degree];
    for (int k = degree - 1; k >= 0; --k) y = y * s + a[k];
    return y;
  }
  Real slope(Real s) const {
    Real y = static_cast<Real>(degree) * a[degree];
    for (int k = degree - 1; k >= 1; --k) y = y * s + static_cast<Real>(k) * a[k];
    return degree > 0 ? y : 0;
  }
  void add(Real factor, const Poly& other) {
    degree = degree > other.degree ? degree : other.degree;
    for (int k = 0; k <= other.degree; ++k) a[k] += factor * other.a[k];
  }
  Poly derivative() const {
    Poly d;
    d.degree = degree > 0 ? degree - 1 : 0;
    for (int k = 1; k <= degree; ++k) d.a[k - 1] = static_cast<Real>(k) * a[k];
    return d;
  }
};

}  // namespace coverage
