#include "models/two_inertia/build_two_inertia.hpp"

#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

ModelCase build_two_inertia(Parameters s) {
  s.check();
  const double frequency = s.number("torque_frequency_Hz");
  const double amplitude = s.number("torque_amplitude_Nm");
  Model m("two_inertia");
  m.add_node("motor");
  m.add_node("load");
  m.add<Inertia>("J_motor", {"motor"}, {.inertia = s.number("inertia_1_kg_m2")});
  m.add<Inertia>("J_load", {"load"}, {.inertia = s.number("inertia_2_kg_m2")});
  m.add<ShaftSpring>(
      "shaft", {"motor", "load"},
      {.stiffness = s.number("stiffness_Nm_per_rad"), .damping = s.number("damping_Nms_per_rad")});
  AppliedTorque::Params drive;  // a sine
  if (frequency > 0.0)
    drive.harmonics = {{frequency, amplitude, -kPi / 2}};
  else
    drive.table = TimeTable({0.0}, {0.0});
  m.add<AppliedTorque>("drive", {"motor"}, drive);
  const double j_1 = s.number("inertia_1_kg_m2"), j_2 = s.number("inertia_2_kg_m2");
  const double omega = std::sqrt(s.number("stiffness_Nm_per_rad") * (j_1 + j_2) / (j_1 * j_2));
  return {.model = std::move(m),
          .duration = s.number("duration_s"),
          // 200 steps in a period of the mode and of the torque: the mode's period is off by 8e-5.
          .default_step = kTwoPi / std::max(omega, hz(frequency)) / 200,
          .deflection = "load-motor.twist_rad",
          .torques = {"shaft.torque_Nm"},
          .channels = {"motor.angle_rad", "load.angle_rad", "shaft.torque_Nm"}};
}

const ModelEntry& two_inertia_entry() {
  using Kind = Parameter::Kind;
  static const ModelEntry entry{
      "two_inertia",
      "motor and load on one elastic shaft, driven by a sine torque: read this one first",
      {{"inertia_1_kg_m2", Kind::number, "0.012", "kg m^2", 1e-9, 1e9, {}, "of the motor"},
       {"inertia_2_kg_m2", Kind::number, "0.035", "kg m^2", 1e-9, 1e9, {}, "of the load"},
       {"stiffness_Nm_per_rad", Kind::number, "8500", "N m/rad", 1e-6, 1e15, {}, "of the shaft"},
       {"damping_Nms_per_rad", Kind::number, "0.5", "N m s/rad", 0, 1e12, {}, "of the shaft"},
       {"torque_amplitude_Nm", Kind::number, "20", "N m", 0, 1e12, {}, "on the motor"},
       {"torque_frequency_Hz", Kind::number, "40", "Hz", 0, 1e6, {}, "of the motor's torque"},
       {"duration_s", Kind::number, "0.5", "s", 1e-9, 1e6, {}, "simulated time"}},
      build_two_inertia};
  return entry;
}

}  // namespace drev
