#include "elements/periodic_table.hpp"

#include <algorithm>
#include <cmath>

namespace drev {

PeriodicTable::PeriodicTable(std::vector<double> arguments, std::vector<double> values,
                             double period)
    : arguments_(std::move(arguments)), values_(std::move(values)), period_(period) {
  const std::size_t n = arguments_.size();
  if (n < 2 || values_.size() != n) return;  // unusable; check() says so
  const double spacing = period_ / static_cast<double>(n);
  bool even = true;
  for (std::size_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const double step = (last ? arguments_[0] + period_ : arguments_[i + 1]) - arguments_[i];
    slopes_.push_back((values_[last ? 0 : i + 1] - values_[i]) / step);
    // Loose enough for angles written down with a few digits: segment() corrects by one.
    even = even && std::abs(arguments_[i] - arguments_[0] - static_cast<double>(i) * spacing) <
                       0.25 * spacing;
  }
  if (even) inverse_spacing_ = 1.0 / spacing;
}

std::size_t PeriodicTable::segment(double u) const {
  const std::size_t n = arguments_.size();
  if (inverse_spacing_ > 0.0) {
    const double guess = std::floor((u - arguments_[0]) * inverse_spacing_);
    const double last = static_cast<double>(n - 1);
    auto i = static_cast<std::size_t>(guess > 0.0 ? std::min(guess, last) : 0.0);
    while (i > 0 && u < arguments_[i]) --i;
    while (i + 1 < n && u >= arguments_[i + 1]) ++i;
    return i;
  }
  const auto after = std::upper_bound(arguments_.begin(), arguments_.end(), u);
  return after == arguments_.begin() ? 0 : static_cast<std::size_t>(after - arguments_.begin()) - 1;
}

CurvePoint PeriodicTable::at(double argument) const {
  const double first = arguments_[0];
  const double u = argument - period_ * std::floor((argument - first) / period_);
  const std::size_t i = segment(u);
  return {values_[i] + slopes_[i] * (u - arguments_[i]), slopes_[i]};
}

double PeriodicTable::mean() const {
  const std::size_t n = arguments_.size();
  double integral = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const double step = (last ? arguments_[0] + period_ : arguments_[i + 1]) - arguments_[i];
    integral += 0.5 * step * (values_[i] + values_[last ? 0 : i + 1]);
  }
  return integral / period_;
}

void PeriodicTable::check(ParameterCheck& check, const std::string& parameter,
                          const std::string& argument_unit, const std::string& value_unit) const {
  const std::size_t n = arguments_.size();
  if (n < 2)
    check.fail(parameter, std::to_string(n), "points", "a periodic table needs at least 2");
  if (values_.size() != n)
    check.fail(parameter, std::to_string(values_.size()) + " values", "",
               "must be as many as the arguments, " + std::to_string(n));
  check.positive(parameter + ".period", period_, argument_unit);
  check.increasing(parameter + ".arguments", arguments_, argument_unit);
  check.all_finite(parameter + ".values", values_, value_unit);
  if (n >= 2 && !(arguments_[n - 1] - arguments_[0] < period_))
    check.fail(parameter + ".arguments", to_text(arguments_[n - 1] - arguments_[0]), argument_unit,
               "from first to last must be less than the period, " + to_text(period_) +
                   "; leave out the point that repeats the first one");
}

}  // namespace drev
