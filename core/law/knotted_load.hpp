#pragma once
/// KnottedLoad: what a Load may say besides: at which angles its torque kinks or jumps, and that it is smooth between,
///
///   p = P(theta) S(theta) + G(theta) w^2
///
/// P: a cubic between knots; S and G: smooth curves (analytic), each of the same period. theta and w are the node's actual
/// angle [rad] and speed [rad/s], the nominal ones of a load that does not depend on motion. Exact propagation then
/// passes any number of knots inside its steps, and calls the load no more.
#include <array>
#include <limits>

namespace drev {

/// A cubic about the angle that was asked for: sum terms[k] (theta - angle)^k, for low <= theta <= high.
struct CubicPiece {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::array<double, 4> terms = {};
};

class KnottedLoad {
 public:
  struct Curves {
    double factor = 0.0;            ///< S
    double by_speed_squared = 0.0;  ///< G [N m s^2/rad^2]
  };
  virtual ~KnottedLoad() = default;
  /// P about an angle at the node's nominal speed. On a knot, or within rounding of it, the piece ahead of it: on the
  /// side of growing theta where direction > 0, else on the other.
  virtual CubicPiece piece(double angle, double direction, double nominal_speed) const = 0;
  /// Whether P follows the speed (the actual one where the node has no nominal motion). Its knots do not.
  virtual bool piece_follows_speed() const = 0;
  virtual Curves curves(double angle) const = 0;
  /// The period of S and G in revolutions of the node; 0: they have none, and the load is called between its knots.
  virtual int turns() const = 0;
};

}  // namespace drev
