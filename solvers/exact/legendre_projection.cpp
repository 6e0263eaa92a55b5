#include "solvers/exact/legendre_projection.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/exact/lane_pair.hpp"
#include "solvers/exact/series_kernels.hpp"

namespace drev {

namespace {

constexpr int kMomentNodes = 10;
constexpr int kMaxNewton = 30;
constexpr double kSettled = 1e-8;  // last Newton step in s

template <int kTerms>
using PowersOf = std::array<std::array<double, kTerms>, kTerms>;
using Powers = PowersOf<kProjectionTerms>;

/// L_j = sum_k t[j][k] s^k, t[j][k] = (-1)^(j+k) binomial(j, k) binomial(j+k, k).
template <int kTerms>
PowersOf<kTerms> legendre_powers() {
  PowersOf<kTerms> t{};
  for (int j = 0; j < kTerms; ++j) {
    double value = j % 2 ? -1.0 : 1.0;
    for (int k = 0; k <= j; ++k) {
      t[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)] = value;
      value *= -static_cast<double>((j - k) * (j + k + 1)) / ((k + 1.0) * (k + 1.0));
    }
  }
  return t;
}

/// Nodes and weights of Gauss's rule of n nodes on [0, 1].
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

GaussRule make_gauss_rule() {
  GaussRule rule{};
  find_gauss_rule(GaussRule::kNodes, rule.s.data(), rule.weight.data());
  for (std::size_t i = 0; i < GaussRule::kNodes; ++i) {
    const double x = 2.0 * rule.s[i] - 1.0;
    double p = 1.0, last = 0.0;
    for (int j = 0; j <= kProjectionDegree; ++j) {
      rule.legendre[static_cast<std::size_t>(j)][i] = p;
      const double next = ((2 * j + 1) * x * p - j * last) / (j + 1);
      last = p;
      p = next;
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

/// Moments int_s^1 jump (theta - knot) L_j du of kLanes kinks, behind the s at which theta = knot, by Gauss's rule with
/// kMomentNodes nodes between s and 1: exact where theta is of degree 11 there.
struct Moments {
  template <class L>
  [[gnu::always_inline]] static void run(const double* theta, std::size_t terms, const double* knot,
                                         const double* jump, const double* end, const double* nodes,
                                         const double* weights, double* place, double* moments) {
    L target, delta, x, s;
    load(knot, target);
    load(jump, delta);
    load(theta, x);
    load(end, s);
    s = (target - x) / (s - x);
    for (int newton = 0; newton < kMaxNewton; ++newton) {
      L value{}, slope{};
      for (std::size_t k = terms; k-- > 0;) {
        load(theta + k * kLanes, x);
        slope = slope * s + value;
        value = value * s + x;
      }
      L step = (value - target) / slope;
      s -= step;
      double places[kLanes];
      store(s, places);
      for (double& at : places) at = at < 0.0 ? 0.0 : at > 1.0 ? 1.0 : at;
      load(places, s);
      magnitude(step);
      if (largest_of(step) < kSettled) break;  // the next step would be its square
    }
    store(s, place);
    L sum[kProjectionTerms] = {};
    const L rest = 1.0 - s;
    for (int q = 0; q < kMomentNodes; q += 2) {
      const L s_0 = s + nodes[q] * rest, s_1 = s + nodes[q + 1] * rest;
      L f_0{}, f_1{};
      for (std::size_t k = terms; k-- > 0;) {
        load(theta + k * kLanes, x);
        f_0 = f_0 * s_0 + x;
        f_1 = f_1 * s_1 + x;
      }
      for (int node = 0; node < 2; ++node) {
        const L u = 2.0 * (node == 0 ? s_0 : s_1) - 1.0;
        L below = weights[q + node] * ((node == 0 ? f_0 : f_1) - target), now = u * below;
        sum[0] += below;
        sum[1] += now;
        for (int j = 1; j < kProjectionDegree; ++j) {
          const L next = ((2.0 * j + 1.0) / (j + 1.0)) * (u * now) - (j / (j + 1.0)) * below;
          below = now;
          now = next;
          sum[j + 1] += now;
        }
      }
    }
    for (int j = 0; j < kProjectionTerms; ++j) {
      sum[j] *= (2.0 * j + 1.0) * (delta * rest);
      store(sum[j], moments + j * kLanes);
    }
  }
};

}  // namespace

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
        w[j * GaussRule::kNodes + q] =
            (2.0 * static_cast<double>(j) + 1.0) * rule.weight[q] * rule.legendre[j][q];
    return w;
  }();
  weighted_sums(stride_, kProjectionTerms, GaussRule::kNodes, weights.data(), forces.data(), a_.data());
}

void LegendreProjection::add_powers(int kept, double* out) const {
  static const Powers powers = legendre_powers<kProjectionTerms>();
  run_widest<ToPowers>(stride_, &powers, static_cast<const double*>(a_.data()), kept, out);
}

void KinkMoments::add(int row, double knot, double jump, double end, std::span<const double> theta) {
  const auto i = static_cast<std::size_t>(count_++);
  terms_ = theta.size();
  const auto room = static_cast<std::size_t>(whole_lanes(count_));
  if (row_.size() < room) {
    row_.resize(room);
    for (auto* list : {&knot_, &jump_, &end_, &place_}) list->resize(room);
    theta_.resize(room * kMostTerms);
  }
  double* own = theta_.data() + i / kLanes * kGroup + i % kLanes;
  for (std::size_t k = 0; k < terms_; ++k) own[k * kLanes] = theta[k];
  row_[i] = row;
  knot_[i] = knot;
  jump_[i] = jump;
  end_[i] = end;
}

void KinkMoments::add_to(LegendreProjection& projection) {
  if (count_ == 0) return;
  static const auto rule = [] {
    std::array<std::array<double, kMomentNodes>, 2> r{};
    find_gauss_rule(kMomentNodes, r[0].data(), r[1].data());
    return r;
  }();
  moments_.resize(kProjectionTerms * kLanes);
  // The lanes behind the last kink repeat it; what they give is not used.
  for (auto lane = static_cast<std::size_t>(count_); lane % kLanes != 0; ++lane) {
    for (auto* list : {&knot_, &jump_, &end_}) (*list)[lane] = (*list)[lane - 1];
    double* own = theta_.data() + lane / kLanes * kGroup + lane % kLanes;
    for (std::size_t k = 0; k < terms_; ++k) own[k * kLanes] = own[k * kLanes - 1];
  }
  for (int first = 0; first < count_; first += kLanes) {
    const auto at = static_cast<std::size_t>(first);
    run_widest<Moments>(static_cast<const double*>(theta_.data() + at / kLanes * kGroup), terms_,
                        static_cast<const double*>(knot_.data() + at),
                        static_cast<const double*>(jump_.data() + at),
                        static_cast<const double*>(end_.data() + at), rule[0].data(), rule[1].data(),
                        place_.data() + at, moments_.data());
    const int lanes = std::min(kLanes, count_ - first);
    for (int j = 0; j < kProjectionTerms; ++j)
      for (int l = 0; l < lanes; ++l)
        projection.coefficient(j, row_[static_cast<std::size_t>(first + l)]) +=
            moments_[static_cast<std::size_t>(j * kLanes + l)];
  }
}

}  // namespace drev
