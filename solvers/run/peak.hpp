#pragma once
/// Peak: largest and smallest value of a channel, with their times.
#include <drev/core/lanes.hpp>

#include <algorithm>

namespace drev {

/// Of a channel, or (Number: LaneRow) of the same channel in kLanes variants.
template <class Number>
struct Extremes {
  Number max{}, max_time{};  ///< channel's unit, s
  Number min{}, min_time{};
  /// Enters a value at time t in these lanes. Value and Mask: double and bool, or Lanes and LaneMask.
  template <class Value, class Mask>
  [[gnu::always_inline]] void note(const Value& value, double t, const Mask& lanes) {
    const Mask above = lanes & (value > each(max)), below = lanes & (value < each(min));
    if (!any(above | below)) return;
    put_where(above, value, each(max));
    put_where(above, Value{} + t, each(max_time));
    put_where(below, value, each(min));
    put_where(below, Value{} + t, each(min_time));
  }
};

struct Peak : Extremes<double> {
  double amplitude() const { return std::max(max, -min); }  ///< largest |value|
  double time() const { return max >= -min ? max_time : min_time; }
  void note(double value, double t) { Extremes::note(value, t, true); }
};

}  // namespace drev
