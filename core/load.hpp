#pragma once
/// A load on one node: p(t, theta, theta_dot) on the RIGHT side of the equation of motion; positive
/// accelerates the node in the positive sense.
#include <drev/core/law/law_piece.hpp>
#include <drev/core/load_table.hpp>

#include <optional>
#include <vector>

namespace drev {

/// What a load sees. theta = nominal_angle + deviation is the node's actual angle.
struct LoadInput {
  double t = 0.0;              ///< s
  double nominal_angle = 0.0;  ///< n phi(t) [rad]
  double deviation = 0.0;      ///< q [rad] (or m)
  double speed = 0.0;          ///< n phi' + q' [rad/s] (or m/s)
  double nominal_speed = 0.0;  ///< n phi' [rad/s]; 0 where the node does not turn nominally
};

/// What a load returns.
struct LoadResponse {
  double torque = 0.0;          ///< N m (or N)
  double dtorque_dangle = 0.0;  ///< N m/rad
  double dtorque_dspeed = 0.0;  ///< N m s/rad
};

/// Ranges of what a load sees: time [s], actual angle [rad], speed and nominal speed [rad/s]; and bounds of the sizes of its slopes
/// over them.
struct LoadRanges {
  Interval t, angle, speed, nominal_speed;
};
struct LoadSlopes {
  double by_time = 0.0, by_angle = 0.0, by_speed = 0.0;  ///< N m/s, N m/rad, N m s/rad
};

class Load {
 public:
  virtual ~Load() = default;
  virtual LoadResponse evaluate(const LoadInput& in) const = 0;
  /// False: the load is a function of time (through t or the nominal angle) alone.
  virtual bool depends_on_motion() const { return true; }
  /// Frequencies [Hz] of a load that is a sum of harmonics in time; empty: it is none, or they are not known.
  virtual std::vector<double> frequencies() const { return {}; }
  /// Times at which the load jumps or kinks [s]: integration stops there and starts anew.
  virtual std::vector<double> breakpoints() const { return {}; }
  /// The load as a table over the actual angle, or the nominal one of a load that does not depend on motion;
  /// its arrays live as long as the load. nullopt for any other.
  virtual std::optional<LoadTable> table() const { return std::nullopt; }
  /// The stretch about (t, theta), for exact propagation; nullopt for a load that is smooth between its
  /// breakpoints. On a knot, or within rounding of it, the stretch ahead of it: on the side of growing theta
  /// where direction > 0, else on the other. A load with a table need not state it.
  virtual std::optional<LoadStretch> stretch(double /*t*/, double angle, double direction) const {
    const std::optional<LoadTable> straight = table();
    if (!straight) return std::nullopt;
    return straight->stretch(angle, direction);
  }
  /// How steep a load without stretches may be over ranges, at most: exact propagation looks for what it would pass over between
  /// the points at which it calls the load (a gate of 1 rad/s, a pulse of 1 ms). nullopt: not known, it looks between them once.
  virtual std::optional<LoadSlopes> steepest(const LoadRanges& /*over*/) const { return std::nullopt; }
};

}  // namespace drev
