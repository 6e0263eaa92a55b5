#pragma once
/// One harmonic of a periodic quantity, and sums of them.
///
///   amplitude cos(order angle + phase)
///
/// A cosine with a phase, so that a sine is phase = -pi/2. Orders are counted per revolution
/// (engine torque: half orders exist) or per mesh period (mesh: whole numbers). A negative
/// amplitude is allowed.
#include <drev/core/error.hpp>
#include <drev/core/law/dual.hpp>
#include <drev/elements/curve.hpp>

#include <cmath>
#include <vector>

namespace drev {

struct Harmonic {
  double order = 0.0;      ///< periods per 2 pi of the angle [-], > 0
  double amplitude = 0.0;  ///< in the unit of the quantity
  double phase = 0.0;      ///< rad
};

/// Sum over the harmonics at an angle [rad]; the slope is per rad.
inline CurvePoint sum_at(const std::vector<Harmonic>& harmonics, double angle) {
  CurvePoint sum;
  for (const Harmonic& h : harmonics) {
    const double argument = h.order * angle + h.phase;
    sum.value += h.amplitude * std::cos(argument);
    sum.slope -= h.amplitude * h.order * std::sin(argument);
  }
  return sum;
}

/// The same over a dual number, with its slopes.
inline Dual sum_at(const std::vector<Harmonic>& harmonics, const Dual& angle) {
  const CurvePoint sum = sum_at(harmonics, angle.value);
  return Dual::chain(angle, sum.value, sum.slope);
}

/// Orders > 0 (whole where asked), amplitudes and phases finite. `order` is what the caller calls an order.
inline void check_harmonics(ParameterCheck& check, const std::string& parameter,
                            const std::vector<Harmonic>& harmonics, const std::string& unit,
                            bool whole_orders, const std::string& order = "order",
                            const std::string& order_unit = "") {
  for (std::size_t i = 0; i < harmonics.size(); ++i) {
    const std::string item = parameter + "[" + std::to_string(i) + "]";
    check.positive(item + "." + order, harmonics[i].order, order_unit);
    if (whole_orders && harmonics[i].order != std::floor(harmonics[i].order))
      check.fail(item + "." + order, to_text(harmonics[i].order), order_unit, "must be a whole number");
    check.finite(item + ".amplitude", harmonics[i].amplitude, unit);
    check.finite(item + ".phase", harmonics[i].phase, "rad");
  }
}

}  // namespace drev
