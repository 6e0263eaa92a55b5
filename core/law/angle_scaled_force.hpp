#pragma once
/// AngleScaledForce: what a ScalarForce may say besides of its pieces_scale(): the formula of it, for methods that
/// expand it into a series.
///
///   r(theta) = value + slope (theta - angle) + sum cosine_i cos(order_i theta) + sine_i sin(order_i theta)
///
/// between two of its knots. Laws without it are sampled.
#include <limits>
#include <span>

namespace drev {

struct ScaleOrder {
  double order = 0.0;               ///< per revolution, > 0
  double cosine = 0.0, sine = 0.0;  ///< of order theta [-]
};

struct ScaleStretch {
  double value = 1.0;  ///< at the angle it was asked for, without the orders
  double slope = 0.0;  ///< 1/rad
  double low = -std::numeric_limits<double>::infinity();  ///< holds from here [rad]
  double high = std::numeric_limits<double>::infinity();  ///< to here
  std::span<const ScaleOrder> orders = {};                ///< they live as long as the law
};

class AngleScaledForce {
 public:
  virtual ~AngleScaledForce() = default;
  /// About an angle [rad]; within rounding of a knot the stretch ahead of it: above it where direction > 0, else
  /// below.
  virtual ScaleStretch scale_stretch(double angle, double direction) const = 0;
};

}  // namespace drev
