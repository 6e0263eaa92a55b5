#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>

#include <algorithm>
#include <cmath>

#include "models/camshaft/camshaft_data.hpp"

namespace drev {

void add_camshaft(Model& m, const CamshaftParams& p) {
  const CamshaftData& data = camshaft_data();
  const CamTorques& torques = cam_torques();
  const std::vector<int> order = p.firing_order.empty() ? default_firing_order(p.cylinders) : p.firing_order;
  std::string last;
  const auto station = [&](const std::string& name, double inertia) {
    m.add_node(name);
    m.add<Inertia>("J_" + name, {name}, {.inertia = inertia});
  };
  const auto section = [&](const std::string& from, const std::string& to, double stiffness) {
    m.add<ShaftSpring>("shaft_" + from, {from, to}, {.stiffness = stiffness});
  };

  station("gear", data.gear_inertia);
  last = "gear";
  double last_stiffness = data.gear_stiffness;
  for (int k = 1; k <= p.cylinders; ++k) {
    const std::string n = "_" + std::to_string(k);
    const auto place = std::find(order.begin(), order.end(), k) - order.begin();
    const double phase = -kTwoPi * static_cast<double>(place) / p.cylinders;
    const auto cam = [&](const std::string& name, const PeriodicTable& table) {
      m.add<CamTorque>("cam_" + name + n, {name + n},
                       {.angle_table = table, .phase = phase, .twist_feedback = p.twist_feedback});
    };
    station("journal" + n, data.journal_inertia);
    section(last, "journal" + n, last_stiffness);
    station("fuel" + n, data.fuel_inertia);
    section("journal" + n, "fuel" + n, data.journal_stiffness);
    station("exhaust" + n, data.exhaust_inertia);
    section("fuel" + n, "exhaust" + n, data.fuel_stiffness);
    station("inlet" + n, data.inlet_inertia);
    section("exhaust" + n, "inlet" + n, data.exhaust_stiffness);
    cam("fuel", torques.fuel);
    cam("exhaust", torques.exhaust);
    cam("inlet", torques.inlet);
    last = "inlet" + n;
    last_stiffness = data.inlet_stiffness;
  }
  station("end", camshaft_end_inertia(p.cylinders));
  section(last, "end", last_stiffness);
  if (p.rayleigh_a > 0.0 || p.rayleigh_b > 0.0)
    m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = p.rayleigh_a, .beta_stiffness = p.rayleigh_b});
}

ModelCase build_camshaft(Parameters s) {
  const int cylinders = s.integer("cylinders");
  CamshaftParams p{.cylinders = cylinders, .twist_feedback = s.text("loads") == "actual"};
  if (s.text("firing_order") != "default") {
    p.firing_order = s.order("firing_order");
    if (static_cast<int>(p.firing_order.size()) != cylinders)
      s.refuse("firing_order",
               "must name each of the " + std::to_string(cylinders) + " cylinders once; set cylinders too");
  }
  s.check();
  const RayleighCase rayleigh = rayleigh_case(s.text("damping"), cylinders);
  p.rayleigh_a = rayleigh.a;
  p.rayleigh_b = rayleigh.b;

  Model m("camshaft");
  add_camshaft(m, p);
  const std::string& drive = s.text("drive");
  const double engine_speed = rpm(s.number("engine_rpm"));
  if (drive == "gears") {
    add_gear_drive(m, "gear", gear_drive_params(s));
    m.constant_speed("crank_gear", engine_speed);
  } else if (drive == "held") {
    m.constant_speed("gear", 0.5 * engine_speed);
  } else {
    m.set_reference("gear", constant_speed(0.5 * engine_speed));
  }

  const std::string n = std::to_string(cylinders);
  ModelCase model_case{.model = std::move(m)};
  model_case.duration = s.number("duration_s");
  // Fastest mode 1.9 kHz with the gear held (5.3 kHz with the drive). At 1e-5 s average acceleration has its
  // period to 1.2e-3 and the first mode's, at 92 Hz, to 3e-6: four digits of the deflection with the gear
  // held (docs/validation.md).
  // Stiffer meshes make faster modes.
  model_case.default_step = 1e-5;
  if (drive == "gears")
    model_case.default_step /= std::sqrt(std::max(1.0, s.number("mesh_stiffness_factor")));
  model_case.note =
      "The camshaft's inertias, stiffnesses and cam torques are a reconstruction from published results, "
      "not the builder's data.";
  model_case.deflection = "inlet_" + n + "-fuel_1.twist_rad";
  for (const ElementInstance& placement : model_case.model.element_instances())
    if (placement.name.starts_with("shaft_")) model_case.torques.push_back(placement.name + ".torque_Nm");
  model_case.static_turn = (drive == "gears" ? 2.0 : 1.0) * kTwoPi;
  model_case.channels = {model_case.deflection, "fuel_1.angle_rad", "inlet_" + n + ".angle_rad",
                         "end.angle_rad", "shaft_gear.torque_Nm"};
  if (drive == "gears") {
    model_case.channels.push_back("mesh_1.force_N");
    model_case.channels.push_back("mesh_2.force_N");
  }
  return model_case;
}

const ModelEntry& camshaft_entry() {
  using Kind = Parameter::Kind;
  static const ModelEntry entry = [] {
    std::vector<Parameter> parameters{{"cylinders", Kind::integer, "9", "", 6, 10, {}, "number of cylinders"},
                                      {"drive",
                                       Kind::choice,
                                       "gears",
                                       "",
                                       0,
                                       0,
                                       {"gears", "held", "free"},
                                       "gear drive with backlash, gear at constant speed, or nothing held"}};
    for (Parameter& parameter : gear_drive_parameters()) parameters.push_back(std::move(parameter));
    parameters.push_back({"damping",
                          Kind::choice,
                          "case_1",
                          "",
                          0,
                          0,
                          {"undamped", "case_1", "case_2", "case_3", "case_3_corrected"},
                          "Rayleigh damping of the source, as printed or corrected"});
    parameters.push_back({"loads",
                          Kind::choice,
                          "actual",
                          "",
                          0,
                          0,
                          {"actual", "source"},
                          "cam torques at the actual angle, or at the nominal one as in the source"});
    parameters.push_back({"firing_order",
                          Kind::order,
                          "default",
                          "",
                          0,
                          0,
                          {},
                          "cylinders in firing order; default: the source's"});
    parameters.push_back({"engine_rpm",
                          Kind::number,
                          "750",
                          "rpm",
                          1,
                          5000,
                          {},
                          "crankshaft speed; the camshaft turns at half of it"});
    parameters.push_back({"duration_s", Kind::number, "5", "s", 1e-9, 1e4, {}, "simulated time"});
    return ModelEntry{
        "camshaft", "marine diesel camshaft with its two-stage gear drive (reconstructed data): the main job",
        parameters, build_camshaft};
  }();
  return entry;
}

}  // namespace drev
