#include "solvers/exact/legendre_projection.hpp"

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

constexpr int kMaxKinkTerms = 33;  // coefficients of theta
constexpr int kMaxNewton = 30;
constexpr double kSettled = 1e-14;  // last Newton step in s

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

GaussRule make_gauss_rule() {
  constexpr int n = GaussRule::kNodes;
  GaussRule rule{};
  for (std::size_t i = 0; i < n; ++i) {
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
    rule.s[i] = 0.5 * (1.0 - x);
    rule.weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    double p = 1.0, last = 0.0;
    for (int j = 0; j <= kProjectionDegree; ++j) {
      rule.legendre[static_cast<std::size_t>(j)][i] = p;
      const double next = ((2 * j + 1) * -x * p - j * last) / (j + 1);
      last = p;
      p = next;
    }
  }
  return rule;
}

DREV_WIDEST
void to_powers(int stride, const Powers& t, const double* a, int kept, double* out) {
  for (int i = 0; i < stride; i += kLanes) {
    for (int k = 0; k <= kProjectionDegree; ++k) {
      Lanes sum{}, x;
      double* at = out + static_cast<std::ptrdiff_t>(k) * stride + i;
      if (k < kept) load(at, sum);
      for (int j = k; j <= kProjectionDegree; ++j) {
        load(a + static_cast<std::ptrdiff_t>(j) * stride + i, x);
        sum += t[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)] * x;
      }
      store(sum, at);
    }
  }
}

/// Moments int_s^1 jump (theta - knot) L_j ds of kLanes kinks, behind the s at which theta = knot.
DREV_WIDEST
void kink_moments(const double* const* theta, std::size_t terms, std::size_t first, const double* knot,
                  const double* jump, const double* end, double tolerance, double* place, double* moments) {
  Lanes target, delta, x, s;
  load(knot + first, target);
  load(jump + first, delta);
  load(theta[0] + first, x);
  load(end + first, s);
  s = (target - x) / (s - x);
  for (int newton = 0; newton < kMaxNewton; ++newton) {
    Lanes value{}, slope{};
    for (std::size_t k = terms; k-- > 0;) {
      load(theta[k] + first, x);
      slope = slope * s + value;
      value = value * s + x;
    }
    const Lanes step = (value - target) / slope;
    s -= step;
    s = s < 0.0 ? s - s : s;
    s = s > 1.0 ? s / s : s;
    double largest = 0.0;
    for (int l = 0; l < kLanes; ++l) largest = std::max(largest, std::abs(step[l]));
    if (largest < kSettled) break;
  }
  store(s, place + first);
  // theta = sum d_p (u - s)^p behind the kink, as far as it counts.
  Lanes d[kMaxKinkTerms + 1];
  for (std::size_t k = 0; k < terms; ++k) load(theta[k] + first, d[k]);
  int last = 0;
  for (std::size_t p = 0, small = 0; p < terms && small < 2; ++p) {
    for (std::size_t k = terms - 1; k-- > p;) d[k] += d[k + 1] * s;
    last = static_cast<int>(p);
    bool counts = false;
    for (int l = 0; l < kLanes; ++l) counts |= std::abs(d[p][l]) > tolerance * std::abs(d[p > 0][l]);
    small = counts ? 0 : small + 1;
  }
  // J_p,j = int_s^1 (u - s)^p/p! L_j du = (J_p-1,j-1 - J_p-1,j+1)/(2 (2j + 1)), J_-1,j = L_j(s).
  const int top = kProjectionDegree + last + 1;
  Lanes now[kProjectionDegree + kMaxKinkTerms + 2], sum[kProjectionTerms] = {};
  const Lanes u = 2.0 * s - 1.0, rest = 1.0 - s;
  now[0] = 1.0 + (s - s);
  now[1] = u;
  for (int j = 1; j < top; ++j)
    now[j + 1] = ((2.0 * j + 1.0) / (j + 1.0)) * u * now[j] - (j / (j + 1.0)) * now[j - 1];
  double half_inverse[kProjectionDegree + kMaxKinkTerms + 2];
  for (int j = 1; j < top; ++j) half_inverse[j] = 0.5 / (2 * j + 1);
  Lanes power = rest;
  double factorial = 1.0;
  for (int p = 0; p <= last; ++p) {
    Lanes below = now[0];
    now[0] = power;
    for (int j = 1; j < top - p; ++j) {
      const Lanes own = now[j];
      now[j] = half_inverse[j] * (below - now[j + 1]);
      below = own;
    }
    power *= rest * (1.0 / (p + 2));
    if (p == 0) continue;
    factorial *= p;
    for (int j = 0; j <= kProjectionDegree; ++j) sum[j] += (factorial * d[p]) * now[j];
  }
  for (int j = 0; j <= kProjectionDegree; ++j) {
    sum[j] *= (2.0 * j + 1.0) * delta;
    store(sum[j], moments + j * kLanes);
  }
}

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

void LegendreProjection::add_node(std::size_t q, int row, double value) {
  const GaussRule& rule = gauss_rule();
  for (int j = 0; j < kProjectionTerms; ++j)
    coefficient(j, row) +=
        (2 * j + 1) * rule.weight[q] * rule.legendre[static_cast<std::size_t>(j)][q] * value;
}

void LegendreProjection::add_powers(int kept, double* out) const {
  static const Powers powers = legendre_powers<kProjectionTerms>();
  to_powers(stride_, powers, a_.data(), kept, out);
}

void KinkMoments::add(int row, double knot, double jump, const std::vector<double>& theta) {
  const auto i = static_cast<std::size_t>(count_++);
  if (i == 0) {
    terms_ = theta.size();
    if (theta_.size() < terms_) theta_.resize(terms_);
  }
  const auto room = static_cast<std::size_t>(whole_lanes(count_));
  if (row_.size() < room) {
    row_.resize(room);
    for (auto* list : {&knot_, &jump_, &end_, &place_}) list->resize(room);
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < terms_; ++k) {
    if (theta_[k].size() < room) theta_[k].resize(room);
    theta_[k][i] = theta[k];
    sum += theta[k];
  }
  row_[i] = row;
  knot_[i] = knot;
  jump_[i] = jump;
  end_[i] = sum;
}

void KinkMoments::add_to(LegendreProjection& projection, double tolerance) {
  if (count_ == 0) return;
  moments_.resize(kProjectionTerms * kLanes);
  columns_.clear();
  for (std::size_t k = 0; k < terms_; ++k) columns_.push_back(theta_[k].data());
  // The lanes behind the last kink repeat it; what they give is not used.
  for (auto lane = static_cast<std::size_t>(count_); lane % kLanes != 0; ++lane) {
    for (auto* list : {&knot_, &jump_, &end_}) (*list)[lane] = (*list)[lane - 1];
    for (std::size_t k = 0; k < terms_; ++k) theta_[k][lane] = theta_[k][lane - 1];
  }
  for (int first = 0; first < count_; first += kLanes) {
    kink_moments(columns_.data(), terms_, static_cast<std::size_t>(first), knot_.data(), jump_.data(),
                 end_.data(), tolerance, place_.data(), moments_.data());
    const int lanes = std::min(kLanes, count_ - first);
    for (int j = 0; j < kProjectionTerms; ++j)
      for (int l = 0; l < lanes; ++l)
        projection.coefficient(j, row_[static_cast<std::size_t>(first + l)]) +=
            moments_[static_cast<std::size_t>(j * kLanes + l)];
  }
}

}  // namespace drev
