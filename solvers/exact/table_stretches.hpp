#pragma once
/// TableStretches: the stretches of a load's table (LoadTable) one behind the other, so that a load that comes over a knot finds the
/// next one without a search: knots, values and slopes of one stretch lie side by side.
#include <drev/core/load_table.hpp>

#include <cstddef>
#include <limits>
#include <vector>

namespace drev {

class TableStretches {
 public:
  explicit TableStretches(const LoadTable& table);
  /// Of the same knots, whatever the phase.
  bool is_of(const LoadTable& table) const {
    return values_ == table.values.data() && arguments_ == table.arguments.data() && period_ == table.period;
  }
  /// A stretch: its number, in so many turns of the table, which is entered at angle + phase.
  struct Place {
    std::size_t number = 0;
    double turns = 0.0, phase = 0.0;
  };
  /// The stretch about an angle, as LoadTable::stretch() has it.
  Place find(double angle, double phase, double direction) const;
  /// Goes on to the one behind its upper bound (rises) or its lower one.
  void step(Place& place, bool rises) const {
    const std::size_t end = rises ? last_ : 0;
    if (place.number != end) {
      place.number += rises ? 1 : std::size_t(-1);
    } else {
      place.number = last_ - end;
      place.turns += rises ? 1.0 : -1.0;
    }
  }
  /// A table without a change of slope has one stretch without bounds.
  bool bounded() const { return bounded_; }
  double low(const Place& p) const { return p.turns * period_ + stretches_[p.number].knot - p.phase; }
  double high(Place p) const {
    step(p, true);
    return low(p);
  }
  double slope(const Place& p) const { return stretches_[p.number].slope; }
  double torque(const Place& p) const { return stretches_[p.number].torque; }  ///< at its lower bound
  /// With the torque at its lower bound. One number after the other: a copy of what was just stored in parts has to wait for it.
  void read(const Place& p, LoadStretch& to) const {
    const Stretch& s = stretches_[p.number];
    to.torque = s.torque;
    to.time_slope = 0.0;
    to.angle_slope = s.slope;
    to.low = bounded_ ? low(p) : -std::numeric_limits<double>::infinity();
    to.high = bounded_ ? high(p) : std::numeric_limits<double>::infinity();
  }

 private:
  struct Stretch {
    double knot, torque, slope;  // argument [rad] in turn 0, N m there, N m/rad
  };
  const double *values_, *arguments_;
  double period_;
  bool bounded_ = true;
  std::size_t last_ = 0;  // number of the last stretch
  std::vector<Stretch> stretches_;
};

}  // namespace drev
