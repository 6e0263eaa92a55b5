#pragma once
/// Orders of an angle: what a sum of cosines and sines is evaluated from.
#include <cmath>
#include <span>

namespace drev {

/// Calls term(o, cos(o.order theta), sin(o.order theta)) for each of the orders. Those of even spacing are a rotation each: cosine and
/// sine are called once a spacing. Rounding adds up to some 1e-16 an order.
template <class Order, class Term>
void for_each_order(std::span<const Order> orders, double angle, const Term& term) {
  double before = 0.0, spacing = 0.0, c = 1.0, s = 0.0, c_spacing = 1.0, s_spacing = 0.0;
  for (const Order& o : orders) {
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

}  // namespace drev
