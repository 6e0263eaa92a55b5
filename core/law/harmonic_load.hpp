#pragma once
/// HarmonicLoad: a load that states itself as harmonics of its angle, for methods that need no more of it.
///
///   p = mean + sum cosine_i cos(order_i theta) + sine_i sin(order_i theta)
///
/// theta is the actual angle (nominal + deviation), or the nominal one of a load that does not depend on motion.
#include <drev/core/law/orders.hpp>
#include <drev/core/load.hpp>

#include <span>

namespace drev {

struct LoadOrder {
  double order = 0.0;               ///< per revolution, > 0
  double cosine = 0.0, sine = 0.0;  ///< N m (or N)
};

struct LoadOrders {
  double mean = 0.0;                      ///< N m (or N)
  std::span<const LoadOrder> terms = {};  ///< by ascending order

  /// Torque and its slope at an angle [rad].
  LoadResponse at(double angle) const {
    LoadResponse sum{.torque = mean};
    for_each_order(terms, angle, [&](const LoadOrder& o, double c, double s) {
      sum.torque += o.cosine * c + o.sine * s;
      sum.dtorque_dangle += o.order * (o.sine * c - o.cosine * s);
    });
    return sum;
  }
};

class HarmonicLoad : public Load {
 public:
  /// They live as long as the load.
  virtual LoadOrders orders() const = 0;
};

}  // namespace drev
