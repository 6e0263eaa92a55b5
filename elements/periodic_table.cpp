#include <drev/core/load_table.hpp>
#include <drev/elements/periodic_table.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace drev {

PeriodicTable::PeriodicTable(std::vector<double> arguments, std::vector<double> values, double period)
    : period_(period), inverse_period_(1.0 / period) {
  auto points = std::make_shared<Points>(Points{std::move(arguments), std::move(values), {}});
  points_ = points;
  const std::vector<double>& u = points->arguments;
  const std::vector<double>& v = points->values;
  const std::size_t n = u.size();
  if (n < 2 || v.size() != n) return;  // unusable; check() says so
  const double spacing = period_ / static_cast<double>(n);
  bool even = true;
  for (std::size_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const double step = (last ? u[0] + period_ : u[i + 1]) - u[i];
    points->slopes.push_back((v[last ? 0 : i + 1] - v[i]) / step);
    // Loose enough for angles written down with a few digits: table_segment() corrects by one.
    even = even && std::abs(u[i] - u[0] - static_cast<double>(i) * spacing) < 0.25 * spacing;
  }
  if (even) inverse_spacing_ = 1.0 / spacing;
}

CurvePoint PeriodicTable::at(double argument) const {
  const Points& p = *points_;
  const double turns = (argument - p.arguments[0]) * inverse_period_;
  // Conversion truncates; std::floor is a library call on the oldest x86-64.
  double whole = turns;
  if (std::abs(turns) < 4e15) {
    whole = static_cast<double>(static_cast<std::int64_t>(turns));
    if (whole > turns) whole -= 1.0;
  }
  const double u = argument - period_ * whole;
  const std::size_t i = table_segment(p.arguments, inverse_spacing_, u);
  return {p.values[i] + p.slopes[i] * (u - p.arguments[i]), p.slopes[i]};
}

TableStretch PeriodicTable::stretch(double argument, double direction) const {
  const LoadStretch s = as_load().stretch(argument, direction);
  return {s.torque, s.angle_slope, s.low, s.high};
}

std::optional<double> PeriodicTable::next_knot(double argument, double direction) const {
  const TableStretch s = stretch(argument, direction);
  const double knot = direction > 0.0 ? s.high : s.low;
  return std::isfinite(knot) ? std::optional(knot) : std::nullopt;
}

LoadTable PeriodicTable::as_load(double phase) const {
  return {.arguments = arguments(),
          .values = values(),
          .slopes = slopes(),
          .period = period_,
          .phase = phase,
          .evenly_spaced = evenly_spaced()};
}

double PeriodicTable::mean() const {
  const std::size_t n = arguments().size();
  double integral = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const double step = (last ? arguments()[0] + period_ : arguments()[i + 1]) - arguments()[i];
    integral += 0.5 * step * (values()[i] + values()[last ? 0 : i + 1]);
  }
  return integral / period_;
}

void PeriodicTable::check(ParameterCheck& check, const std::string& parameter,
                          const std::string& argument_unit, const std::string& value_unit) const {
  const std::size_t n = arguments().size();
  if (n < 2) check.fail(parameter, std::to_string(n), "points", "a periodic table needs at least 2");
  if (values().size() != n)
    check.fail(parameter, std::to_string(values().size()) + " values", "",
               "must be as many as the arguments, " + std::to_string(n));
  check.positive(parameter + ".period", period_, argument_unit);
  check.increasing(parameter + ".arguments", arguments(), argument_unit);
  check.all_finite(parameter + ".values", values(), value_unit);
  const double span = n < 2 ? 0.0 : arguments()[n - 1] - arguments()[0];
  if (n < 2 || span < period_) return;
  std::string hint;
  if (std::abs(span - period_) <= 1e-12 * period_ && values().size() == n)
    hint =
        values()[n - 1] != values()[0]
            ? "; the last point stands where the first one does, with another value: such a curve cannot jump"
        : n == 2 ? "; of these two points one repeats the other, give one between"
                 : "; leave out the point that repeats the first one";
  check.fail(parameter + ".arguments", to_text(span), argument_unit,
             "from first to last must be less than the period, " + to_text(period_) +
                 (argument_unit.empty() ? "" : " " + argument_unit) + hint);
}

}  // namespace drev
