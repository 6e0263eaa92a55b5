#include "solvers/periodic/trigonometric_sum.hpp"

#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kSameOrder = 1e-9;  // of the highest order: rounding of orders written down
constexpr int kPointsAPeriod = 4;    // of the highest order
constexpr int kFewestPoints = 16;
constexpr int kRefinements = 20;
constexpr double kAngleTolerance = 1e-4;  // of the distance of points

/// The largest order that all are whole multiples of, by Euclid's algorithm; 0: below `least`.
double common_order(const std::vector<double>& orders, double least, double same) {
  double common = 0.0;
  for (double order : orders) {
    while (order > same) {
      const double rest = std::fmod(common, order);
      common = order;
      order = order - rest < same ? 0.0 : rest;
    }
    if (common < least) return 0.0;
  }
  return common;
}

}  // namespace

TrigonometricSum::TrigonometricSum(const std::vector<double>& orders, const std::string& place) {
  if (orders.empty()) return;
  const double highest = *std::max_element(orders.begin(), orders.end());
  const double least = highest / kMostMultiples;
  base_ = common_order(orders, least * (1.0 - kSameOrder), kSameOrder * highest);
  if (!(base_ > 0.0))
    throw ModelError(
        {{place, "orders", to_text(orders.front()) + " ... " + to_text(orders.back()), "",
          "must be whole multiples of one order, which is at least the highest over " +
              std::to_string(kMostMultiples) + ": they have no common cycle to be summed over"}});
  for (const double order : orders) multiples_.push_back(static_cast<int>(std::lround(order / base_)));
  base_ = highest / std::round(highest / base_);
  for (const int n : multiples_) cubes_.push_back(std::pow(n, 3));
  highest_ = *std::max_element(multiples_.begin(), multiples_.end());
  const int points = std::max(kFewestPoints, kPointsAPeriod * highest_);
  step_ = kTwoPi / points;
  for (std::size_t k = 0; k < multiples_.size(); ++k)
    (multiples_[k] % 2 == 0 ? even_ : odd_).rows.push_back(static_cast<Eigen::Index>(k));
  for (Group* group : {&even_, &odd_}) {
    group->cosines.resize(points / 4 + 1, static_cast<Eigen::Index>(group->rows.size()));
    group->sines.resizeLike(group->cosines);
    for (Eigen::Index k = 0; k < group->cosines.cols(); ++k)
      for (int p = 0; p <= points / 4; ++p) {
        const auto row = static_cast<std::size_t>(group->rows[static_cast<std::size_t>(k)]);
        const double angle = step_ * static_cast<double>(static_cast<long>(multiples_[row]) * p % points);
        group->cosines(p, k) = std::cos(angle);
        group->sines(p, k) = std::sin(angle);
      }
  }
  samples_.resize(points, 0);
}

double TrigonometricSum::cycle() const { return base_ > 0.0 ? kTwoPi / base_ : 0.0; }

/// The local maximum of sign y about an angle [of the base order], within a step of it.
double TrigonometricSum::refine(const Complex* a, double start, double sign, double& value) const {
  double angle = start;
  const bool dense = highest_ <= 4 * static_cast<int>(multiples_.size());
  for (int i = 0; i < kRefinements; ++i) {
    const Complex one = std::polar(1.0, angle);
    Complex power = 1.0;
    int at = 0;
    double y = 0.0, slope = 0.0, bend = 0.0, twist = 0.0;
    for (std::size_t k = 0; k < multiples_.size(); ++k) {
      const int n = multiples_[k];
      if (dense && n >= at)
        for (; at < n; ++at)
          power = Complex(power.real() * one.real() - power.imag() * one.imag(),
                          power.real() * one.imag() + power.imag() * one.real());
      else
        power = std::polar(1.0, n * angle), at = n;
      const double re = a[k].real() * power.real() - a[k].imag() * power.imag();
      const double im = a[k].real() * power.imag() + a[k].imag() * power.real();
      y += re;
      slope -= n * im;
      bend -= static_cast<double>(n) * n * re;
      twist += cubes_[k] * im;
    }
    value = std::max(value, sign * y);
    if (!(sign * bend < 0.0)) return angle;
    // Halley's step, where it does not turn Newton's round.
    const double newton = -slope / bend, third = 1.0 + 0.5 * newton * twist / bend;
    const double step = newton / std::max(third, 0.5);
    if (std::abs(angle + step - start) > step_) return angle;
    angle += step;
    if (std::abs(step) < kAngleTolerance * step_) {
      value = std::max(value, sign * (y + step * (slope + 0.5 * step * bend)));
      return angle;
    }
  }
  return angle;
}

double TrigonometricSum::largest(const Complex* a, Eigen::Index column, double sign, double& angle) {
  const double* y = samples_.col(column).data();
  const auto points = static_cast<int>(samples_.rows());
  // Between three points the sum is above the parabola through them by at most this.
  double third = 0.0;
  for (std::size_t k = 0; k < multiples_.size(); ++k) third += cubes_[k] * std::sqrt(std::norm(a[k]));
  const double slack = third * step_ * step_ * step_ / (9.0 * std::sqrt(3.0));
  std::vector<Top>& tops = tops_;
  tops.clear();
  double highest = -std::numeric_limits<double>::infinity();
  for (int p = 0; p < points; ++p) {
    const double before = sign * y[p > 0 ? p - 1 : points - 1], here = sign * y[p],
                 after = sign * y[p + 1 < points ? p + 1 : 0];
    if (here < before || here < after) continue;
    const double bend = 2.0 * here - before - after, tilt = 0.5 * (after - before);
    const double shift = bend > 0.0 ? tilt / bend : 0.0;
    tops.push_back({p + shift, here + 0.5 * tilt * shift});
    highest = std::max(highest, here);
  }
  double best = -std::numeric_limits<double>::infinity();
  std::sort(tops.begin(), tops.end(), [](const Top& one, const Top& two) { return one.value > two.value; });
  for (const Top& top : tops) {
    if (top.value + slack < std::max(best, highest)) break;
    double value = -std::numeric_limits<double>::infinity();
    const double found = refine(a, step_ * top.at, sign, value);
    if (value > best) best = value, angle = found;
  }
  angle = (angle - kTwoPi * std::floor(angle / kTwoPi)) / base_;
  return best;
}

void TrigonometricSum::extremes(const Eigen::MatrixXcd& amplitudes, std::vector<SumExtremes>& out) {
  out.assign(static_cast<std::size_t>(amplitudes.cols()), {});
  if (multiples_.empty() || amplitudes.cols() == 0) return;
  const Eigen::Index points = samples_.rows(), quarter = points / 4, columns = amplitudes.cols();
  for (Group* group : {&even_, &odd_}) {
    const auto rows = static_cast<Eigen::Index>(group->rows.size());
    group->real.resize(rows, columns);
    group->imaginary.resize(rows, columns);
    for (Eigen::Index c = 0; c < columns; ++c)
      for (Eigen::Index k = 0; k < rows; ++k) {
        const Complex a = amplitudes(group->rows[static_cast<std::size_t>(k)], c);
        group->real(k, c) = a.real();
        group->imaginary(k, c) = a.imag();
      }
    group->of_cosines.noalias() = group->cosines * group->real;
    group->of_sines.noalias() = group->sines * group->imaginary;
  }
  // cos n (pi - x) = (-1)^n cos n x, sin n (pi - x) = -(-1)^n sin n x, and both times (-1)^n at x + pi.
  samples_.resize(points, columns);
  for (Eigen::Index c = 0; c < columns; ++c) {
    double* y = samples_.col(c).data();
    const double *ce = even_.of_cosines.col(c).data(), *se = even_.of_sines.col(c).data(),
                 *co = odd_.of_cosines.col(c).data(), *so = odd_.of_sines.col(c).data();
    for (Eigen::Index p = 0; p <= quarter; ++p) {
      const double plus = ce[p] + co[p], minus = ce[p] - co[p], sines = se[p] + so[p], other = se[p] - so[p];
      y[p] = plus - sines;
      y[2 * quarter - p] = minus + other;
      y[2 * quarter + p] = minus - other;
      if (p > 0) y[points - p] = plus + sines;
    }
  }
  for (Eigen::Index c = 0; c < amplitudes.cols(); ++c) {
    SumExtremes& e = out[static_cast<std::size_t>(c)];
    const Complex* a = amplitudes.data() + c * amplitudes.rows();
    if (!samples_.col(c).allFinite()) {
      e.max = std::numeric_limits<double>::infinity();
      e.min = -e.max;
      continue;
    }
    if (samples_.col(c).isZero(0.0)) continue;
    e.max = largest(a, c, 1.0, e.max_angle);
    e.min = -largest(a, c, -1.0, e.min_angle);
  }
}

}  // namespace drev
