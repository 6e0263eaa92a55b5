// A built-in model, written as a file and read back, is the same model to the last bit.
#include "app/model_file/writing/export.hpp"

#include <drev/app/model_file/model_file.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/strength/section_strength.hpp>

#include <algorithm>
#include <cstring>

#include "tests/catch.hpp"

using namespace drev;

namespace {

ModelCase read_back(const std::string& text) {
  const app::ModelFile file(text, "exported.toml", "");
  return file.entry().build(Parameters(file.entry().name, file.entry().parameters));
}

std::vector<std::string> every_channel(const System& system) {
  std::vector<std::string> names;
  for (const Channel& channel : all_channels(system)) names.push_back(channel.name());
  std::sort(names.begin(), names.end());
  return names;
}

/// Every channel over a while, by the method that the model itself chooses.
std::vector<std::vector<double>> histories(const ModelCase& model_case, double t_end) {
  const System system = model_case.model.build();
  const std::vector<std::string> channels = every_channel(system);
  Recorder recorder(system, channels, t_end / 50);
  const Method method = choose_method(system, model_case.duration, model_case.default_step).method;
  CHECK(run_method(system, method, {.t_end = t_end}, {&recorder}).ok());
  std::vector<std::vector<double>> all;
  for (std::size_t c = 0; c < channels.size(); ++c) all.push_back(recorder.samples(c));
  return all;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

void check_same(const ModelCase& a, const ModelCase& b, double t_end) {
  CHECK(same_bits({a.duration, a.default_step, a.static_turn}, {b.duration, b.default_step, b.static_turn}));
  CHECK(a.note == b.note);
  CHECK(a.deflection == b.deflection);
  CHECK(a.torques == b.torques);
  CHECK(a.channels == b.channels);
  const System sa = a.model.build(), sb = b.model.build();
  REQUIRE(every_channel(sa) == every_channel(sb));
  CHECK(same_bits(solve_modes(sa, {}).frequency_Hz, solve_modes(sb, {}).frequency_Hz));
  const auto ha = histories(a, t_end), hb = histories(b, t_end);
  REQUIRE(ha.size() == hb.size());
  std::size_t different = 0;
  for (std::size_t c = 0; c < ha.size(); ++c) different += same_bits(ha[c], hb[c]) ? 0 : 1;
  CHECK(different == 0);
}

}  // namespace

TEST_CASE("Where runs start and from when on figures are taken: read, exported and read back") {
  const drev::ModelEntry& entry = drev::find_model("two_inertia");
  const Parameters parameters(entry.name, entry.parameters);
  ModelCase model_case = entry.build(parameters);
  CHECK(model_case.start == Start::rest);
  CHECK_FALSE(model_case.settle);
  CHECK_FALSE(read_back(app::export_model(entry, parameters, model_case)).settle);
  model_case.start = Start::periodic;
  model_case.settle = Settle{0.05};
  ModelCase back = read_back(app::export_model(entry, parameters, model_case));
  CHECK(back.start == Start::periodic);
  REQUIRE(back.settle);
  CHECK(back.settle->time == 0.05);
  model_case.start = Start::static_equilibrium;
  model_case.settle = Settle{};
  back = read_back(app::export_model(entry, parameters, model_case));
  CHECK(back.start == Start::static_equilibrium);
  REQUIRE(back.settle);
  CHECK_FALSE(back.settle->time);
}

TEST_CASE("What a file says of its run is in its export, but for the folder of its results") {
  const auto options_of = [](const std::string& text, std::string* written) {
    const app::ModelFile file(text, "own.toml", "");
    const Parameters parameters(file.entry().name, file.entry().parameters);
    const app::RunOptions options = file.run_options(parameters);
    if (written != nullptr)
      *written = app::export_model(file.entry(), parameters, file.entry().build(parameters), options);
    return options.values;
  };
  const std::string model =
      "format = 1\n[parameters]\nn = 3\n[nodes]\na = {}\n[elements]\n"
      "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n[run]\nout = \"results\"\n";
  for (const char* run :
       {"method = \"sdirk4\"\ntolerance = \"n*1e-6\"\nevery_ms = 0.1\n", "accuracy = 1e-3\n"}) {
    std::string written;
    auto given = options_of(model + run, &written);
    given.erase("--out");
    INFO(written);
    CHECK(options_of(written, nullptr) == given);
  }
}

TEST_CASE("Every built-in model, exported and read back, gives the same bits") {
  struct Case {
    const char* model;
    std::vector<std::pair<const char*, const char*>> set;
    double t_end;
  };
  const std::vector<Case> cases{
      {"two_inertia", {}, 0.2},
      {"two_inertia", {{"torque_frequency_Hz", "0"}}, 0.2},
      {"two_inertia", {{"inertia_1_kg_m2", "0.1234567890123456789"}, {"stiffness_Nm_per_rad", "1e5"}}, 0.1},
      {"two_mass_backlash", {}, 5.0},
      {"two_mass_backlash", {{"half_gap_1_m", "0"}, {"half_gap_2_m", "0"}}, 3.0},
      {"gear_drive", {}, 0.1},
      {"gear_drive", {{"mesh_stiffness", "step"}, {"mesh_damping_Ns_per_m", "2e4"}}, 0.02},
      {"gear_drive", {{"mesh_stiffness", "fourier"}, {"backlash_mm", "0.123"}}, 0.02},
      {"camshaft", {}, 0.05},
      {"camshaft", {{"cylinders", "6"}, {"drive", "held"}, {"damping", "case_3_corrected"}}, 0.1},
      {"camshaft",
       {{"cylinders", "10"}, {"drive", "free"}, {"loads", "source"}, {"damping", "undamped"}},
       0.1}};
  for (const Case& c : cases) {
    const ModelEntry& entry = find_model(c.model);
    Parameters parameters(entry.name, entry.parameters);
    for (const auto& [name, value] : c.set) parameters.set(name, value);
    const ModelCase model_case = entry.build(parameters);
    const std::string text = app::export_model(entry, parameters, model_case);
    CHECK(text.find("= []") == std::string::npos);  // columns without rows are not given
    INFO(c.model << (c.set.empty() ? "" : c.set.front().second) << "\n" << text.substr(0, 400));
    check_same(model_case, read_back(text), c.t_end);
  }
  for (const ModelEntry& entry : ready_made_models())
    CHECK(std::any_of(cases.begin(), cases.end(), [&](const Case& c) { return c.model == entry.name; }));
}

TEST_CASE("The camshaft's file is the built-in camshaft to the last bit") {
  const app::ModelFile file(DREV_SOURCE_DIR "/models/camshaft_with_gear_drive/camshaft_with_gear_drive.toml",
                            "");
  for (int cylinders = 6; cylinders <= 10; ++cylinders) {
    Parameters of_file("camshaft", file.entry().parameters),
        built_in("camshaft", find_model("camshaft").parameters);
    of_file.set("cylinders", std::to_string(cylinders));
    built_in.set("cylinders", std::to_string(cylinders));
    ModelCase a = file.entry().build(of_file), b = find_model("camshaft").build(built_in);
    // The sections of the shaft stand in another order.
    std::sort(a.torques.begin(), a.torques.end());
    std::sort(b.torques.begin(), b.torques.end());
    INFO(cylinders << " cylinders");
    check_same(a, b, 0.02);
  }
}

TEST_CASE("Every element, exported and read back, gives the same bits") {
  Model m("all elements");
  m.add_node("table", NodeKind::rotational);
  m.add_node("bit 1");
  m.add_node("wheel");
  m.add_node("pinion");
  m.add_node("rim");
  m.add_node("car", NodeKind::translational);
  m.add_node("wall", NodeKind::translational);
  m.add_node("gear");
  for (const char* node : {"table", "bit 1", "wheel", "pinion", "rim"})
    m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 1.0 / 3.0});
  m.add<Inertia>("m car", {"car"}, {.inertia = 10.0 / 3.0});
  m.add<DistributedShaft>(
      "pipe", {"table", "bit 1"},
      {.shear_modulus = 8e10, .density = 7850, .outer_diameter = 0.05, .length = 1.0 / 7});
  m.add<Dashpot>("drag", {"bit 1"}, {.damping = 0.1});
  m.add<Dashpot>("damper", {"car", "wall"}, {.damping = 0.7});
  m.add<GroundSpring>("support", {"rim"}, {.stiffness = 1e4, .damping = 2.0});
  m.add<RayleighDamping>("rayleigh", {}, RayleighDamping::from_two_modes(100, 0.01, 500, 0.02));
  m.add<PolylineSpring>("spline", {"car", "wall"}, PolylineSpring::with_stops(1e3, 1e-3, 1e5, 0.3));
  m.add<IdealGear>("ideal", {"table", "gear"}, {.ratio = -23.0 / 61.0});
  m.add<GearMesh>("external", {"pinion", "wheel"},
                  {.base_radius_1 = 0.03,
                   .base_radius_2 = 0.07,
                   .teeth_1 = 30,
                   .teeth_2 = 70,
                   .stiffness = MeshStiffness::table({0.0, 0.3, 0.7}, {1e7, 2e7, 1.5e7}),
                   .normal_backlash = 1e-4,
                   .damping = 100.0,
                   .damping_law = MeshDamping::limited,
                   .transmission_error = std::vector<Harmonic>{{1.0, 1e-6, 0.3}, {2.0, -3e-7, 0.0}}});
  m.add<GearMesh>("internal", {"wheel", "rim"},
                  {.base_radius_1 = 0.05,
                   .base_radius_2 = 0.2,
                   .teeth_1 = 25,
                   .internal = true,
                   .stiffness = MeshStiffness::step(1e7, 1.7e7, 1.6),
                   .reference_penetration = 1e-6,
                   .stiffening = {{0.0, 2e-6, 5e-6}, {0.9, 1.0, 1.1}},
                   .transmission_error = TransmissionError::table({0.0, 0.5}, {0.0, 1e-6}),
                   .mesh_phase = 0.1});
  m.add<AppliedTorque>("ramp", {"car"}, {.table = TimeTable({0.0, 0.01, 0.01}, {0.0, 20.0, 3.0})});
  m.add<AppliedTorque>("sines", {"wheel"}, {.harmonics = {{11.0, 3.0, 0.1}, {0.5, 1.0, 0.0}}});
  m.add<AppliedTorque>("constant", {"table"}, {.table = TimeTable({0.0}, {7.0})});
  m.add<EngineOrderTorque>("orders", {"pinion"},
                           {.harmonics = {{0.5, 2.0, 0.4}}, .mean = -1.0, .twist_feedback = false});
  m.add<CamTorque>(
      "cam", {"pinion"},
      {.angle_table = PeriodicTable({0.0, 2.0, 4.0, 9.0}, {0, 3, -1, 2}, 2 * kTwoPi), .phase = -0.4});
  m.hold("wall");
  m.set_initial("car", 1e-4, 0.01);
  ModelCase model_case{
      .model = std::move(m), .duration = 0.05, .default_step = 1e-5, .torques = {"support.torque_Nm"}};
  const ModelEntry entry{"all", "every element", {}, {}};
  const std::string text = app::export_model(entry, Parameters("all", {}), model_case);
  INFO(text);
  // The second export is the fixed point: nothing was lost on the way.
  const ModelCase back = read_back(text);
  CHECK(app::export_model(entry, Parameters("all", {}), back) == text);
  model_case.model.hold("pinion");
  check_same(read_back(app::export_model(entry, Parameters("all", {}), model_case)), model_case, 0.02);
}

TEST_CASE("A given motion of a file is written as it was given") {
  const ModelCase model_case = read_back(
      "format = 1\n[nodes]\nb = {}\n"
      "w = { given_motion = { amplitude_rad = 0.1, frequency_Hz = 1, phase_rad = 0.5, offset_rad = 1 } "
      "}\n[elements]\n"
      "J = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n"
      "s = { type = \"shaft_spring\", nodes = [\"w\", \"b\"], stiffness_Nm_per_rad = 100 }\n");
  const ModelEntry entry{"driven", "", {}, {}};
  const ModelCase back = read_back(app::export_model(entry, Parameters("driven", {}), model_case));
  for (const double t : {0.0, 0.3}) {
    const MotionPoint a = model_case.model.prescriptions()[0].deviation->at(t),
                      b = back.model.prescriptions()[0].deviation->at(t);
    CHECK(same_bits({a.value, a.rate, a.acceleration}, {b.value, b.rate, b.acceleration}));
  }
}

TEST_CASE("The reference shaft's motion is written where it is one of the catalogue's") {
  const auto driven = [](Motion motion) {
    Model m("driven");
    m.add_node("a");
    m.add_node("b");
    for (const char* node : {"a", "b"}) m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 1.0});
    m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 1e3});
    m.set_reference("a", std::move(motion));
    return ModelCase{
        .model = std::move(m), .duration = 0.1, .default_step = 1e-4, .torques = {"shaft.torque_Nm"}};
  };
  const ModelEntry entry{"driven", "", {}, {}};
  const auto write = [&](const ModelCase& model_case) {
    return app::export_model(entry, Parameters("driven", {}), model_case);
  };
  const std::string constant = write(driven(constant_speed(rpm(100), 0.3)));
  CHECK(constant.find("nominal_angle_rad = 0.3") != std::string::npos);
  CHECK(write(read_back(constant)) == constant);
  const std::string rising = write(driven(run_up(0.0, 100.0 / 3, 0.01, 0.05)));
  CHECK(rising.find("run_up = {") != std::string::npos);
  CHECK(write(read_back(rising)) == rising);
  Motion own{[](double t) { return MotionPoint{std::sin(t), std::cos(t), -std::sin(t)}; }};
  CHECK_THROWS_WITH(write(driven(own)), Catch::Contains("driven/a") && Catch::Contains("function of C++"));
  ModelCase function = driven(constant_speed(1.0));
  function.model.add<AppliedTorque>("own", {"a"}, {.torque = [](double) { return 1.0; }});
  CHECK_THROWS_WITH(write(function), Catch::Contains("driven/own") && Catch::Contains("function of C++"));
}

TEST_CASE(
    "Strength data are exported and read back with every key, and a misfire case is named as left out") {
  const std::string file = R"(format = 1
[parameters]
torque = 100
[nodes]
a = { nominal_speed_rpm = 600 }
b = {}
[elements]
J_a = { type = "inertia", node = "a", inertia_kg_m2 = 1 }
J_b = { type = "inertia", node = "b", inertia_kg_m2 = 2 }
shaft = { type = "shaft_spring", nodes = ["a", "b"], stiffness_Nm_per_rad = 1000 }
[class]
rated_speed_rad_per_s = 60
misfire = { torque = 50 }
[class.sections.shaft]
diameter_m = 0.1
bore_m = 0.02
stress_concentration = 1.5
tensile_strength_Pa = 6e8
shape_factor = 0.5
permissible_stress_Pa = 4e7
transient_stress_Pa = 8e7
permissible_torque_Nm = 500
transient_torque_Nm = 900
permissible_heat_W = 70
sn_range_Pa = 1e8
sn_cycles = 1e6
sn_slope = 6
)";
  const app::ModelFile read(file, "train.toml", "");
  const Parameters parameters(read.entry().name, read.entry().parameters);
  const ModelCase model_case = read.entry().build(parameters);
  const std::string text = app::export_model(read.entry(), parameters, model_case);
  const ModelCase read_again = read_back(text);
  const Strength &strength = *model_case.strength, &again = *read_again.strength;
  CHECK(again.rated_speed == strength.rated_speed);
  REQUIRE(again.sections.size() == 1);
  const auto numbers = [](const SectionStrength& s) {
    return std::vector<double>{s.diameter,
                               s.bore,
                               s.stress_concentration,
                               s.tensile_strength,
                               s.shape_factor,
                               s.permissible_stress,
                               s.transient_stress,
                               s.permissible_torque,
                               s.transient_torque,
                               s.permissible_heat,
                               s.sn.reference,
                               s.sn.cycles,
                               s.sn.slope};
  };
  CHECK(numbers(again.sections[0]) == numbers(strength.sections[0]));
  CHECK(numbers(again.sections[0]) ==
        std::vector<double>{0.1, 0.02, 1.5, 6e8, 0.5, 4e7, 8e7, 500.0, 900.0, 70.0, 1e8, 1e6, 6.0});
  CHECK(again.misfire.empty());
  CHECK(app::left_out_of(model_case).starts_with("class.misfire, { torque = 50"));
  CHECK(app::left_out_of(read_again).empty());
}
