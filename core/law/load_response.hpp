#pragma once
/// A load's torque and slopes from one formula, by dual numbers.
#include <drev/core/law/dual.hpp>
#include <drev/core/load.hpp>

namespace drev {

/// Torque and both slopes of a formula f(angle, speed) over dual numbers, at the node's actual angle and speed.
template <class F>
LoadResponse response_of(const LoadInput& in, const F& f) {
  const Dual r = f(Dual(in.nominal_angle + in.deviation, 1.0, 0.0), Dual(in.speed, 0.0, 1.0));
  return {.torque = r.value, .dtorque_dangle = r.by_x, .dtorque_dspeed = r.by_x_dot};
}

}  // namespace drev
