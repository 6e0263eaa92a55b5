#include <drev/core/load_table.hpp>
#include <drev/elements/periodic_curve.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

/// Solves a cyclic tridiagonal system, symmetric, diagonally dominant: off[i] couples i and i + 1 (the last one
/// with the first), by Sherman and Morrison's formula about two solves of Thomas' algorithm.
std::vector<double> solve_cyclic(std::vector<double> diagonal, const std::vector<double>& off,
                                 std::vector<double> right) {
  const std::size_t n = diagonal.size();
  const double corner = off[n - 1], gamma = -diagonal[0];
  diagonal[0] -= gamma;
  diagonal[n - 1] -= corner * corner / gamma;
  std::vector<double> side(n, 0.0);
  side[0] = gamma;
  side[n - 1] = corner;
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = off[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * off[i - 1];
    right[i] -= factor * right[i - 1];
    side[i] -= factor * side[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) {
    const double next = i + 1 < n ? off[i] * right[i + 1] : 0.0;
    const double next_side = i + 1 < n ? off[i] * side[i + 1] : 0.0;
    right[i] = (right[i] - next) / diagonal[i];
    side[i] = (side[i] - next_side) / diagonal[i];
  }
  const double ratio = corner / gamma;
  const double factor = (right[0] + ratio * right[n - 1]) / (1.0 + side[0] + ratio * side[n - 1]);
  for (std::size_t i = 0; i < n; ++i) right[i] -= factor * side[i];
  return right;
}

}  // namespace

PeriodicCurve::PeriodicCurve(PeriodicTable points, Interpolation interpolation)
    : points_(std::move(points)), interpolation_(interpolation) {
  const std::vector<double>&u = points_.arguments(), &v = points_.values(), &slope = points_.slopes();
  const std::size_t n = u.size();
  if (interpolation != Interpolation::cubic || n < 3 || v.size() != n || slope.size() != n) return;
  std::vector<double> h(n), diagonal(n), right(n);
  for (std::size_t i = 0; i < n; ++i) h[i] = i + 1 < n ? u[i + 1] - u[i] : u[0] + points_.period() - u[i];
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i > 0 ? i - 1 : n - 1;
    diagonal[i] = 2.0 * (h[before] + h[i]);
    right[i] = 6.0 * (slope[i] - slope[before]);
  }
  const std::vector<double> curvature = solve_cyclic(diagonal, h, right);
  auto segments = std::make_shared<std::vector<Cubic>>();
  for (std::size_t i = 0; i < n; ++i) {
    const double m = curvature[i], next = curvature[i + 1 < n ? i + 1 : 0];
    segments->push_back({slope[i] - h[i] * (2.0 * m + next) / 6.0, 0.5 * m, (next - m) / (6.0 * h[i])});
  }
  segments_ = segments;
}

CurvePoint PeriodicCurve::at(double argument) const {
  if (!segments_) return points_.at(argument);
  const std::vector<double>& u = points_.arguments();
  const double period = points_.period();
  const double within = argument - period * std::floor((argument - u[0]) / period);
  const double inverse_spacing = points_.evenly_spaced() ? static_cast<double>(u.size()) / period : 0.0;
  const std::size_t i = table_segment(u, inverse_spacing, within);
  const Cubic& c = (*segments_)[i];
  const double s = within - u[i];
  return {points_.values()[i] + s * (c.b + s * (c.c + s * c.d)), c.b + s * (2.0 * c.c + 3.0 * s * c.d)};
}

CubicPiece PeriodicCurve::piece(double argument, double direction) const {
  constexpr double kOnKnot = 1e-13;  // distance from a knot over the argument, or over 1 rad
  const std::vector<double>& u = points_.arguments();
  const std::size_t n = u.size();
  const double period = points_.period(), near = kOnKnot * std::max(1.0, std::abs(argument));
  const double within = argument - period * std::floor((argument - u[0]) / period);
  const double inverse_spacing = points_.evenly_spaced() ? static_cast<double>(n) / period : 0.0;
  std::size_t i = table_segment(u, inverse_spacing, within);
  const auto width = [&](std::size_t k) { return (k + 1 < n ? u[k + 1] : u[0] + period) - u[k]; };
  double s = within - u[i];
  if (direction > 0.0 && width(i) - s <= near) {
    s -= width(i);
    i = i + 1 < n ? i + 1 : 0;
  } else if (!(direction > 0.0) && s <= near) {
    i = i > 0 ? i - 1 : n - 1;
    s += width(i);
  }
  const Cubic c = segments_ ? (*segments_)[i] : Cubic{points_.slopes()[i], 0.0, 0.0};
  return {argument - s,
          argument + (width(i) - s),
          {points_.values()[i] + s * (c.b + s * (c.c + s * c.d)), c.b + s * (2.0 * c.c + 3.0 * s * c.d),
           c.c + 3.0 * s * c.d, c.d}};
}

double PeriodicCurve::mean() const {
  if (!segments_) return points_.mean();
  const std::vector<double>& u = points_.arguments();
  double integral = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double h = i + 1 < u.size() ? u[i + 1] - u[i] : u[0] + points_.period() - u[i];
    const Cubic& c = (*segments_)[i];
    integral += h * (points_.values()[i] + h * (c.b / 2.0 + h * (c.c / 3.0 + h * c.d / 4.0)));
  }
  return integral / points_.period();
}

void PeriodicCurve::check(ParameterCheck& check, const std::string& parameter,
                          const std::string& argument_unit, const std::string& value_unit) const {
  points_.check(check, parameter, argument_unit, value_unit);
  if (interpolation_ == Interpolation::cubic && points_.arguments().size() == 2)
    check.fail(parameter, "2", "points", "a cubic spline needs at least 3");
}

CurveFamily::Point CurveFamily::at(double argument, double parameter) const {
  const auto alone = [&](const PeriodicCurve& curve) {
    const CurvePoint p = curve.at(argument);
    return Point{p.value, p.slope, 0.0};
  };
  if (curves_.size() == 1 || parameter <= parameters_.front()) return alone(curves_.front());
  if (parameter >= parameters_.back()) return alone(curves_.back());
  const auto above = std::upper_bound(parameters_.begin(), parameters_.end(), parameter);
  const auto i = static_cast<std::size_t>(above - parameters_.begin());
  const double width = parameters_[i] - parameters_[i - 1], part = (parameter - parameters_[i - 1]) / width;
  const CurvePoint a = curves_[i - 1].at(argument), b = curves_[i].at(argument);
  return {a.value + part * (b.value - a.value), a.slope + part * (b.slope - a.slope),
          (b.value - a.value) / width};
}

}  // namespace drev
