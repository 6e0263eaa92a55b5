#pragma once
/// One gear on a pinion that turns at constant speed, base radii 1 m, J = 1 kg m^2:
///
///   x'' + c x' + k(t) dz(x) = mean + sum A_i cos(order_i w t),   dz: dead zone of the backlash
///
/// x is the wheel's deviation. The mesh has one tooth a revolution: its period is 2 pi/w.
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>

namespace drev::problems {

struct DrivenGear {
  double speed = 1.0;                    ///< w [rad/s]
  MeshStiffness stiffness = 1.0;         ///< k
  double half_gap = 0.0;                 ///< 0: linear
  double damping = 0.0;                  ///< c, by damping_law: as given, it acts in the gap too
  double mean = 0.0;                     ///< N m
  std::vector<Harmonic> harmonics = {};  ///< of w, amplitude [N m]
  double mesh_phase = 0.0;               ///< mesh periods
  double x = 0.0, v = 0.0;               ///< at the start
  TransmissionError transmission_error = {};
  MeshDamping damping_law = MeshDamping::always;
  double reference_penetration = GearMesh::Params{}.reference_penetration;  ///< m, of laws that follow it

  System build() const {
    Model m("driven gear");
    m.add_node("pinion");
    m.add_node("wheel");
    m.add<Inertia>("J", {"wheel"}, {.inertia = 1.0});
    m.add<GearMesh>("mesh", {"pinion", "wheel"},
                    {.base_radius_1 = 1.0,
                     .base_radius_2 = 1.0,
                     .teeth_1 = 1,
                     .teeth_2 = 1,
                     .stiffness = stiffness,
                     .normal_backlash = 2.0 * half_gap,
                     .damping = damping,
                     .damping_law = damping_law,
                     .reference_penetration = reference_penetration,
                     .transmission_error = transmission_error,
                     .mesh_phase = mesh_phase});
    m.add<EngineOrderTorque>("torque", {"wheel"},
                             {.harmonics = harmonics, .mean = mean, .twist_feedback = false});
    m.constant_speed("pinion", speed);
    m.set_initial("wheel", x, v);
    return m.build();
  }
};

}  // namespace drev::problems
