#pragma once
/// Conversions into SI at the places where people write other units. Inside drev everything is SI:
/// rad, s, N m, kg m^2, m.
#include <numbers>

namespace drev {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Angle: degrees to rad.
constexpr double deg(double degrees) { return degrees * (kPi / 180.0); }
/// Angle: rad to degrees.
constexpr double to_deg(double radians) { return radians * (180.0 / kPi); }
/// Rotational speed: revolutions per minute to rad/s.
constexpr double rpm(double revolutions_per_minute) { return revolutions_per_minute * (kTwoPi / 60); }
/// Frequency: Hz to rad/s.
constexpr double hz(double hertz) { return hertz * kTwoPi; }
/// Frequency: rad/s to Hz.
constexpr double to_hz(double rad_per_s) { return rad_per_s / kTwoPi; }
constexpr double to_rpm(double rad_per_s) { return 60.0 * to_hz(rad_per_s); }
/// Length: mm to m.
constexpr double mm(double millimetres) { return millimetres * 1e-3; }

}  // namespace drev
