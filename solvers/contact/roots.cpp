#include "solvers/contact/roots.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace drev {

namespace {

constexpr double kSmallestRadius = 1e-13;  // relative to the end
constexpr int kNewtonLimit = 100;

struct Point {
  double value, slope;
};
/// Value and slope, even and odd powers apart, as polynomial_value().
Point polynomial_at(std::span<const double> g, double s) {
  const double square = s * s;
  std::size_t k = g.size();
  double odd = 0.0, even = k % 2 == 1 ? g[--k] : 0.0, odd_rate = 0.0, even_rate = 0.0;  // by the square
  for (; k > 0; k -= 2) {
    odd_rate = odd_rate * square + odd;
    even_rate = even_rate * square + even;
    odd = odd * square + g[k - 1];
    even = even * square + g[k - 2];
  }
  return {even + s * odd, odd + 2.0 * (s * even_rate + square * odd_rate)};
}

/// The root of a polynomial that is monotone on [low, high], at whose ends it is g_low >= 0 > g_high; curvature: bound of |g''|.
double bracketed_root(std::span<const double> g, double low, double high, double g_low, double g_high,
                      double curvature) {
  constexpr double kRounding = std::numeric_limits<double>::epsilon();
  double s = low + (high - low) * (g_low / (g_low - g_high));
  for (int i = 0; i < kNewtonLimit; ++i) {
    const Point at = polynomial_at(g, s);
    (at.value >= 0.0 ? low : high) = s;
    const double step = at.value / at.slope;
    double next = s - step;
    if (!(next > low && next < high)) {
      // Newton leaves the bracket: the root lies within rounding of s, or the bracket is halved.
      if (std::abs(step) <= 2.0 * kRounding * s) return s;
      next = 0.5 * (low + high);
    } else if (0.5 * curvature * step * step <= kRounding * s * std::abs(at.slope)) {
      return next;
    }
    if (next == s || next <= low || next >= high) return s;
    s = next;
  }
  return s;
}

class Search {
 public:
  Search(std::span<const double> g, double end) : g_(g), smallest_(kSmallestRadius * end) {}

  std::optional<double> first(double end) const { return first(0.0, end, bound(end)); }

 private:
  /// Of |g''| on [0, reach].
  struct Bound {
    double reach, curvature;
  };
  static constexpr double kCloser = 0.25;  // part of a bound's reach in which a closer one is found

  Bound bound(double reach) const {
    double power = 1.0, curvature = 0.0;
    for (std::size_t k = 2; k < g_.size(); ++k, power *= reach)
      curvature += static_cast<double>(k * (k - 1)) * std::abs(g_[k]) * power;
    return {reach, curvature};
  }

  std::optional<double> first(double low, double high, const Bound& most) const {
    const double c = 0.5 * (low + high), r = 0.5 * (high - low);
    const auto [value, slope] = polynomial_at(g_, c);
    const double bend = most.curvature * r;
    if (std::abs(value) > std::abs(slope) * r + 0.5 * bend * r) {
      if (value < 0.0) return low;  // it fell below at the very start
      return std::nullopt;
    }
    if (std::abs(slope) > bend) {
      const double at_low = low == 0.0 ? g_[0] : polynomial_value(g_, low);
      if (slope > 0.0) return at_low < 0.0 && low > 0.0 ? std::optional(low) : std::nullopt;
      const double at_high = polynomial_value(g_, high);
      if (at_high >= 0.0) return std::nullopt;
      return at_low < 0.0 ? low : bracketed_root(g_, low, high, at_low, at_high, most.curvature);
    }
    if (r <= smallest_) return polynomial_value(g_, high) < 0.0 ? std::optional(c) : std::nullopt;
    // A motion out of rest is as flat there as a high power: without closer bounds its halves would be without number.
    if (const auto left = first(low, c, c <= kCloser * most.reach ? bound(c) : most)) return left;
    return first(c, high, most);
  }

  std::span<const double> g_;
  double smallest_;
};

}  // namespace

double polynomial_curvature(std::span<const double> g, double s) {
  double sum = 0.0;
  for (std::size_t k = g.size(); k-- > 2;) sum = sum * s + static_cast<double>(k * (k - 1)) * g[k];
  return sum;
}

void multiply_polynomial(std::span<const double> by, std::vector<double>& g) {
  std::vector<double> product(by.size() + g.size() - 1, 0.0);
  for (std::size_t i = 0; i < by.size(); ++i)
    for (std::size_t k = 0; k < g.size(); ++k) product[i + k] += by[i] * g[k];
  g = std::move(product);
}

// Even and odd powers apart: two sums that do not wait for each other.
double polynomial_value(std::span<const double> g, double s) {
  const double square = s * s;
  std::size_t k = g.size();
  double odd = 0.0, even = k % 2 == 1 ? g[--k] : 0.0;
  for (; k > 0; k -= 2) {
    odd = odd * square + g[k - 1];
    even = even * square + g[k - 2];
  }
  return even + s * odd;
}

double polynomial_slope(std::span<const double> g, double s) {
  const double square = s * s;
  std::size_t k = g.size();
  double odd = 0.0, even = 0.0;
  if (k % 2 == 1) {
    --k;
    even = static_cast<double>(k) * g[k];
  }
  for (; k > 2; k -= 2) {
    odd = odd * square + static_cast<double>(k - 1) * g[k - 1];
    even = even * square + static_cast<double>(k - 2) * g[k - 2];
  }
  return k == 2 ? odd * square + g[1] + s * even : 0.0;
}

std::optional<double> first_crossing(std::span<const double> g, double end) {
  while (!g.empty() && g[0] == 0.0) g = g.subspan(1);
  if (g.size() < 2) return std::nullopt;
  // Most often the constant term outweighs all others, or all others have its sign.
  double falling = 0.0, power = end;
  for (std::size_t k = 1; k < g.size(); ++k, power *= end)
    if (g[k] < 0.0) falling -= g[k] * power;
  if (g[0] > falling) return std::nullopt;
  return Search(g, end).first(end);
}

}  // namespace drev
