// Faults of a model file: each is refused with file, line, column and a sentence that says what would be
// right.
#include <drev/app/model_file/model_file.hpp>

#include <fstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;
using drev::test::contains;

namespace {

/// A sound file with a bit of everything.
const std::string& sound() {
  static const std::string text = test::read_file(DREV_SOURCE_DIR "/tests/unit/app/model_file/drive.toml");
  return text;
}

/// Puts `change` in the place of `text`, once. '@' in it marks where the fault is to be found.
struct Fault {
  const char *text, *change, *said;
};

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all{
      // the language
      {"name = \"drive\"", "name = \"drive@\n", "is no TOML"},
      {"gear = {}", "gear = {@\n", "is no TOML"},
      {"gear = {}", "gear = { hold = true, @/ }", "expected key or closing '}'"},
      {"gear = {}", "gear = {}\ngear = @{}", "is no TOML"},
      {"duration_s = 0.1", "duration_s = 0.1.2", "is no TOML"},
      {"gear = {}", "a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r.s.t.u.v.w.x.y.z.a.b.c.d.e.f.g@.h = {}",
       "nested 32 deep"},
      // the head
      {"format = 1\n", "@", "format, is missing; write format = 1"},
      {"format = 1", "format = @2", "is the number 2; this drev reads format 1"},
      {"format = 1", "format = @1.0", "must be a whole number, written without a point: format = 1"},
      {"format = 1", "format = @\"1\"", "is the text \"1\"; this drev reads format 1"},
      {"[lists]", "[@list]", "did you mean 'lists'?"},
      {"name = \"drive\"", "name = @7", "must be a text in quotes, not the number 7"},
      {"name = \"drive\"", "name = @\"a\\u001b[31m\"",
       "name, has a control character, which is not allowed: a\\x1b[31m"},
      {"name = \"drive\"", "name = @\"a\\u0000b\"", "a\\x00b"},
      {"name = \"drive\"", "name = @\"a\\u009bb\"", "a\\xc2\\x9bb"},
      {"gear = {}", "gear = {}\n@\"a\\tb\" = {}",
       "nodes, has a control character, which is not allowed: a\\x09b"},
      {"name = \"drive\"", "name = \"drive\"\ninclude = @\"nowhere.toml\"", "there is no such file"},
      {"name = \"drive\"", "name = \"drive\"\ninclude = [@3]", "must be the name of a file"},
      {"name = \"drive\"", "name = \"drive\"\ninclude = @\"drive.toml\"", "includes itself"},
      // parameters, lists, tables
      {"backlash_mm = 0.15", "backlash_mm = @nan", "must be a finite number"},
      {"backlash_mm = 0.15", "backlash_mm = @\"0.15\"", "must be a finite number, not the text \"0.15\""},
      {"backlash_mm = 0.15", "@\"backlash mm\" = 0.15", "letters, digits and _ only"},
      {"backlash_mm = 0.15", "@pi = 3", "is not pi"},
      {"default = 3, min", "default = @13, min", "13 is not between min and max: it must be 1 to 9"},
      {"default = 3, min", "default = @2.5, min", "2.5 is no whole number"},
      {"cylinders = { default = 3,", "cylinders = @{", "lacks default"},
      {"min = 1, max", "@mim = 1, max", "did you mean 'min'?"},
      {"min = 1, max = 9", "min = 9, max = 1", "has a min above its max, 9 above 1"},
      {"cylinders = { default = 3,", "x = { default = \"a\", choices = @[] }\ncylinders = { default = 3,",
       "must hold one text at least"},
      {"order = [1, 3, 2]", "order = [1, @\"3\", 2]", "must hold finite numbers"},
      {"order = [1, 3, 2]", "order = @4", "must be an array of numbers"},
      {"lift = { angle_deg", "lift = { @angle", "needs a unit: angle_rad, angle_deg or angle_mrad"},
      {"angle_deg = [0, 90, 180, 270]", "angle_deg = [0, 90, @\"180 deg\", 270]", "has 'd' in column 5"},
      {"lift = { angle_deg = [0, 90, 180, 270]", "lift = @{ angle_deg = [0, 90, 180]",
       "torque has 4 numbers, angle has 3"},
      {", torque_Nm = [0, 50, 0, -50] }", " }", "lacks torque_Nm, torque_kNm or torque_MNm"},
      {"lift = { angle_deg = [0, 90, 180, 270], torque_Nm = [0, 50, 0, -50] }",
       "lift = { csv = @\"no.csv\" }", "there is no such file"},
      // nodes
      {"gear = {}", "gear = @1", "must be a table, {} for a plain node"},
      {"{ kind = \"translational\" }", "{ kind = @\"translatoric\" }", "did you mean 'translational'?"},
      {"constant_speed_rpm", "@constant_sped_rpm", "did you mean 'constant_speed_rpm'?"},
      {"constant_speed_rpm", "@constant_speed", "needs a unit: constant_speed_rad_per_s, constant_speed_rpm"},
      {"constant_speed_rpm = 750", "@constant_speed_Hz = 12.5", "has no unit that fits"},
      {"initial_angle_deg = 0.1", "@initial_position_mm = 0.1",
       "belongs to translational nodes; on a rotational one"},
      {"gear = {}", "gear = { hold = @1 }", "must be true or false, not the number 1"},
      {"gear = {}", "gear = { nominal_speed_rpm = @inf }", "must be finite, not infinity"},
      {"gear = {}", "gear = { run_up = { speed_0_rpm = 0, speed_1_rpm = 100, time_0_s = 2, @time_1_s = 1 } }",
       "time_1 = 1 s, must be greater than time_0"},
      {"\"unit_{i}\" = {}", "\"unit_{i}\" = {}\n@unit_2 = {}", "the name unit_2 is used twice; first in"},
      {"count = \"cylinders\"", "count = \"cylinders\"\ncounter = @\"pi\"",
       "no parameter and not pi, not the text \"pi\""},
      {"backlash_mm = 0.15\n", "backlash_mm = 0.15\ni = 5\n",
       "repeat.counter, must be given: without it i counts"},
      // elements
      {"J_gear = { type = \"inertia\"", "J_gear = { type = @\"inertai\"", "did you mean 'inertia'?"},
      {"J_gear = { type = \"inertia\", ", "J_gear = @{ ", "lacks type: inertia, shaft_spring"},
      {"node = \"gear\", inertia_kg_m2 = 6.5", "node = @\"gaer\", inertia_kg_m2 = 6.5",
       "did you mean 'gear'?"},
      {"node = \"gear\", inertia_kg_m2 = 6.5", "node = @7, inertia_kg_m2 = 6.5", "must be a text in quotes"},
      {"inertia_kg_m2 = 6.5", "@inertia = 6.5", "needs a unit: inertia_kg_m2"},
      {"inertia_kg_m2 = 6.5", "@inertia_kg = 6.5",
       "it must be inertia_kg_m2, inertia_kgm2 or inertia_kg_mm2"},
      {"inertia_kg_m2 = 6.5", "@mass_kg = 6.5",
       "belongs to translational nodes; on a rotational one it is inertia"},
      {"J_gear = { type = \"inertia\", node = \"gear\", inertia_kg_m2 = 6.5 }",
       "J_gear = @{ type = \"inertia\", node = \"gear\" }", "lacks inertia_kg_m2"},
      {"inertia_kg_m2 = 6.5", "@inertia_kg_m2 = -6.5", "inertia = -6.5 kg m^2, must be > 0"},
      {"inertia_kg_m2 = 6.5", "inertia_kg_m2 = @true",
       "must be a number, or an expression in quotes, not true"},
      {"inertia_kg_m2 = 6.5", "inertia_kg_m2 = 6.5, @inertia_kg_mm2 = 1",
       "is there already, as inertia_kg_m2"},
      {"inertia_kg_m2 = 6.5 }", "inertia_kg_m2 = 6.5, @colour = \"red\" }", "is unknown here; there are"},
      {"J_gear = {", "J_gear = @5 #", "must be a table, { type = ... }"},
      {"nodes = [\"gear\", \"end\"]", "nodes = @[\"gear\"]", "nodes = 1"},
      {"nodes = [\"gear\", \"end\"]", "node = \"gear\", @nodes = [\"gear\", \"end\"]",
       "is given together with node"},
      {"stiffness_MNm_per_rad = 87.5", "@stiffness_N_per_m = 87.5", "belongs to translational nodes"},
      {"stiffness_N_per_mm = 30", "@stiffness_Nm_per_rad = 30",
       "belongs to rotational nodes; on a translational one"},
      {"half_gap_mm = 5", "half_gap_mm = @\"backlash_mm/0\"", "gives no finite number"},
      {"dead_band = { stiffness_N_per_m = 1e6, half_gap_mm = 5 }",
       "@dead_band = { stiffness_N_per_m = 1e6, half_gap_mm = -5 }",
       "must be greater than the value before it"},
      {"dead_band = { stiffness_N_per_m = 1e6, half_gap_mm = 5 }", "dead_band = @3",
       "must be a table, { ... }"},
      {"stop = { type = \"polyline_spring\", node = \"car\", dead_band = { stiffness_N_per_m = 1e6, "
       "half_gap_mm = 5 } }",
       "stop = @{ type = \"polyline_spring\", node = \"car\" }",
       "exactly one of points, dead_band and with_stops"},
      {"time_s = [0, 1]", "time_s = [1, 0]", "must not be less than the time before it"},
      {"time_s = [0, 1]", "time_s = @0", "must be an array of numbers"},
      {"table = \"lift\"", "table = @\"lfit\"", "none of [tables]; did you mean 'lift'?"},
      {"table = \"lift\", phase", "phase", "lacks table"},
      {"\"-2*pi/cylinders\"", "@\"-2*pi/cylindres\"", "did you mean 'cylinders'?"},
      {"order = [0.5, 1]", "order = [0.5, -1]", "harmonics[1].order = -1, must be > 0"},
      {"segments = 2", "segments = @2.5", "must be a whole number"},
      {"segments = 2", "@segments = 0", "segments = 0, must be between 1 and 10000"},
      {"frequency_2_Hz = 250", "frequency_2_Hz = 80", "omega_2"},
      {"contact_ratio = 1.5", "contact_ratio = 2.5", "stiffness.contact_ratio = 2.5, must be greater than 1"},
      {"stiffness_step", "@stiffnes_step", "did you mean 'stiffness_step'?"},
      {"normal_backlash_mm = \"backlash_mm\"", "normal_backlash_m = @\"backlash_mm\"",
       "is in mm, the key in m"},
      {"normal_backlash_mm = \"backlash_mm\"", "normal_backlash_mm = @\"-\"",
       "ends where a number or a name"},
      {"damping_law = \"limited\"", "damping_law = @\"limted\"", "did you mean 'limited'?"},
      {"teeth_1 = 59", "teeth_1 = @\"cylinders + 0.5\"", "must be a whole number"},
      // repeats
      {"count = \"cylinders\"", "count = @\"cylinders/2\"",
       "must be a whole number from 0 to 10000, not 1.5"},
      {"count = \"cylinders\"", "count = @1000000", "from 0 to 10000"},
      {"count = \"cylinders\"\n", "cuont = 3\n", "did you mean 'count'?"},
      {"count = \"cylinders\"", "count = \"cylinders\"\ncounter = @\"cylinders\"",
       "must be a name that is no parameter"},
      {"\"unit_{i}\" = {}", "@\"unit_{j}\" = {}", "names j, which is no parameter"},
      {"\"unit_{i}\" = {}", "@\"unit_{i/2}\" = {}", "needs a whole number in {}, not 0.5"},
      {"\"0.1*order[i]\"", "@\"0.1*order[i+1]\"", "takes number 4 of order, which has 3"},
      {"\"unit_{i+1}\"]", "@\"unit_{i+2}\"]", "is none of the nodes"},
      // the model as a whole
      {"J_gear = { type = \"inertia\", node = \"gear\", inertia_kg_m2 = 6.5 }\n", "",
       "drive/gear: inertia = 0 kg m^2"},
      {"m_car = { type = \"inertia\", node = \"car\", mass_kg = 100 }\n", "", "mass = 0 kg"},
      {"end = { initial_angle_deg = 0.1 }", "end = { @initial_angle_deg = 0.1, hold = true }",
       "the node is prescribed"},
      {"gear = {}", "gear = { @constant_speed_rpm = 100 }", "drive/gear: omega"},
      // runs
      {"duration_s = 0.1", "duration_s = @0", "must be > 0"},
      {"duration_s = 0.1", "@duration = 0.1", "needs a unit: duration_s, duration_ms or duration_us"},
      {"\"end.angle_rad\"", "@\"end.angle\"", "did you mean 'end.angle_rad'?"},
      {"\"shaft*.torque_Nm\"", "@\"shafts*.torque_Nm\"", "fits no channel"},
      {"record = [", "deflection = @\"*.twist_rad\"\nrecord = [", "must be one channel, without '*'"},
      {"method = \"exact\"", "@metod = \"exact\"", "did you mean 'method'?"}};
  return all;
}

struct Place {
  std::size_t line = 1, column = 1;
  bool given = false;
};

/// The file with its fault, and where that is; the '@' is taken out.
std::string spoilt(const Fault& fault, Place& place) {
  std::string text = sound();
  const std::size_t at = text.find(fault.text);
  REQUIRE(at != std::string::npos);
  text.replace(at, std::string(fault.text).size(), fault.change);
  const std::size_t mark = text.find('@');
  if (mark == std::string::npos) return text;
  place.given = true;
  for (std::size_t i = 0; i < mark; ++i) {
    ++place.column;
    if (text[i] == '\n') ++place.line, place.column = 1;
  }
  return text.erase(mark, 1);
}

std::string refusal(const std::string& text) {
  try {
    const app::ModelFile file(text, "drive.toml", "");
    file.entry().build(Parameters(file.entry().name, file.entry().parameters));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

/// Every line of a refusal begins with file:line:column.
bool placed(const std::string& line) {
  std::size_t i = std::string("drive.toml:").size();
  if (!line.starts_with("drive.toml:")) return false;
  for (int part = 0; part < 2; ++part) {
    if (i >= line.size() || !std::isdigit(static_cast<unsigned char>(line[i]))) return false;
    while (i < line.size() && std::isdigit(static_cast<unsigned char>(line[i]))) ++i;
    if (i >= line.size() || line[i] != ':') return false;
    ++i;
  }
  return true;
}

}  // namespace

TEST_CASE("The file without a fault is sound") { CHECK(refusal(sound()).empty()); }

TEST_CASE("Faults of a model file are named by line and column") {
  CHECK(faults().size() >= 60);
  for (const Fault& fault : faults()) {
    Place place;
    const std::string text = spoilt(fault, place), said = refusal(text);
    INFO("instead of " << fault.text << ": " << fault.change << "\nsaid: " << said);
    CHECK(contains(said, fault.said));
    std::istringstream lines(said);
    bool here = !place.given;
    for (std::string line; std::getline(lines, line);) {
      CHECK(placed(line));
      here |= contains(line, fault.said) && line.starts_with("drive.toml:" + std::to_string(place.line) +
                                                             ":" + std::to_string(place.column) + ":");
    }
    CHECK(here);
  }
}

TEST_CASE("All faults of a file are listed at once, each once") {
  std::string text = sound();
  const auto spoil = [&](const std::string& old, const std::string& fresh) {
    text.replace(text.find(old), old.size(), fresh);
  };
  spoil("backlash_mm = 0.15", "backlash_mm = \"x\"");
  spoil("constant_speed_rpm", "speed_rpm");
  spoil("mass_kg = 100", "mass = 100");
  spoil("stiffness_MNm_per_rad = 87.5", "stiffness_MNm_per_rad = -1");
  spoil("\"0.1*order[i]\"", "\"0.1*ordre[i]\"");
  spoil("duration_s = 0.1", "duration_s = -1");
  spoil("density_kg_per_m3 = 7850, ", "");
  const std::string said = refusal(text);
  INFO(said);
  CHECK(std::count(said.begin(), said.end(), '\n') == 6);
  for (const char* part :
       {"parameters.backlash_mm", "nodes.crank.speed_rpm", "elements.m_car.mass, needs a unit",
        "shaft: stiffness = -1000000 N m/rad", "ordre", "must be > 0", "lacks density_kg_per_m3"})
    CHECK(contains(said, part));
}

TEST_CASE("A column with a fault of its own is not said to be of another length, too") {
  for (const char* table : {"time_s = [0, 1, 2], torque_Nm = [1, nan, 3]", "torque_Nm = [1, 2, 3]",
                            "time_s = 3, torque_Nm = [1, 2, 3]"}) {
    const std::string said = refusal(
        "format = 1\n[nodes]\na = {}\n[elements]\nJ = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 "
        "}\n"
        "q = { type = \"applied_torque\", node = \"a\", table = { " +
        std::string(table) + " } }\n");
    INFO(table << "\nsaid: " << said);
    CHECK(contains(said, "elements.q.table"));
    CHECK(std::count(said.begin(), said.end(), '\n') == 0);
  }
}

TEST_CASE("Faults of files that are included or read are named in those") {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  write("gears.toml",
        "format = 1\nnames = \"no\"\n[nodes]\nidler = {}\n[elements]\nJ = { type = \"inertia\", node = "
        "\"idler\" }\n");
  write("lift.csv", "angle_deg,torque_Nm\n0,1\n90,x\n180\n");
  write("broken.toml", "format = \n");
  write("main.toml",
        "format = 1\ninclude = [\"gears.toml\", \"broken.toml\"]\n[elements]\n"
        "cam = { type = \"cam_torque\", node = \"idler\", table = { csv = \"lift.csv\" } }\n");
  const auto run = test::drev_command({"check", (folder / "main.toml").string()});
  INFO(run.err);
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err,
                 "gears.toml:2:1: names, is unknown at the top of a model file; did you mean 'name'?"));
  CHECK(contains(run.err, "gears.toml:6:5: elements.J, lacks inertia_kg_m2"));
  CHECK(contains(run.err, "broken.toml:1:"));
  CHECK(contains(run.err, "lift.csv:3:4: row, the cell of column 2 is no finite number"));
  CHECK(contains(run.err, "lift.csv:4:1: row, has 1 cells, the header 2"));
  CHECK(contains(run.err, "5 faults"));
}

TEST_CASE("A file with nodes or elements that is included twice is one fault") {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  write("units.toml", "format = 1\n[parameters]\np = 2\n");
  write("base.toml",
        "format = 1\ninclude = \"units.toml\"\n[nodes]\na = {}\n[elements]\n"
        "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = \"p\" }\n");
  write("s.toml", "format = 1\ninclude = [\"base.toml\", \"units.toml\"]\n");
  CHECK(test::drev_command({"check", (folder / "s.toml").string()}).exit_code == 0);
  write("m.toml", "format = 1\ninclude = [\"s.toml\", \"base.toml\"]\n");
  const auto run = test::drev_command({"check", (folder / "m.toml").string()});
  INFO(run.err);
  CHECK(contains(run.err, "m.toml:2:22: include, "));
  CHECK(contains(run.err, "base.toml is included twice"));
  CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
}

TEST_CASE("Nothing of a file that is no table is printed") {
  const test::TemporaryFolder folder;
  const auto check_with =
      [&](const std::string& table) {
        std::ofstream(folder / "secret") << table;
        std::ofstream(folder / "m.toml")
            << "format = 1\n[nodes]\na = {}\n[elements]\n"
               "J = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
               "T = { type = \"applied_torque\", node = \"a\", table = { csv = \"secret\" } }\n";
        return test::drev_command({"check", (folder / "m.toml").string()});
      };
  for (const char* table :
       {"root:hidden:19000:0:99999\ndaemon:hidden:19000\n", "hidden", "hidden,hidden\n1,2\n",
        "hidden\nhidden,1\n", "time_s,torque_Nm\n0,hidden\n", "\"hidden\n1\n", "\"hidden\"x\n"}) {
    const auto run = check_with(table);
    CAPTURE(table, run.err);
    CHECK(run.exit_code == 2);
    CHECK_FALSE(contains(run.err, "hidden"));
    CHECK(contains(run.err, "secret:"));
  }
  // A table of numbers under other names is a table: its names help.
  const auto other = check_with("t_s,torque_Nm\n0,1\n1,2\n");
  CHECK(contains(other.err, "secret has no column time_s"));
  CHECK(contains(other.err, "it has t_s, torque_Nm"));
  const auto two = check_with("time_s,torque_Nm,time_ms\n0,1,2\n1,2,3\n");
  CAPTURE(two.err);
  CHECK(two.exit_code == 2);
  CHECK(contains(two.err, "secret has several columns that fit, time_s"));
  CHECK(contains(two.err, "say which is meant: time = \"time_s\""));
}

TEST_CASE("Faults of a file's run options are named in the file") {
  const test::TemporaryFolder folder;
  std::string text = sound();
  text.replace(text.find("method = \"exact\""), 16, "method = \"exakt\"\ntolerance = 7");
  std::ofstream(folder / "drive.toml") << text;
  const std::string path = (folder / "drive.toml").string();
  const auto run = test::drev_command({"check", path});
  INFO(run.err);
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, path + ":60:10: run: method name = exakt, is no method; did you mean 'exact'?"));
  CHECK(contains(run.err, path + ":61:13: run: tolerance = 7, must be a number from"));
  CHECK(contains(test::drev_command({"check", path, "--run", "solw"}).err, "did you mean 'slow'?"));
  CHECK(contains(test::drev_command({"run", "two_inertia", "--run", "slow"}).err, "for model files only"));
  CHECK(contains(test::drev_command({"check", "nowhere.toml"}).err, "nowhere.toml: there is no such file"));
}

TEST_CASE("Modal damping of a model file damps the whole train: it takes no node") {
  const auto build = [](const std::string& keys) {
    const app::ModelFile file(
        "format = 1\n[nodes]\na = {}\nb = {}\n[elements]\n"
        "J_a = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
        "J_b = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n"
        "modal = { type = \"modal_damping\", ratio = 0.01" +
            keys +
            " }\n"
            "k = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = 100 }\n",
        "modal.toml", "");
    return file.entry().build(Parameters(file.entry().name, file.entry().parameters));
  };
  CHECK(build("").model.element_instances().back().name == "modal");  // over the train as a whole
  try {
    build(", node = \"a\"");
    FAIL("was taken");
  } catch (const ModelError& error) {
    CHECK(contains(error.what(), "takes no node"));
  }
}
