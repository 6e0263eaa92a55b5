// ExpandedLaws: their slopes in a sweep, and knots with the motion that it adds.
#include <algorithm>
#include <cmath>

#include "solvers/contact/roots.hpp"
#include "solvers/exact/expanded_laws.hpp"

namespace drev {

namespace {

/// A polynomial and its derivatives by s.
std::array<double, 4> derivatives(std::span<const double> terms, double s) {
  std::array<double, 4> d{};
  for (std::size_t k = terms.size(); k-- > 0;) {
    for (std::size_t i = d.size() - 1; i > 0; --i) d[i] = d[i] * s + static_cast<double>(i) * d[i - 1];
    d[0] = d[0] * s + terms[k];
  }
  return d;
}

/// Bounds of its derivatives, the first to the fourth, on [0, 1]; of the polynomial itself ahead of them.
std::array<double, 5> largest_derivatives(std::span<const double> terms) {
  std::array<double, 5> most{};
  for (std::size_t k = 0; k < terms.size(); ++k) {
    double size = std::abs(terms[k]);
    for (std::size_t i = 0; i < most.size() && i <= k; ++i) {
      most[i] += size;
      size *= static_cast<double>(k - i);
    }
  }
  return most;
}

double largest_coefficient(const std::vector<Entry>& row) {
  double most = 0.0;
  for (const Entry& e : row) most = std::max(most, std::abs(e.coeff));
  return most;
}

}  // namespace

void ExpandedLaws::add_slopes(TaylorSeries& series, const Law& law, double factor) {
  const std::vector<Entry>& z = law.term->z;
  std::size_t slot = 0;
  for (const Entry& row : z)
    for (const Entry& column : z) {
      const double b = factor * row.coeff * column.coeff;
      series.add_stiffness(law.term->slots[slot], law.slope[0] * b);
      series.add_damping(law.term->slots[slot++], law.by_speed[0] * b);
    }
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
    const std::span<const double> x = std::span(law.x).first(terms);
    const std::span<const double> r = std::span(law.r).first(law.varies ? terms : 1);
    const std::span<const double> p = std::span(law.by_phase_terms).first(law.varies ? terms : 0);
    const auto [x_0, x_1, x_2, x_3] = derivatives(x, s);
    const auto [r_0, r_1, r_2, r_3] = derivatives(r, s);
    const auto [p_0, p_1, p_2, p_3] = derivatives(p, s);
    const double k = law.k, y = law.y_0 + k * x_0, g = law.g / h_;
    law.slope = {k * r_0 + g * x_1, k * r_1 + g * x_2, k * r_2 + g * x_3};
    law.by_speed = {law.c + law.g * x_0, law.g * x_1, law.g * x_2};
    law.by_phase = {p_0 * y, p_1 * y + p_0 * k * x_1, p_2 * y + 2.0 * p_1 * k * x_1 + p_0 * k * x_2};
    add_slopes(series, law, 1.0);
    note_changes(law, x, r, p);
  }
}

void ExpandedLaws::note_changes(const Law& law, std::span<const double> x, std::span<const double> r,
                                std::span<const double> p) {
  const double b = largest_coefficient(law.term->z), moved = largest_coefficient(law.gain);
  const double k = std::abs(law.k), g = std::abs(law.g);
  const std::array<double, 5> of_x = largest_derivatives(x), of_r = largest_derivatives(r);
  SlopeChange change{.term = law.term};
  change.by_angle = b * moved * (k * of_r[1] + g * of_x[2] / h_);
  change.by_angle_3 = b * moved * (k * of_r[3] + g * of_x[4] / h_);
  change.by_speed = b * moved * g * of_x[1];
  change.by_speed_3 = b * moved * g * of_x[3];
  if (law.varies) {
    const std::array<double, 5> of_p = largest_derivatives(p);
    const double phase = moved * largest_coefficient(law.phase_row), y = std::abs(law.y_0) + k * of_x[0];
    change.by_angle += phase * (of_p[1] * y + of_p[0] * k * of_x[1]);
    change.by_angle_3 +=
        phase * (of_p[3] * y + k * (3.0 * (of_p[2] * of_x[1] + of_p[1] * of_x[2]) + of_p[0] * of_x[3]));
    for (const Entry& e : law.phase_row)
      if (std::none_of(law.term->z.begin(), law.term->z.end(),
                       [&](const Entry& own) { return own.index == e.index; }))
        change.left_out = std::max(change.left_out, moved * std::abs(e.coeff * law.by_phase[0]));
  }
  changes_.push_back(change);
}

void ExpandedLaws::return_slopes(TaylorSeries& series) {
  for (const Law& law : laws_)
    if (law.active) add_slopes(series, law, -1.0);
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
    for (std::size_t j = 0; j + 3 < last; ++j) {
      // int (e - u)^j/j! of the force, whose slopes are those at e less (e - u) times their first derivatives there, and so on.
      const double one = static_cast<double>(j + 1), two = 0.5 * one * static_cast<double>(j + 2);
      const double force = -one * (law.slope[1] * y[j + 2] + law.by_phase[1] * turned[j + 2] +
                                   per_time * law.by_speed[1] * y[j + 1]) +
                           two * (law.slope[2] * y[j + 3] + law.by_phase[2] * turned[j + 3] +
                                  per_time * law.by_speed[2] * y[j + 2]);
      double* column = moments + (idx(degree) - j) * idx(series.stride());
      for (const Entry& e : law.term->z) column[e.index] -= e.coeff * force;
    }
  }
}

bool ExpandedLaws::passes_knot(const TaylorSeries& series, double s) {
  const auto terms = idx(series.degree() + 1);
  for (const Law& law : laws_) {
    if (law.scaled == nullptr) continue;
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
