// Faults of a model written in C++: each is refused with a message that names place, parameter, value, unit
// (where it has one) and what would be right; a model with five faults lists five.
#include <drev/core/channel.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/statics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <functional>

#include "tests/catch.hpp"
#include "tests/unit/not_finite.hpp"

using namespace drev;

namespace {

/// motor -- shaft -- load, sound.
Model sound() {
  Model m("drive");
  m.add_node("motor");
  m.add_node("load");
  m.add<Inertia>("J_motor", {"motor"}, {.inertia = 0.012});
  m.add<Inertia>("J_load", {"load"}, {.inertia = 0.035});
  m.add<ShaftSpring>("shaft", {"motor", "load"}, {.stiffness = 8500.0});
  return m;
}

GearMesh::Params mesh() {
  return {.base_radius_1 = 0.1, .base_radius_2 = 0.2, .stiffness = 1e8, .normal_backlash = 1e-4};
}

using Change = std::function<void(Model&)>;

/// Puts one more element between motor and load, or on the load alone.
template <class E>
Change between(const char* name, typename E::Params params) {
  return [=](Model& m) { m.add<E>(name, {"motor", "load"}, params); };
}
template <class E>
Change on_load(const char* name, typename E::Params params) {
  return [=](Model& m) { m.add<E>(name, {"load"}, params); };
}

Change meshed(const std::function<void(GearMesh::Params&)>& spoil) {
  GearMesh::Params params = mesh();
  spoil(params);
  return [params](Model& m) {
    m.add_node("wheel");
    m.add<Inertia>("J_wheel", {"wheel"}, {.inertia = 1.0});
    m.add<GearMesh>("mesh", {"load", "wheel"}, params);
  };
}

struct Fault {
  Change change;
  std::vector<std::string> said;
};

std::vector<Fault> parameter_faults() {
  const double k = 1e8;
  return {
      {on_load<Inertia>("J", {.inertia = kNan}), {"drive/J: inertia = NaN kg m^2", "> 0"}},
      {on_load<Inertia>("J", {.inertia = -1.0}), {"drive/J: inertia = -1 kg m^2", "> 0"}},
      {on_load<Inertia>("J", {.inertia = kInfinity}), {"inertia = infinity kg m^2", "finite"}},
      {on_load<Inertia>("J", {}), {"drive/J: inertia"}},
      {between<ShaftSpring>("s", {.stiffness = 0.0}), {"drive/s: stiffness = 0 N m/rad", "> 0"}},
      {between<ShaftSpring>("s", {}), {"drive/s: stiffness"}},
      {between<ShaftSpring>("s", {.stiffness = 1.0, .damping = -2.0}),
       {"drive/s: damping = -2 N m s/rad", ">= 0"}},
      {between<Dashpot>("d", {.damping = -1.0}), {"drive/d: damping = -1 N m s/rad", ">= 0"}},
      {on_load<GroundSpring>("g", {.stiffness = -1.0}), {"drive/g: stiffness = -1 N m/rad"}},
      {between<DistributedShaft>("d", {.shear_modulus = 8e10,
                                       .density = 7850.0,
                                       .outer_diameter = 0.1,
                                       .inner_diameter = 0.2,
                                       .length = 1.0}),
       {"drive/d: inner_diameter = 0.2 m", "0.1"}},
      {between<DistributedShaft>(
           "d",
           {.shear_modulus = 8e10, .density = 7850.0, .outer_diameter = 0.1, .length = 1.0, .segments = 0}),
       {"drive/d: segments = 0", "1"}},
      {between<IdealGear>("i", {.ratio = 0.0}), {"drive/i: ratio = 0", "must not be 0"}},
      {[](Model& m) { m.add<RayleighDamping>("r", {}, {.alpha_mass = -1.0}); },
       {"drive/r: alpha_mass = -1 1/s", ">= 0"}},
      {meshed([](auto& p) { p.normal_backlash = -1e-4; }),
       {"drive/mesh: normal_backlash = -0.0001 m", ">= 0"}},
      {meshed([](auto& p) { p.base_radius_1 = 0.0; }), {"drive/mesh: base_radius_1 = 0 m"}},
      {meshed([](auto& p) { p.base_radius_2 = kNan; }), {"drive/mesh", "base_radius"}},
      {meshed([](auto& p) { p.internal = true, p.base_radius_2 = 0.05; }),
       {"drive/mesh: base_radius_2 = 0.05 m", "0.1"}},
      {meshed([](auto& p) { p.stiffness = -1.0; }), {"drive/mesh: stiffness = -1 N/m"}},
      {meshed([=](auto& p) { p.stiffness = MeshStiffness::step(k, k, 2.5), p.teeth_1 = 20; }),
       {"drive/mesh", "contact_ratio = 2.5", "less than 2"}},
      {meshed([=](auto& p) { p.stiffness = MeshStiffness::step(k, k, 1.5); }), {"drive/mesh", "teeth_1"}},
      {meshed([](auto& p) { p.teeth_1 = -20; }), {"drive/mesh", "teeth_1 = -20"}},
      {meshed([](auto& p) {
         p.base_radius_1 = p.base_radius_2 = kNan;
         p.module = 0.008, p.teeth_1 = 20, p.teeth_2 = 40, p.pressure_angle = 2.0;
       }),
       {"drive/mesh: pressure_angle = 2 rad", "pi/2"}},
      {meshed([](auto& p) { p.damping = -5.0; }), {"drive/mesh: damping = -5 N s/m", ">= 0"}},
      {on_load<CamTorque>("cam", {}), {"drive/cam: angle_table", "point"}},
      {on_load<CamTorque>("cam", {.angle_table = PeriodicTable({0.0, 2.0, 1.0}, {0.0, 1.0, 2.0})}),
       {"drive/cam: angle_table", "= 1 rad", "greater than the value before it, 2"}},
      {on_load<CamTorque>("cam", {.angle_table = PeriodicTable({0.0, 1.0, 7.0}, {0.0, 1.0, 2.0})}),
       {"drive/cam: angle_table", "7", "period"}},
      {on_load<CamTorque>("cam", {.angle_table = PeriodicTable({0.0, 1.0}, {0.0, kNan})}),
       {"drive/cam: angle_table", "NaN N m", "finite"}},
      {on_load<CamTorque>("cam", {.angle_table = PeriodicTable({0.0, 1.0}, {0.0})}),
       {"drive/cam: angle_table", "2", "1"}},
      {on_load<AppliedTorque>("t", {}), {"drive/t: torque", "exactly one of torque, table and harmonics"}},
      {on_load<AppliedTorque>("t", {.table = TimeTable({0.0, 2.0, 1.0}, {0.0, 1.0, 2.0})}),
       {"drive/t: table", "= 1 s", "2"}},
      {on_load<AppliedTorque>("t", {.table = TimeTable({0.0, 1.0, 1.0, 1.0}, {0., 1., 2., 3.})}),
       {"drive/t: table", "1 s", "three times"}},
      {on_load<EngineOrderTorque>("e", {.harmonics = {{0.0, 1.0, 0.0}}}),
       {"drive/e: harmonics[0].order = 0", "> 0"}},
      {between<PolylineSpring>("p", {.x = {0.0}, .y = {0.0}}), {"drive/p: x = 1 points", "2"}},
      {between<PolylineSpring>("p", {.x = {-1., 0., 1.}, .y = {-1.0, 0.0, -1.0}}),
       {"drive/p: y[2] = -1 N m", "not be less", "0"}},
      {between<PolylineSpring>("p", PolylineSpring::dead_band(1e3, -0.1)), {"drive/p"}},
  };
}

std::vector<Fault> structure_faults() {
  return {
      {[](Model& m) { m = Model("nothing"); }, {"nothing: nodes = 0", "add nodes"}},
      {[](Model& m) { m.add<Inertia>("J", {"laod"}, {.inertia = 1.0}); },
       {"drive/J", "laod", "did you mean 'load'?"}},
      {[](Model& m) { m.add_node("load"); }, {"drive: node name = load", "used twice"}},
      {[](Model& m) { m.add_node("a,b"); }, {"drive: node name = a,b", "','"}},
      {[](Model& m) { m.add_node(""); }, {"drive: node name", "empty"}},
      {between<ShaftSpring>("shaft", {.stiffness = 1.0}), {"drive: element name = shaft", "twice"}},
      {[](Model& m) { m.add<ShaftSpring>("s", {"load"}, {.stiffness = 1.0}); }, {"drive/s: nodes = 1", "2"}},
      {[](Model& m) {
         m.add<ShaftSpring>("s", {"load", "load"}, {.stiffness = 1.0});
       },
       {"drive/s", "load", "twice"}},
      {[](Model& m) { m.hold("lod"); }, {"drive", "lod", "did you mean 'load'?"}},
      {[](Model& m) {
         m.hold("load");
         m.constant_speed("load", 1.0);
       },
       {"drive/load: prescribed motion", "twice"}},
      {[](Model& m) { m.constant_speed("load", kNan); }, {"drive/load: omega = NaN rad/s"}},
      {[](Model& m) {
         m.constant_speed("load", 10.0);
         m.constant_speed("motor", 12.0);
       },
       {"drive/motor: omega = 12 rad/s", "10 rad/s"}},
      {[](Model& m) {
         m.constant_speed("motor", 10.0);
         m.add<GroundSpring>("mount", {"load"}, {.stiffness = 1.0});
       },
       {"drive/mount: node = load", "cannot be tied to ground"}},
      {[](Model& m) {
         m.add_node("coupling");
         m.add<ShaftSpring>("s", {"load", "coupling"}, {.stiffness = 1.0});
       },
       {"drive/coupling: inertia = 0 kg m^2", "needs an inertia > 0"}},
      {[](Model& m) {
         m.add<IdealGear>("up", {"motor", "load"}, {.ratio = 2.0});
       },
       {"drive/up: nominal ratio of", "this loop cannot turn", "shaft", "up"}},
      {[](Model& m) {
         m.add_node("third");
         m.add<Inertia>("J", {"third"}, {.inertia = 1.0});
         m.add<GearMesh>("mesh_1", {"load", "third"}, mesh());
         m.add<GearMesh>("mesh_2", {"motor", "third"},
                         {.base_radius_1 = 0.1, .base_radius_2 = 0.3, .stiffness = 1e8});
       },
       {"nominal ratio of", "cannot turn", "mesh_1", "mesh_2", "shaft"}},
      {[](Model& m) {
         m.hold("load");
         m.hold("motor");
       },
       {"drive: unknowns = 0", "every node is prescribed"}},
      {[](Model& m) { m.set_initial("load", kNan, 0.0); },
       {"drive/load: initial deviation = NaN rad", "finite"}},
      {[](Model& m) {
         m.hold("load");
         m.set_initial("load", 0.1, 0.0);
       },
       {"drive/load: initial deviation = 0.1 rad", "prescribed"}},
      {[](Model& m) { m.given_motion("load", {}); }, {"drive", "given motion", "function"}},
  };
}

void check_refused(const std::vector<Fault>& faults) {
  for (std::size_t i = 0; i < faults.size(); ++i) {
    Model m = sound();
    std::string message = "nothing was refused";
    try {
      faults[i].change(m);
      m.build();
    } catch (const ModelError& error) {
      message = error.what();
    }
    for (const std::string& part : faults[i].said) {
      INFO("fault " << i << ": " << message << "\nmust say " << part);
      CHECK(message.find(part) != std::string::npos);
    }
  }
}

/// The message of the ModelError or SolverError that the call throws.
std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const ModelError& error) {
    return error.what();
  } catch (const SolverError& error) {
    return error.what();
  }
  return "nothing was refused";
}

}  // namespace

TEST_CASE("A sound model builds") { CHECK(sound().build().size() == 2); }

TEST_CASE("Faults of parameters are named") { check_refused(parameter_faults()); }

TEST_CASE("Faults of a model's structure are named") { check_refused(structure_faults()); }

TEST_CASE("A model with five faults lists five") {
  Model m = sound();
  m.add<Inertia>("J", {"load"}, {.inertia = kNan});
  m.add<ShaftSpring>("s", {"motor", "laod"}, {.stiffness = -1.0});
  m.add_node("motor");
  m.hold("gear");
  try {
    m.build();
    FAIL("nothing was refused");
  } catch (const ModelError& error) {
    INFO(error.what());
    CHECK(error.findings().size() == 5);
    const std::string text = error.what();
    for (const char* part : {"inertia = NaN", "stiffness = -1", "laod", "used twice", "gear"})
      CHECK(text.find(part) != std::string::npos);
  }
}

TEST_CASE("Faults of solver options are named") {
  const System system = sound().build();
  const auto says = [](const std::string& message, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
      INFO(message << "\nmust say " << part);
      CHECK(message.find(part) != std::string::npos);
    }
  };
  for (const double step : {0.0, -1e-3, kNan, kInfinity})
    says(refusal([&] { simulate(system, {.step = step, .t_end = 1.0}); }),
         {"drive/transient: step = ", " s, must be > 0"});
  says(refusal([&] { simulate(system, {.step = 1e-3, .t_start = 2.0, .t_end = 1.0}); }),
       {"t_end = 1 s", "t_start = 2"});
  says(refusal([&] { simulate(system, {.step = 1e-3, .t_end = kNan}); }), {"t_end = NaN s"});
  says(refusal([&] { Recorder(system, {"load.angle_rad"}, 0.0); }), {"interval = 0 s", "> 0"});
  says(refusal([&] {
         Recorder(system, {"load.angle", "shaft.torque"}, 1.0);
       }),
       {"load.angle,", "'load.angle_rad'", "shaft.torque,", "'shaft.torque_Nm'"});
  says(refusal([&] { solve_modes(system, {.count = 0}); }), {"drive/modes: count = 0", ">= 1"});
  says(refusal([&] { solve_modes(system, {.count = 5}); }), {"count = 5", "which is 1"});
  says(refusal([&] { newmark(-0.1, 0.5); }), {"newmark: beta = -0.1", "0"});
  says(refusal([&] { hht(0.4); }), {"hht: alpha = 0.4", "0.333"});
  says(refusal([&] { generalized_alpha(kNan); }), {"rho_inf = NaN", "between 0 and 1"});
  says(refusal([&] { solve_static(system); }), {"drive"});  // free to turn
  says(refusal([&] { system.node("laod"); }), {"laod", "'load'"});
}
