#pragma once
/// Motion that is known in advance: the nominal rotation of the reference shaft, or the motion of a
/// prescribed node.
#include <functional>
#include <vector>

namespace drev {

/// Value, first and second time derivative of a known motion: rad, rad/s, rad/s^2 (or m, ...).
struct MotionPoint {
  double value = 0.0;
  double rate = 0.0;
  double acceleration = 0.0;
};

/// A known motion and the times at which its rate or acceleration jumps. Integration stops at each of
/// them and starts anew. At a jump the function gives the value after it.
struct Motion {
  std::function<MotionPoint(double t)> at;
  std::vector<double> breakpoints = {};  ///< s
  /// The acceleration is constant between breakpoints, so that the motion is a polynomial of t there.
  bool piecewise_quadratic = false;
  /// Of a motion that repeats [Hz], > 0; 0: it does not repeat, or its period is not known.
  double frequency = 0.0;
};

/// phi = phi_0 + omega t.  omega in rad/s, phi_0 in rad.
Motion constant_speed(double omega, double phi_0 = 0.0);

/// Run-up (or run-down) at constant acceleration: omega_0 until time_0, omega_1 from time_1 on, linear
/// between. Needs time_1 > time_0. rad/s and s.
Motion run_up(double omega_0, double omega_1, double time_0, double time_1);

}  // namespace drev
