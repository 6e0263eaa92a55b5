#pragma once
/// A load on one node: p(t, theta, theta_dot) on the RIGHT side of the equation of motion; positive
/// accelerates the node in the positive sense.
#include <vector>

namespace drev {

/// What a load sees. theta = nominal_angle + deviation is the node's actual angle.
struct LoadInput {
  double t = 0.0;              ///< s
  double nominal_angle = 0.0;  ///< n phi(t) [rad]
  double deviation = 0.0;      ///< q [rad] (or m)
  double speed = 0.0;          ///< n phi' + q' [rad/s] (or m/s)
};

/// What a load returns.
struct LoadResponse {
  double torque = 0.0;         ///< N m (or N)
  double dtorque_dangle = 0.0; ///< N m/rad
  double dtorque_dspeed = 0.0; ///< N m s/rad
};

class Load {
 public:
  virtual ~Load() = default;
  virtual LoadResponse evaluate(const LoadInput& in) const = 0;
  /// False: the load is a function of time (through t or the nominal angle) alone.
  virtual bool depends_on_motion() const { return true; }
  /// Times at which the load jumps or kinks [s]: integration stops there and starts anew.
  virtual std::vector<double> breakpoints() const { return {}; }
};

}  // namespace drev
