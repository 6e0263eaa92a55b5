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
    // Loose enough for angles written down with a few digits: segment() corrects by one.
    even = even && std::abs(u[i] - u[0] - static_cast<double>(i) * spacing) < 0.25 * spacing;
  }
  if (even) inverse_spacing_ = 1.0 / spacing;
}

std::size_t PeriodicTable::segment(double u) const {
  const std::vector<double>& a = points_->arguments;
  const std::size_t n = a.size();
  if (inverse_spacing_ > 0.0) {
    const double guess = (u - a[0]) * inverse_spacing_;
    std::size_t i = guess > 0.0 ? std::min(static_cast<std::size_t>(guess), n - 1) : 0;
    while (i > 0 && u < a[i]) --i;
    while (i + 1 < n && u >= a[i + 1]) ++i;
    return i;
  }
  const auto after = std::upper_bound(a.begin(), a.end(), u);
  return after == a.begin() ? 0 : static_cast<std::size_t>(after - a.begin()) - 1;
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
  const std::size_t i = segment(u);
  return {p.values[i] + p.slopes[i] * (u - p.arguments[i]), p.slopes[i]};
}

TableStretch PeriodicTable::stretch(double argument, double direction) const {
  constexpr double kOnKnot = 1e-13;     // relative to the period and the argument
  constexpr double kSameSlope = 1e-13;  // relative to the steepest
  const Points& p = *points_;
  const std::size_t n = p.arguments.size();
  const double nudge = kOnKnot * std::max(period_, std::abs(argument));
  const double beyond = argument + (direction > 0.0 ? nudge : -nudge);
  const double base = period_ * std::floor((beyond - p.arguments[0]) * inverse_period_);
  std::size_t i = segment(beyond - base);
  const double slope = p.slopes[i];
  const double value = p.values[i] + slope * (argument - base - p.arguments[i]);
  double steepest = 0.0;
  for (const double s : {p.slopes.front(), slope, p.slopes.back()})
    steepest = std::max(steepest, std::abs(s));
  const auto same = [&](std::size_t j) { return std::abs(p.slopes[j] - slope) <= kSameSlope * steepest; };
  const auto knot = [&](std::size_t j, double turns) { return base + turns * period_ + p.arguments[j]; };
  TableStretch s{value, slope, 0.0, 0.0};
  std::size_t low = i, high = i, steps = 0;
  double turns_low = 0.0, turns_high = 0.0;
  const auto raise = [&] {
    if (++high == n) high = 0, turns_high = 1.0;
  };
  for (raise(); steps < n && same(high); ++steps) raise();
  if (steps == n) {
    s.low = -std::numeric_limits<double>::infinity();
    s.high = std::numeric_limits<double>::infinity();
    return s;
  }
  const auto before = [&](std::size_t j) { return j == 0 ? n - 1 : j - 1; };
  for (; same(before(low)); low = before(low))
    if (low == 0) turns_low = -1.0;
  s.low = knot(low, turns_low);
  s.high = knot(high, turns_high);
  return s;
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
  if (n >= 2 && !(arguments()[n - 1] - arguments()[0] < period_))
    check.fail(parameter + ".arguments", to_text(arguments()[n - 1] - arguments()[0]), argument_unit,
               "from first to last must be less than the period, " + to_text(period_) +
                   "; leave out the point that repeats the first one");
}

}  // namespace drev
