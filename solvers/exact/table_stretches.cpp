#include "solvers/exact/table_stretches.hpp"

#include <algorithm>
#include <cmath>

namespace drev {

TableStretches::TableStretches(const LoadTable& table)
    : values_(table.values.data()), arguments_(table.arguments.data()), period_(table.period) {
  // From knot to knot at which the slope changes, over one turn from the first of them on.
  LoadTable of_turn = table;
  of_turn.phase = 0.0;
  const LoadStretch first = of_turn.stretch(table.arguments[0], 1.0);
  bounded_ = std::isfinite(first.high);
  if (!bounded_) {
    stretches_.push_back({table.arguments[0], table.values[0], first.angle_slope});
    return;
  }
  const double begin = first.low < table.arguments[0] ? first.high : first.low;
  const double end = begin + period_ - 2.0 * LoadTable::on_knot(period_, begin + period_);
  for (double knot = begin; knot < end;) {
    const LoadStretch stretch = of_turn.stretch(knot, 1.0);
    stretches_.push_back({knot, stretch.torque, stretch.angle_slope});
    knot = stretch.high;
  }
  last_ = stretches_.size() - 1;
}

TableStretches::Place TableStretches::find(double angle, double phase, double direction) const {
  Place place{0, 0.0, phase};
  if (!bounded()) return place;
  const double argument = angle + phase,
               beyond = argument + (direction > 0.0 ? 1.0 : -1.0) * LoadTable::on_knot(period_, argument);
  place.turns = std::floor((beyond - stretches_.front().knot) / period_);
  const auto behind = std::upper_bound(stretches_.begin(), stretches_.end(), beyond - place.turns * period_,
                                       [](double u, const Stretch& s) { return u < s.knot; });
  place.number = behind == stretches_.begin() ? 0 : static_cast<std::size_t>(behind - stretches_.begin()) - 1;
  return place;
}

}  // namespace drev
