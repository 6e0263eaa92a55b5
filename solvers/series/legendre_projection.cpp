#include "solvers/series/legendre_projection.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/linear/lane_pair.hpp"
#include "solvers/series/series_kernels.hpp"

namespace drev {

namespace {

using Powers = PowersOf<kProjectionTerms>;

/// L_j(s).
std::array<double, kProjectionTerms> legendre_at(double s) {
  std::array<double, kProjectionTerms> p{1.0};
  const double x = 2.0 * s - 1.0;
  for (int j = 0; j < kProjectionDegree; ++j) {
    const auto k = static_cast<std::size_t>(j);
    p[k + 1] = ((2 * j + 1) * x * p[k] - (j > 0 ? j * p[k - 1] : 0.0)) / (j + 1);
  }
  return p;
}

GaussRule make_gauss_rule() {
  GaussRule rule{};
  find_gauss_rule(GaussRule::kNodes, rule.s.data(), rule.weight.data());
  const auto start = legendre_at(0.0), end = legendre_at(GaussRule::kAheadOfEnd);
  for (std::size_t i = 0; i < GaussRule::kNodes; ++i) {
    const auto here = legendre_at(rule.s[i]);
    for (std::size_t j = 0; j < here.size(); ++j) {
      rule.legendre[j][i] = here[j];
      const double weight = static_cast<double>(2 * j + 1) * rule.weight[i] * here[j];
      rule.at_start[i] += weight * start[j];
      rule.at_end[i] += weight * end[j];
    }
  }
  return rule;
}

struct ToPowers {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, const Powers* t, const double* a, int kept,
                                         double* out) {
    for (int i = 0; i < stride; i += kLanes) {
      for (int k = 0; k <= kProjectionDegree; ++k) {
        L sum{}, x;
        double* at = out + static_cast<std::ptrdiff_t>(k) * stride + i;
        if (k < kept) load(at, sum);
        for (int j = k; j <= kProjectionDegree; ++j) {
          load(a + static_cast<std::ptrdiff_t>(j) * stride + i, x);
          sum += (*t)[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)] * x;
        }
        store(sum, at);
      }
    }
  }
};

struct PolynomialAtNodes {
  template <class L>
  [[gnu::always_inline]] static void run(const double* terms, std::size_t count, double end,
                                         const double* nodes, NodeValues* out) {
    for (std::size_t first = 0; first < out->value.size(); first += kLanes) {
      L s, value{}, slope{};
      load(nodes + first, s);
      s = end * s;
      for (std::size_t k = count; k-- > 0;) {
        slope = slope * s + value;
        value = value * s;
        value = value + terms[k];
      }
      store(value, out->value.data() + first);
      store(slope, out->slope.data() + first);
    }
  }
};

struct Difference {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, const double* a, const double* b, double* out) {
    for (int i = 0; i < stride; i += kLanes) {
      L sum{}, x, y;
      for (int j = 0; j < kProjectionTerms; ++j) {
        load(a + static_cast<std::ptrdiff_t>(j) * stride + i, x);
        load(b + static_cast<std::ptrdiff_t>(j) * stride + i, y);
        x = x - y;
        magnitude(x);
        sum += x;
      }
      store(sum, out + i);
    }
  }
};

}  // namespace

void find_gauss_rule(int n, double* s, double* weight) {
  for (int i = 0; i < n; ++i) {
    double x = std::cos(3.14159265358979323846 * (static_cast<double>(i) + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int newton = 0; newton < 20; ++newton) {
      double p = 1.0, last = 0.0;
      for (int j = 0; j < n; ++j) {
        const double next = ((2 * j + 1) * x * p - j * last) / (j + 1);
        last = p;
        p = next;
      }
      slope = n * (x * p - last) / (x * x - 1.0);
      x -= p / slope;
    }
    s[i] = 0.5 * (1.0 - x);
    weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
}

void find_at_nodes(std::span<const double> polynomial, double end, NodeValues& out) {
  static const auto nodes = [] {
    std::array<double, whole_lanes(GaussRule::kNodes)> padded{};
    std::copy(gauss_rule().s.begin(), gauss_rule().s.end(), padded.begin());
    return padded;
  }();
  run_widest<PolynomialAtNodes>(polynomial.data(), polynomial.size(), end, nodes.data(), &out);
}

const GaussRule& gauss_rule() {
  static const GaussRule rule = make_gauss_rule();
  return rule;
}

NodePolynomial through_nodes(const std::array<double, GaussRule::kNodes>& values, double rounding) {
  constexpr int n = GaussRule::kNodes;
  static const PowersOf<n> powers = legendre_powers<n>();
  const GaussRule& rule = gauss_rule();
  std::array<double, n> a{};  // Gauss' rule is exact for products of two of these L_j
  for (std::size_t q = 0; q < n; ++q) {
    const double u = 2.0 * rule.s[q] - 1.0;
    double below = 0.0, now = 1.0;
    for (std::size_t j = 0; j < n; ++j) {
      const double order = static_cast<double>(j);
      a[j] += (2.0 * order + 1.0) * rule.weight[q] * now * values[q];
      const double next = ((2.0 * order + 1.0) * u * now - order * below) / (order + 1.0);
      below = now;
      now = next;
    }
  }
  NodePolynomial result{.tail = std::abs(a[n - 1]) + std::abs(a[n - 2])};
  for (std::size_t j = 0; j < n; ++j)
    if (j < 2 || std::abs(a[j]) > rounding)
      for (std::size_t k = 0; k <= j; ++k) result.power[k] += a[j] * powers[j][k];
  return result;
}

void LegendreProjection::add_nodes(const NodeForces& forces) {
  static const auto weights = [] {
    std::array<double, kProjectionTerms * GaussRule::kNodes> w{};
    const GaussRule& rule = gauss_rule();
    for (std::size_t j = 0; j < kProjectionTerms; ++j)
      for (std::size_t q = 0; q < GaussRule::kNodes; ++q)
        w[q * kProjectionTerms + j] =
            (2.0 * static_cast<double>(j) + 1.0) * rule.weight[q] * rule.legendre[j][q];
    return w;
  }();
  weighted_sums(stride_, kProjectionTerms, 0, GaussRule::kNodes, weights.data(), kProjectionTerms, nullptr,
                forces.data(), a_.data(), true);
}

void LegendreProjection::difference(const LegendreProjection& other, double* out) const {
  run_widest<Difference>(stride_, static_cast<const double*>(a_.data()),
                         static_cast<const double*>(other.a_.data()), out);
}

void LegendreProjection::add_powers(int kept, double* out) const {
  static const Powers powers = legendre_powers<kProjectionTerms>();
  run_widest<ToPowers>(stride_, &powers, static_cast<const double*>(a_.data()), kept, out);
}

}  // namespace drev
