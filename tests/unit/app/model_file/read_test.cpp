// What a model file means: the same model as the one written in C++.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <fstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;
using drev::test::contains;

namespace {

ModelCase read(const std::string& text, const std::vector<std::pair<std::string, std::string>>& set = {},
               const std::string& run = "") {
  const app::ModelFile file("format = 1\n" + text, "test.toml", run);
  Parameters parameters(file.entry().name, file.entry().parameters);
  for (const auto& [name, value] : set) parameters.set(name, value);
  return file.entry().build(parameters);
}

template <class E>
const typename E::Params& params(const ModelCase& model_case, const std::string& name) {
  for (const ElementInstance& placement : model_case.model.element_instances())
    if (placement.name == name) return dynamic_cast<const E&>(*placement.element).params();
  throw std::runtime_error("no element " + name);
}

const char* const kDisc =
    "[nodes]\na = {}\n[elements]\nJ = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 2 }\n";

}  // namespace

TEST_CASE("Every unit has its factor") {
  const auto stiffness = [](const char* key) {
    return params<GroundSpring>(
               read(std::string(kDisc) + "k = { type = \"ground_spring\", node = \"a\", stiffness_" + key +
                    " = 3 }"),
               "k")
        .stiffness;
  };
  CHECK(stiffness("Nm_per_rad") == 3.0);
  CHECK(stiffness("kNm_per_rad") == 3e3);
  CHECK(stiffness("MNm_per_rad") == 3e6);
  // A torque of 3 N m turns it by one degree.
  CHECK(stiffness("Nm_per_deg") * deg(1) == Approx(3.0).epsilon(1e-15));
  const auto speed = [](const char* key) {
    const ModelCase s =
        read(std::string("[nodes]\nb = { constant_speed_") + key + " = 6 }\na = {}\n" +
             "[elements]\nJ = { type = \"inertia\", node = \"a\", inertia_kg_mm2 = 5e5 }\n" +
             "k = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 1 }");
    CHECK(params<Inertia>(s, "J").inertia == 0.5);
    return s.model.prescriptions().at(0).omega.value();
  };
  CHECK(speed("rad_per_s") == 6.0);
  CHECK(speed("rpm") == rpm(6.0));
  CHECK(speed("deg_per_s") == deg(6.0));
}

TEST_CASE("Parameters are parameters that --set changes, with their range") {
  const std::string text =
      "[parameters]\nJ_kg_m2 = { default = 3, min = 1, max = 5, meaning = \"of the disc\" }\nn = 2\n"
      "[nodes]\na = {}\n[elements]\nJ = { type = \"inertia\", node = \"a\", inertia_kg_m2 = \"n*J_kg_m2\" "
      "}\n";
  CHECK(params<Inertia>(read(text), "J").inertia == 6.0);
  CHECK(params<Inertia>(read(text, {{"J_kg_m2", "4"}, {"n", "1"}}), "J").inertia == 4.0);
  CHECK_THROWS_WITH(read(text, {{"J_kg_m2", "6"}}), Catch::Contains("must be 1 to 5"));
  const app::ModelFile file("format = 1\n" + text, "test.toml", "");
  const Parameter& s = file.entry().parameters.at(0);
  CHECK(s.name == "J_kg_m2");
  CHECK(s.unit == "kg_m2");
  CHECK(s.meaning == "of the disc");
  CHECK(file.entry().parameters.at(1).range() == "any finite number");
}

TEST_CASE("A repeat makes numbered nodes and elements") {
  const ModelCase model_case = read(R"([parameters]
cylinders = { default = 4, min = 1, max = 9, whole = true }
[lists]
order = [1, 3, 4, 2]
[tables]
cam = { angle_deg = [0, 90, 180, 360], torque_Nm = [0, 100, -100, 0] }
[nodes]
gear = {}
[elements]
J_gear = { type = "inertia", node = "gear", inertia_kg_m2 = 6 }
[[repeat]]
count = "cylinders"
[repeat.nodes]
"cam_{i}" = {}
[repeat.elements]
"J_{i}" = { type = "inertia", node = "cam_{i}", inertia_kg_m2 = 1 }
"torque_{i}" = { type = "cam_torque", node = "cam_{i}", table = "cam", phase_rad = "-2*pi*(position(order, i) - 1)/cylinders" }
[[repeat]]
first = 2
count = "cylinders - 1"
counter = "k"
[repeat.elements]
"shaft_{k}" = { type = "shaft_spring", nodes = ["cam_{k-1}", "cam_{k}"], stiffness_Nm_per_rad = 1e6 }
)");
  const Model& m = model_case.model;
  REQUIRE(m.node_names() == std::vector<std::string>{"gear", "cam_1", "cam_2", "cam_3", "cam_4"});
  REQUIRE(m.element_instances().size() == 1 + 2 * 4 + 3);
  CHECK(m.element_instances()[9].name == "shaft_2");
  CHECK(m.element_instances()[11].nodes[0].name == "cam_3");
  const double places[] = {0, 3, 1, 2};
  for (int i = 1; i <= 4; ++i) {
    const auto& cam = params<CamTorque>(model_case, "torque_" + std::to_string(i));
    CHECK(cam.phase == -kTwoPi * places[i - 1] / 4);
    // The closing point is left out.
    CHECK(cam.angle_table.arguments() == std::vector<double>{0.0, deg(90), deg(180)});
  }
}

TEST_CASE("Includes and tables are relative to the file that names them") {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "parts");
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  write("parts/gear.toml",
        "format = 1\n[parameters]\nJ_kg_m2 = 2\nk_Nm_per_rad = 10\n[tables]\nlift = { csv = \"lift.csv\", "
        "angle = \"crank_deg\", torque = \"b_kNm\" }\n"
        "[nodes]\ngear = {}\n[elements]\nJ_gear = { type = \"inertia\", node = \"gear\", inertia_kg_m2 = "
        "\"J_kg_m2\" }\n");
  write("parts/lift.csv", "# lift; of a cam\ncrank_deg; a_Nm; b_kNm\r\n0;1;2\n\n90;3;4.5\n");
  write(
      "main.toml",
      "format = 1\ninclude = \"parts/gear.toml\"\n[parameters]\nJ_kg_m2 = 7\n[nodes]\nend = {}\n[elements]\n"
      "J_end = { type = \"inertia\", node = \"end\", inertia_kg_m2 = 1 }\n"
      "shaft = { type = \"shaft_spring\", nodes = [\"gear\", \"end\"], stiffness_Nm_per_rad = "
      "\"k_Nm_per_rad\" }\n"
      "cam = { type = \"cam_torque\", node = \"end\", table = \"lift\", twist_feedback = false }\n");
  const app::ModelFile file((folder / "main.toml").string(), "");
  CHECK(file.entry().name == "main");
  const ModelCase model_case = file.entry().build(Parameters("main", file.entry().parameters));
  CHECK(model_case.model.node_names() == std::vector<std::string>{"gear", "end"});
  CHECK(params<Inertia>(model_case, "J_gear").inertia == 7.0);  // the file that includes has the last word
  const auto& table = params<CamTorque>(model_case, "cam").angle_table;
  CHECK(table.arguments() == std::vector<double>{0.0, deg(90)});
  CHECK(table.values() == std::vector<double>{2000.0, 4500.0});
}

TEST_CASE("Tables are read as spreadsheets write them") {
  const test::TemporaryFolder folder;
  const std::string path = (folder / "m.toml").string();
  std::ofstream(path) << "format = 1\n[nodes]\na = {}\n[elements]\n"
                         "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
                         "T = { type = \"applied_torque\", node = \"a\", table = { csv = \"t.csv\", torque = "
                         "\"=a,b_kNm\" } }\n";
  // A byte-order mark, cells in quotes with commas, doubled quotes and line ends, the mark before a formula.
  for (const char* text :
       {"\xef\xbb\xbftime_s,\"'=a,b_kNm\",\"x \"\"y\"\"\"\r\n\"0\",1,\"2\"\r\n \"1\" , \"3.5\",4\r\n",
        "# made by hand\n\"time_s\",\"=a,b_kNm\",\"x\ny\"\n0,\"1\",0\n\n1,3.5,0",
        "\xef\xbb\xbf# made by hand\ntime_s,\"=a,b_kNm\"\n0,1\n1,3.5\n"}) {
    std::ofstream(folder / "t.csv") << text;
    CAPTURE(text);
    const app::ModelFile file(path, "");
    const ModelCase model_case = file.entry().build(Parameters("m", file.entry().parameters));
    const auto& table = params<AppliedTorque>(model_case, "T").table;
    REQUIRE(table);
    CHECK(table->at(0.0).value == 1000.0);
    CHECK(table->at(1.0).value == 3500.0);
  }
}

TEST_CASE("Nodes are held, driven, given a motion and a start") {
  const ModelCase model_case = read(R"([nodes]
shaft = { nominal_speed_rpm = 60, nominal_angle_deg = 90 }
disc = { initial_angle_deg = 180, initial_speed_rpm = 30 }
wall = { hold = true }
shaker = { kind = "translational", given_motion = { amplitude_mm = 2, frequency_Hz = 5, phase_deg = -90, offset_mm = 1 } }
mass = { kind = "translational", initial_velocity_mm_per_s = 3 }
[elements]
J_shaft = { type = "inertia", node = "shaft", inertia_kg_m2 = 1 }
J_disc = { type = "inertia", node = "disc", inertia_kg_m2 = 1 }
k = { type = "shaft_spring", nodes = ["disc", "wall"], stiffness_Nm_per_rad = 5, damping_Nms_per_rad = 0.1 }
m = { type = "inertia", node = "mass", mass_kg = 3 }
c = { type = "dashpot", nodes = ["shaker", "mass"], damping_Ns_per_m = 4 }
)");
  const Model& m = model_case.model;
  REQUIRE(m.references().size() == 1);
  CHECK(m.references()[0].second.at(0.0).value == deg(90));
  CHECK(m.references()[0].second.at(0.0).rate == rpm(60));
  REQUIRE(m.prescriptions().size() == 2);
  CHECK(m.prescriptions()[0].node.name == "wall");
  // u = 1 mm + 2 mm sin(2 pi 5 t) and its derivatives at a quarter of the period and at its start.
  const Motion& u = m.prescriptions()[1].deviation.value();
  CHECK(u.at(0.05).value == Approx(3e-3));
  CHECK(u.at(0.0).rate == Approx(2e-3 * kTwoPi * 5));
  CHECK(u.at(0.05).acceleration == Approx(-2e-3 * std::pow(kTwoPi * 5, 2)));
  REQUIRE(m.initials().size() == 2);
  CHECK(m.initials()[0].deviation == deg(180));
  CHECK(m.initials()[0].rate == rpm(30));
  CHECK(m.initials()[1].rate == 3e-3);
}

TEST_CASE("Runs: a named one is laid over [run]") {
  const std::string text =
      std::string("[parameters]\nn = 2\n") + kDisc +
      "t = { type = \"applied_torque\", node = \"a\", torque_Nm = \"n\" }\n"
      "[run]\nduration_ms = 500\nstep_s = 1e-3\nrecord = \"*.angle_rad\"\n"
      "[run.long]\nduration_s = 3\nparameters = { n = 5 }\nmethod = \"sdirk4\"\ntolerance = \"n*1e-6\"\n";
  const ModelCase plain = read(text), long_one = read(text, {}, "long");
  CHECK(plain.duration == 0.5);
  CHECK(plain.default_step == 1e-3);
  CHECK(plain.channels == std::vector<std::string>{"a.angle_rad"});
  CHECK(long_one.duration == 3.0);
  CHECK(long_one.default_step == 1e-3);
  CHECK(params<AppliedTorque>(plain, "t").table->values() == std::vector<double>{2.0});
  CHECK(params<AppliedTorque>(long_one, "t").table->values() == std::vector<double>{5.0});
  const app::ModelFile file("format = 1\n" + text, "test.toml", "long");
  CHECK(file.run_names() == std::vector<std::string>{"long"});
  const auto options = file.run_options(Parameters("test", file.entry().parameters)).values;
  CHECK(options.at("--method") == "sdirk4");
  CHECK(options.at("--tolerance") == to_text(5 * 1e-6));
}

TEST_CASE("Parameters of [run] are laid over their defaults, and those of a named run over them") {
  const std::string text = std::string("[parameters]\nn = 1\nm = 1\n") + kDisc +
                           "t = { type = \"applied_torque\", node = \"a\", torque_Nm = \"10*n+m\" }\n"
                           "[run]\nparameters = { n = 2, m = 3 }\n[run.other]\nparameters = { m = 4 }\n";
  const auto torque = [&](const std::string& run) {
    return params<AppliedTorque>(read(text, {}, run), "t").table->values();
  };
  CHECK(torque("") == std::vector<double>{23.0});
  CHECK(torque("other") == std::vector<double>{24.0});
  CHECK(app::ModelFile("format = 1\n" + text, "test.toml", "").run_names() ==
        std::vector<std::string>{"other"});
}

TEST_CASE("A named run is no key of [run], whatever its name") {
  const ModelCase model_case =
      read(std::string(kDisc) + "[run]\nduration_s = 1\n[run.record_all]\nstep_s = 1e-5\n" +
           "[run.torques_of_shafts]\nstep_s = 1e-5\n[run.step_s_short]\nstep_s = 1e-5\n");
  CHECK(model_case.channels == std::vector<std::string>{"a.angle_rad"});
}

TEST_CASE("Rayleigh damping, stops, stiffness and error by their other names") {
  const ModelCase model_case = read(std::string(kDisc) + R"(
b = { type = "rayleigh_damping", stiffness_proportional = { frequency_Hz = 50, damping_ratio = 0.02 } }
stop = { type = "polyline_spring", node = "a", with_stops = { stiffness_Nm_per_rad = 10, travel_rad = 0.1, stop_stiffness_Nm_per_rad = 1000 } }
[elements.mesh]
type = "gear_mesh"
nodes = ["a", "b"]
base_radius_1_m = 0.1
base_radius_2_m = 0.2
teeth_1 = 20
stiffness_fourier_of_step = { single_N_per_m = 1e8, double_N_per_m = 1.5e8, contact_ratio = 1.4, harmonics = 3 }
transmission_error = { order = [1], amplitude_um = [3], phase_deg = [90] }
[nodes.b]
hold = true
)");
  const auto rayleigh = RayleighDamping::stiffness_proportional(hz(50), 0.02);
  CHECK(params<RayleighDamping>(model_case, "b").beta_stiffness == rayleigh.beta_stiffness);
  const auto stop = PolylineSpring::with_stops(10, 0.1, 1000);
  CHECK(params<PolylineSpring>(model_case, "stop").x == stop.x);
  CHECK(params<PolylineSpring>(model_case, "stop").y == stop.y);
  const auto& mesh = params<GearMesh>(model_case, "mesh");
  const MeshStiffness same = MeshStiffness::fourier_of_step(1e8, 1.5e8, 1.4, 3);
  for (const double phase : {0.0, 0.1, 0.45, 0.9})
    CHECK(mesh.stiffness.at(phase).value == same.at(phase).value);
  CHECK(mesh.transmission_error.at(0.75).value == Approx(3e-6));
}

TEST_CASE("Every command takes a file") {
  const std::string path = DREV_SOURCE_DIR "/tests/unit/app/model_file/drive.toml";
  for (const char* command : {"run", "modes", "list", "check"}) {
    const auto run = test::drev_command({command, path});
    INFO(command << "\n" << run.out << run.err);
    CHECK(run.exit_code == 0);
    CHECK(contains(run.out, "drive"));
  }
  CHECK(contains(test::drev_command({"list", path}).out, "Runs, named by --run: slow."));
  CHECK(contains(test::drev_command({"list", path, "--run", "slow"}).out, "backlash_mm  0.3 mm"));
  CHECK(contains(test::drev_command({"check", path}).out, "sound; 8 nodes, 17 elements; runs: slow"));
  CHECK(test::drev_command({"__complete", "run", path, "--set", "cyl"}).out == "cylinders=\n");
  CHECK(test::drev_command({"__complete", "run", path, "--run", ""}).out == "slow\n");
  const auto set = test::drev_command({"modes", path, "--set", "cylinders=2", "--json"});
  CHECK(contains(set.out, "\"cylinders\": 2"));
}

TEST_CASE("The torques of a run that names none are those of parts that carry them, not the loads") {
  const ModelCase model_case = read(
      "[nodes]\nm = { nominal_speed_rpm = 1000 }\nl = {}\n[elements]\n"
      "Jm = { type = \"inertia\", node = \"m\", inertia_kg_m2 = 0.5 }\n"
      "Jl = { type = \"inertia\", node = \"l\", inertia_kg_m2 = 1.5 }\n"
      "s = { type = \"shaft_spring\", nodes = [\"m\", \"l\"], stiffness_Nm_per_rad = 20000 }\n"
      "mot = { type = \"torque_curve\", node = \"m\", curve = { speed_rpm = [0, 1000], torque_Nm = [120, 0] "
      "} }\n"
      "puls = { type = \"engine_order_torque\", node = \"l\", harmonics = { order = [1], amplitude_Nm = [10] "
      "} }\n"
      "fan = { type = \"torque_function\", node = \"l\", expression = \"-0.002*speed_rad_per_s^2\" }\n"
      "bearing = { type = \"dashpot\", node = \"l\", damping_Nms_per_rad = 100 }\n"
      "oil = { type = \"absolute_damper\", node = \"m\", damping_Nms_per_rad = 100 }\n"
      "seal = { type = \"bearing_friction\", node = \"m\", torque_Nm = 100 }\n"
      "between = { type = \"dashpot\", nodes = [\"m\", \"l\"], damping_Nms_per_rad = 1 }\n");
  CHECK(model_case.torques == std::vector<std::string>{"s.torque_Nm", "between.torque_Nm"});
}
