#pragma once
/// Two long shafts between heavy flywheels, driven far below most of their modes.
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>

#include <cmath>

namespace drev::problems {

/// Shafts of so many segments, between them a coupling or a gear mesh, both named "mesh"; driven with
/// omega [rad/s].
inline System long_shafts(int segments, bool mesh, double omega) {
  Model m("long shafts");
  for (const char* node : {"a", "b", "c", "d"}) m.add_node(node);
  const DistributedShaft::Params shaft{.shear_modulus = 8e10,
                                       .density = 7850,
                                       .outer_diameter = 0.1,
                                       .length = 5.0,
                                       .segments = segments,
                                       .mass = SegmentMass::lumped};
  m.add<Inertia>("Ja", {"a"}, {.inertia = 5.0});
  m.add<Inertia>("Jb", {"b"}, {.inertia = 1.0});
  m.add<Inertia>("Jc", {"c"}, {.inertia = 1.0});
  m.add<Inertia>("Jd", {"d"}, {.inertia = 5.0});
  m.add<DistributedShaft>("s1", {"a", "b"}, shaft);
  m.add<DistributedShaft>("s2", {"c", "d"}, shaft);
  if (mesh)
    m.add<GearMesh>("mesh", {"b", "c"},
                    {.base_radius_1 = 0.1, .base_radius_2 = 0.1, .stiffness = 1e8, .normal_backlash = 1e-4});
  else
    m.add<ShaftSpring>("mesh", {"b", "c"}, {.stiffness = 1e6});
  m.add<AppliedTorque>("drive", {"a"}, {.torque = [omega](double t) { return 2000 * std::sin(omega * t); }});
  m.add<AppliedTorque>("load", {"d"}, {.torque = [](double t) { return 500 * std::sin(90 * t); }});
  return m.build();
}

}  // namespace drev::problems
