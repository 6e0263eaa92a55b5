#pragma once
/// x'' + 0.1 x' + dz(x) = 0.1 + 0.5 cos t, dz: dead zone of half width 1 and slope 1. Chaotic: largest
/// Lyapunov exponent 0.10947 a unit of time; long-run statistics and their standard errors, by a separate program over 5000 periods:
/// mean 0.3926 +- 0.0039, standard deviation 0.9676 +- 0.0028, share of the time in the gap
/// 0.5816 +- 0.0036, 1 % quantile -1.849 +- 0.009, 99 % quantile 1.996 +- 0.005.
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>

inline drev::System chaotic_oscillator() {
  drev::Model m("chaotic oscillator");
  m.add_node("hub");
  m.add_node("x");
  m.add<drev::Inertia>("J", {"x"}, {.inertia = 1.0});
  m.add<drev::Dashpot>("c", {"hub", "x"}, {.damping = 0.1});
  m.add<drev::PolylineSpring>("stop", {"hub", "x"}, drev::PolylineSpring::dead_band(1.0, 1.0));
  // The hub turns at 1 rad/s, so that the angle of x is the time.
  m.add<drev::EngineOrderTorque>("load", {"x"},
                                 {.harmonics = {{1.0, 0.5, 0.0}}, .mean = 0.1, .twist_feedback = false});
  m.constant_speed("hub", 1.0);
  return m.build();
}
