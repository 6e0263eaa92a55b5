#pragma once
/// A point of a known curve, and a gate over the speed.
#include <drev/core/error.hpp>
#include <drev/elements/not_given.hpp>

#include <cmath>

namespace drev {

struct Ranged;

struct CurvePoint {
  double value = 0.0;
  double slope = 0.0;  ///< d value / d argument
};

/// SpeedGate: a factor that opens a torque between two speeds.
///
///   g(w) = clamp((w - from_speed)/speed_ramp, 0, 1) clamp((to_speed - w)/speed_ramp, 0, 1)
///
/// 0 below from_speed and above to_speed, 1 between, straight over `speed_ramp` inside each end, so that what it gates
/// stays continuous. An end that is not given is none.
struct SpeedGate {
  double from_speed = kNotGiven;  ///< rad/s (m/s); not given: no lower end
  double to_speed = kNotGiven;    ///< rad/s (m/s), > from_speed; not given: no upper end
  double speed_ramp = kNotGiven;  ///< rad/s (m/s), > 0; needed with either of them

  bool gated() const { return !std::isnan(speed_ramp); }
  /// g at a speed, with its slope; 1 where nothing is gated.
  CurvePoint at(double speed) const {
    if (!gated()) return {1.0, 0.0};
    const auto ramp = [&](double inside, double sign) {
      return inside <= 0.0          ? CurvePoint{0.0, 0.0}
             : inside >= speed_ramp ? CurvePoint{1.0, 0.0}
                                    : CurvePoint{inside / speed_ramp, sign / speed_ramp};
    };
    const CurvePoint open{1.0, 0.0}, low = std::isnan(from_speed) ? open : ramp(speed - from_speed, 1.0),
                                     high = std::isnan(to_speed) ? open : ramp(to_speed - speed, -1.0);
    return {low.value * high.value, low.slope * high.value + low.value * high.slope};
  }
  /// The range of g over one of speeds.
  Ranged over(const Ranged& speed) const;
  void check(ParameterCheck& check) const {
    const bool from = !std::isnan(from_speed), to = !std::isnan(to_speed);
    if (from) check.finite("from_speed", from_speed, "rad/s");
    if (to) check.finite("to_speed", to_speed, "rad/s");
    if (from || to) check.positive("speed_ramp", speed_ramp, "rad/s");
    if (!from && !to && gated())
      check.fail("speed_ramp", to_text(speed_ramp), "rad/s", "needs from_speed or to_speed");
    if (from && to && !(to_speed - from_speed >= 2.0 * speed_ramp))
      check.fail("to_speed", to_text(to_speed), "rad/s",
                 "must be above from_speed, " + to_text(from_speed) + " rad/s, by two speed_ramps at least");
  }
};

}  // namespace drev
