// ExpandedLaws: their slopes in a sweep, and knots with the motion that it adds.
#include <algorithm>
#include <cmath>

#include "solvers/contact/roots.hpp"
#include "solvers/exact/expanded_laws.hpp"

namespace drev {

namespace {

PolynomialDerivatives derivatives(std::span<const double> terms, double s) {
  PolynomialDerivatives d;
  find_derivatives(static_cast<int>(terms.size()), terms.data(), s, d);
  return d;
}

/// Derivative d of p (y_0 + k x), where y = y_0 + k x: sum over i of d!/(i! (d - i)!) p^(d-i) (y_0 + k x)^(i).
double scaled_derivative(std::size_t d, const double* p, double y, double k, const double* x) {
  double sum = p[d] * y, ways = 1.0;
  for (std::size_t i = 1; i <= d; ++i) {
    ways *= static_cast<double>(d - i + 1) / static_cast<double>(i);
    sum += ways * p[d - i] * k * x[i];
  }
  return sum;
}

double largest_coefficient(const std::vector<Entry>& row) {
  double most = 0.0;
  for (const Entry& e : row) most = std::max(most, std::abs(e.coeff));
  return most;
}

}  // namespace

void ExpandedLaws::add_slopes(TaylorSeries& series, const Law& law, double factor) {
  const std::vector<Entry>& z = law.term->z;
  series.add_spring(*law.term, factor * law.slope[0]);
  if (factor > 0.0)
    series.add_damper(*law.term, law.by_speed[0]);
  else
    series.take_damper();
  if (!law.varies) return;
  // The series reads a column of the pattern as the row of a force: (column, row) is the slot of one that is not symmetric.
  for (const Entry& e : law.phase_row)
    for (std::size_t column = 0; column < z.size(); ++column) {
      if (z[column].index != e.index) continue;
      for (std::size_t row = 0; row < z.size(); ++row)
        series.add_stiffness(law.term->slots[column * z.size() + row],
                             factor * law.by_phase[0] * z[row].coeff * e.coeff);
    }
}

void ExpandedLaws::use_slopes(TaylorSeries& series, double s) {
  changes_.clear();
  const auto terms = idx(series.degree() + 1);
  for (Law& law : laws_) {
    if (!law.active) continue;
    complete(law, series);
    const PolynomialDerivatives of_x = derivatives(std::span(law.x).first(terms), s);
    const PolynomialDerivatives of_r = derivatives(std::span(law.r).first(law.varies ? terms : 1), s);
    const PolynomialDerivatives of_p =
        derivatives(std::span(law.by_phase_terms).first(slope_terms(law, terms)), s);
    const auto &x = of_x.value, &r = of_r.value, &p = of_p.value;
    const double k = law.k, y = law.y_0 + k * x[0], g = law.g / h_;
    for (std::size_t d = 0; d <= kChanges; ++d) {
      law.slope[d] = k * r[d] + g * x[d + 1];
      law.by_speed[d] = (d == 0 ? law.c : 0.0) + law.g * x[d];
      law.by_phase[d] = scaled_derivative(d, p.data(), y, k, x.data());
    }
    add_slopes(series, law, 1.0);
    note_changes(law, of_x.bound.data(), of_r.bound.data(), of_p.bound.data());
  }
}

/// x, r, p: bounds of these and of their derivatives by s up to kDerivatives.
void ExpandedLaws::note_changes(const Law& law, const double* x, const double* r, const double* p) {
  const double b = largest_coefficient(law.term->z), moved = largest_coefficient(law.gain);
  const double k = std::abs(law.k), g = std::abs(law.g);
  constexpr std::size_t kBehind = kChanges + 1;
  static_assert(kBehind + 1 <= kDerivatives);
  SlopeChange change{.term = law.term};
  change.by_angle = b * moved * (k * r[1] + g * x[2] / h_);
  change.by_angle_behind = b * moved * (k * r[kBehind] + g * x[kBehind + 1] / h_);
  change.by_speed = b * moved * g * x[1];
  change.by_speed_behind = b * moved * g * x[kBehind];
  if (law.varies) {
    const double phase = moved * largest_coefficient(law.phase_row), y = std::abs(law.y_0) + k * x[0];
    change.by_angle += phase * scaled_derivative(1, p, y, k, x);
    change.by_angle_behind += phase * scaled_derivative(kBehind, p, y, k, x);
    for (const Entry& e : law.phase_row)
      if (std::none_of(law.term->z.begin(), law.term->z.end(),
                       [&](const Entry& own) { return own.index == e.index; }))
        change.left_out = std::max(change.left_out, moved * std::abs(e.coeff * law.by_phase[0]));
  }
  changes_.push_back(change);
}

void ExpandedLaws::return_slopes(TaylorSeries& series) {
  for (auto law = laws_.rbegin(); law != laws_.rend(); ++law)
    if (law->active) add_slopes(series, *law, -1.0);
}

void ExpandedLaws::add_changes(const TaylorSeries& series, int degree, double* moments) const {
  const double per_time = 1.0 / h_;
  std::array<double, TaylorSeries::kMostSwept> y, turned;
  for (const Law& law : laws_) {
    if (!law.active) continue;
    const auto last = idx(degree - 1);  // the last moment of y that a sweep has
    for (std::size_t i = 1; i < last; ++i) {
      y[i] = value_along(law.term->z, series.swept(static_cast<int>(i)));
      turned[i] = law.varies ? value_along(law.phase_row, series.swept(static_cast<int>(i))) : 0.0;
    }
    for (std::size_t j = 0; j + 2 < last; ++j) {
      // int (e - u)^j/j! of the force, whose slopes are those at e less (e - u) times their first derivatives there, and so on.
      double force = 0.0, factor = 1.0;  // (-1)^q (j + q)!/(j! q!)
      for (std::size_t q = 1; q <= kChanges && j + q + 1 < last; ++q) {
        factor *= -static_cast<double>(j + q) / static_cast<double>(q);
        force += factor * (law.slope[q] * y[j + q + 1] + law.by_phase[q] * turned[j + q + 1] +
                           per_time * law.by_speed[q] * y[j + q]);
      }
      double* column = moments + (idx(degree) - j) * idx(series.stride());
      for (const Entry& e : law.term->z) column[e.index] -= e.coeff * force;
    }
  }
}

bool ExpandedLaws::passes_knot(const TaylorSeries& series, double s) {
  const auto terms = idx(series.degree() + 1);
  for (const Law& law : laws_) {
    if (!law.turns) continue;
    if (!std::isfinite(law.stretch.low) && !std::isfinite(law.stretch.high)) continue;
    const double along_series = polynomial_value(std::span(law.theta).first(terms), s);
    const double angle = along_series + value_along(law.phase_row, series.swept(0));
    const bool up = angle > law.stretch.high && along_series <= law.stretch.high;
    const bool down = angle < law.stretch.low && along_series >= law.stretch.low;
    if (!up && !down) continue;
    knot_law_ = &law;
    knot_ = up ? law.stretch.high : law.stretch.low;
    return true;
  }
  return false;
}

double ExpandedLaws::knot_later(const TaylorSeries& series, double s) const {
  const std::span<const double> theta = std::span(knot_law_->theta).first(idx(series.degree() + 1));
  const double angle = polynomial_value(theta, s) + value_along(knot_law_->phase_row, series.swept(0));
  const double rate = polynomial_slope(theta, s) + value_along(knot_law_->phase_row, series.swept(-1));
  return rate != 0.0 ? (knot_ - angle) / rate : 0.0;
}

}  // namespace drev
