#include <drev/elements/time_table.hpp>

#include <algorithm>
#include <functional>

namespace drev {

CurvePoint TimeTable::at(double t) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), t);
  if (after == times_.begin()) return {values_.front(), 0.0};
  if (after == times_.end()) return {values_.back(), 0.0};
  // times_[i] <= t < times_[i + 1]: never a jump, whose two times are equal.
  const auto i = static_cast<std::size_t>(after - times_.begin()) - 1;
  const double slope = (values_[i + 1] - values_[i]) / (times_[i + 1] - times_[i]);
  return {values_[i] + slope * (t - times_[i]), slope};
}

std::vector<double> TimeTable::breakpoints() const {
  if (std::adjacent_find(values_.begin(), values_.end(), std::not_equal_to<>()) == values_.end()) return {};
  std::vector<double> knots = times_;
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  return knots;
}

void TimeTable::check(ParameterCheck& check, const std::string& parameter,
                      const std::string& value_unit) const {
  const std::size_t n = times_.size();
  if (n == 0) check.fail(parameter, "0", "points", "a time table needs at least 1");
  if (values_.size() != n)
    check.fail(parameter, std::to_string(values_.size()) + " values", "",
               "must be as many as the times, " + std::to_string(n));
  check.all_finite(parameter + ".times", times_, "s");
  check.all_finite(parameter + ".values", values_, value_unit);
  for (std::size_t i = 1; i < n; ++i) {
    const bool thrice = i >= 2 && times_[i] == times_[i - 2];
    if (times_[i] < times_[i - 1] || thrice) {
      check.fail(parameter + ".times[" + std::to_string(i) + "]", to_text(times_[i]), "s",
                 thrice ? "is given three times; a jump has two"
                        : "must not be less than the time before it, " + to_text(times_[i - 1]));
      return;
    }
  }
}

}  // namespace drev
