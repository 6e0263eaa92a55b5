#pragma once
/// HarmonicLoad: a load that states itself as harmonics of its angle, for methods that need no more of it.
///
///   p = mean + sum cosine_i cos(order_i theta) + sine_i sin(order_i theta)
///
/// theta is the actual angle (nominal + deviation), or the nominal one of a load that does not depend on motion.
#include <drev/core/load.hpp>

#include <cmath>
#include <span>

namespace drev {

struct LoadOrder {
  double order = 0.0;               ///< per revolution, > 0
  double cosine = 0.0, sine = 0.0;  ///< N m (or N)
};

struct LoadOrders {
  double mean = 0.0;                      ///< N m (or N)
  std::span<const LoadOrder> terms = {};  ///< by ascending order

  /// Calls term(o, cos(o.order theta), sin(o.order theta)) for each of them. Orders of even spacing are a rotation
  /// each: cosine and sine are called once a spacing.
  template <class Term>
  void for_each(double angle, const Term& term) const {
    double before = 0.0, spacing = 0.0, c = 1.0, s = 0.0, c_spacing = 1.0, s_spacing = 0.0;
    for (const LoadOrder& o : terms) {
      if (o.order - before != spacing) {
        spacing = o.order - before;
        c_spacing = std::cos(spacing * angle);
        s_spacing = std::sin(spacing * angle);
      }
      const double rotated = c * c_spacing - s * s_spacing;
      s = s * c_spacing + c * s_spacing;
      c = rotated;
      before = o.order;
      term(o, c, s);
    }
  }
  /// Torque and its slope at an angle [rad].
  LoadResponse at(double angle) const {
    LoadResponse sum{.torque = mean};
    for_each(angle, [&](const LoadOrder& o, double c, double s) {
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
