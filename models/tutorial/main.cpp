// From a shaft to a two-stage gear train with backlash, step by step: docs/tutorial.md.
// Shows: closed form, rigid and elastic meshes, modes in two contact states, figures with their errors.
// Run:   build/release/bin/example_tutorial
// Read first: nothing, start with docs/tutorial.md.
#include <drev/core/channel.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/accuracy/accuracy.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/contact_statistics.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace drev;

// [machine]
constexpr double kMotorSpeed = 1480.0 * 2.0 * std::numbers::pi / 60.0;  // rad/s

/// The compressor on its shaft: from node "output" to node "compressor".
void add_compressor(Model& m) {
  m.add_node("output");
  m.add_node("compressor");
  m.add<Inertia>("J_output", {"output"}, {.inertia = 0.9});  // kg m^2
  m.add<Inertia>("J_compressor", {"compressor"}, {.inertia = 6.5});
  m.add<ShaftSpring>("shaft", {"output", "compressor"}, {.stiffness = 4.2e5, .damping = 60.0});
}
// [machine]

/// The motor and two stages of gears: motor - coupling - pinion = wheel/pinion = output.
void add_train(Model& m, bool rigid, double backlash) {
  // [train]
  m.add_node("motor");
  m.add_node("pinion");
  m.add_node("middle");
  m.constant_speed("motor", kMotorSpeed);
  m.add<ShaftSpring>("coupling", {"motor", "pinion"}, {.stiffness = 9e3, .damping = 1.5});
  m.add<Inertia>("J_pinion", {"pinion"}, {.inertia = 0.004});
  m.add<Inertia>("J_middle", {"middle"}, {.inertia = 0.11});
  // [train]
  if (rigid) {
    // [rigid]
    m.add<IdealGear>("stage_1", {"pinion", "middle"}, {.ratio = -21.0 / 83.0});
    m.add<IdealGear>("stage_2", {"middle", "output"}, {.ratio = -19.0 / 77.0});
    // [rigid]
    return;
  }
  // [meshes]
  const double alpha = 20.0 * std::numbers::pi / 180.0;
  m.add<GearMesh>("stage_1", {"pinion", "middle"},
                  {.module = 3e-3,
                   .teeth_1 = 21,
                   .teeth_2 = 83,
                   .pressure_angle = alpha,
                   .stiffness = 4e8,
                   .normal_backlash = backlash,
                   .damping = 2e3});
  m.add<GearMesh>("stage_2", {"middle", "output"},
                  {.module = 4e-3,
                   .teeth_1 = 19,
                   .teeth_2 = 77,
                   .pressure_angle = alpha,
                   .stiffness = 5e8,
                   .normal_backlash = backlash,
                   .damping = 4e3});
  // [meshes]
}

void print_modes(const char* what, const System& system, Contact contact) {
  const ModeSet modes = solve_modes(system, {.contact = contact});
  std::printf("%s: %d rigid;", what, modes.rigid_modes);
  for (const double f : modes.frequency_Hz) std::printf(" %.2f", f);
  std::printf(" Hz\n");
}

int main() {
  // [shaft]
  Model first("compressor");
  add_compressor(first);
  print_modes("shaft alone", first.build(), Contact::closed);
  std::printf("closed form: %.2f Hz\n", std::sqrt(4.2e5 * (1 / 0.9 + 1 / 6.5)) / (2 * std::numbers::pi));
  // [shaft]

  Model with_ratio("rigid gears");
  add_compressor(with_ratio);
  add_train(with_ratio, true, 0.0);
  print_modes("rigid gears", with_ratio.build(), Contact::closed);

  // [backlash]
  Model train("two-stage train");
  add_compressor(train);
  add_train(train, false, 0.12e-3);
  train.add<EngineOrderTorque>(
      "gas", {"compressor"},
      {.harmonics = {{.order = 2, .amplitude = 700.0}, {.order = 4, .amplitude = 250.0}}, .mean = -600.0});
  const System system = train.build();
  print_modes("teeth in contact", system, Contact::closed);
  print_modes("teeth separated", system, Contact::open);
  // [backlash]

  // [run]
  const AccuracyResult result = run_to_accuracy(system, {.accuracy = 1e-4,
                                                         .t_end = 1.0,
                                                         .deflection = "compressor-output.twist_rad",
                                                         .torques = {"coupling.torque_Nm", "shaft.torque_Nm"},
                                                         .method = {.name = "exact", .tolerance = 1e-8}});
  for (const Figure& f : result.figures)
    std::printf("%-28s %12.6g %-4s +- %.1e%s\n", f.name.c_str(), f.value, f.unit.c_str(), f.error,
                f.kind == Figure::Kind::interval ? " (95 % interval)" : "");
  std::printf("comparable point by point up to %.3g s; %s\n", result.horizon,
              result.summary.brief_report().c_str());
  // [run]

  // [contacts]
  ContactStatistics contacts(system);
  const RunSummary run = run_method(system, result.fine, {.t_end = 1.0}, {&contacts});
  for (const ContactRecord& c : contacts.records())
    std::printf("%s: %ld impacts in front, %ld behind, separated %.1f %% of the time, at most %.0f N\n",
                c.element.c_str(), c.front_impacts, c.back_impacts, 100 * c.time_separated, c.largest_force);
  // [contacts]
  return run.ok() ? 0 : 1;
}
