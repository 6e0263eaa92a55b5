#pragma once
/// m = 1 kg, k = (2 pi)^2 N/m to ground: period 1 s.
#include <drev/core/model.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/ground_spring.hpp>
#include <drev/elements/inertia.hpp>

inline drev::Model unit_oscillator() {
  drev::Model m("oscillator");
  m.add_node("m", drev::NodeKind::translational);
  m.add<drev::Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<drev::GroundSpring>("spring", {"m"}, {.stiffness = 4 * drev::kPi * drev::kPi});
  return m;
}
