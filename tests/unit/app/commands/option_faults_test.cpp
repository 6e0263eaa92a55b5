// Faults of the command line: each is refused with exit code 2, nothing on stdout, and a message that
// says what, where, and what would be right.
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;

namespace {

struct OptionFault {
  std::vector<std::string> words;
  std::vector<std::string> said;
};

const std::vector<OptionFault>& faults() {
  static const std::vector<OptionFault> all{
      // commands and models
      {{}, {"no command", "run, modes, sweep, campbell, class"}},
      {{"rnu", "camshaft"}, {"rnu", "did you mean 'run'?"}},
      {{"camshaft"}, {"did you mean 'drev run camshaft'?"}},
      {{"--verison"}, {"--verison", "did you mean '--version'?"}},
      {{"run"}, {"MODEL", "missing", "two_inertia"}},
      {{"run", "camshft"}, {"camshft", "did you mean 'camshaft'?"}},
      {{"run", "x"}, {"x", "the models are", "camshaft"}},
      {{"list", "gear_driv"}, {"did you mean 'gear_drive'?"}},
      {{"modes", "two_mass"}, {"two_mass", "is no model"}},
      {{"modes", "two_inertia", "camshaft"}, {"camshaft", "one too many"}},
      {{"run", "two_inertia", "camshaft"}, {"--out", "needed for several runs"}},
      {{"run", "two_inertia", "duration_s=1"}, {"--set duration_s=1"}},
      {{"run", "gear_drive", "--vary", "backlash_mm=0:0.1:0.2", "engine_rpm=700:10:750"},
       {"must be written --vary engine_rpm=700:10:750"}},
      {{"optimise", "gear_drive", "--vary", "backlash_mm=0:0.1:0.2", "engine_rpm=700:10:750"},
       {"must be written --vary engine_rpm=700:10:750"}},
      {{"run", "gear_drive", "--duration", "0.01", "engine_rpm=700"},
       {"must be written --set engine_rpm=700"}},
      {{"--json", "run", "two_inertia"}, {"--json", "after the command run"}},
      {{"run", "modes"}, {"modes", "give one command"}},
      // options
      {{"run", "camshaft", "--stp", "1e-3"}, {"--stp", "drev run", "did you mean '--step'?"}},
      {{"run", "camshaft", "--count", "3"}, {"--count", "drev modes has it"}},
      {{"run", "camshaft", "--durat", "1"}, {"did you mean '--duration'?"}},
      {{"help", "run"}, {"did you mean 'drev run --help'?"}},
      {{"study", "--json"}, {"--json, is no option of drev study"}},
      {{"run", "gear_drive", "--vary", "backlash_mm=0.1,0.2", "--table", "--energy", "--out", "no_folder"},
       {"--energy, is for single runs"}},
      {{"run", "gear_drive", "--vary", "backlash_mm=0.1,0.10", "--out", "no_folder"},
       {"has 0.10 twice, first as 0.1"}},
      {{"run", "camshaft", "camshaft", "--out", "no_folder"}, {"camshaft, is given twice"}},
      {{"run", "camshaft", "--step"}, {"--step"}},
      {{"run", "camshaft", "--step", "1e-5", "--step", "1e-6"}, {"--step", "1e-6", "already"}},
      {{"run", "camshaft", "--out", "--json"}, {"--out", "needs a value"}},
      {{"run", "camshaft", "--out", ""}, {"--out", "needs a value"}},
      // times
      {{"run", "camshaft", "--step", "0"}, {"--step = 0 s", "5e-10 s", "5 s"}},
      {{"run", "camshaft", "--step", "-1e-5"}, {"--step = -1e-5 s", "between"}},
      {{"run", "camshaft", "--step", "nan"}, {"--step = nan s", "between"}},
      {{"run", "camshaft", "--step", "inf"}, {"--step = inf s", "between"}},
      {{"run", "camshaft", "--step", "1ms"}, {"--step = 1ms", "seconds", "0.001"}},
      {{"run", "camshaft", "--step", "1e-5s"}, {"--step = 1e-5s", "seconds"}},
      {{"run", "camshaft", "--step", "0,001"}, {"--step = 0,001", "seconds"}},
      {{"run", "camshaft", "--step", "6"}, {"--step = 6 s", "5 s (the run's duration)"}},
      {{"run", "camshaft", "--step", "1e-300"}, {"--step = 1e-300 s", "between 5e-10 s"}},
      {{"run", "camshaft", "--every", "0.1"}, {"--every", "needs --out DIR"}},
      {{"run", "camshaft", "--out", "no_folder", "--every", "0"}, {"--every = 0 s", "5e-08 s"}},
      {{"run", "camshaft", "--out", "no_folder", "--every", "9"}, {"--every = 9 s", "5 s"}},
      // methods
      {{"run", "camshaft", "--method", "euler"}, {"euler", "average_acceleration", "hht"}},
      {{"run", "camshaft", "--method", "hhtt:0.1"}, {"hhtt", "did you mean 'hht'?"}},
      {{"run", "camshaft", "--method", "hht:0.5"}, {"alpha = 0.5", "between 0 and 0.333"}},
      {{"run", "two_inertia", "--method", "exact:3"},
       {"--method name = exact:3", "exact takes no number behind it; its tolerance is given by --tolerance"}},
      {{"run", "camshaft", "--method", "hht:"}, {"hht:", "hht[:ALPHA]"}},
      {{"run", "camshaft", "--method", "generalized_alpha:1.1"}, {"rho_inf = 1.1", "0 and 1"}},
      {{"run", "camshaft", "--method", "newmark:0.25"}, {"newmark", "2"}},
      {{"run", "camshaft", "--method", "newmark:0.25,0.4"}, {"gamma = 0.4", "0.5"}},
      // accuracy
      {{"run", "camshaft", "--accuracy", "0"}, {"--accuracy = 0", "from 1e-12 to 0.5"}},
      {{"run", "camshaft", "--accuracy", "1 %"}, {"--accuracy = 1 %", "from 1e-12 to 0.5"}},
      {{"run", "camshaft", "--accuracy", "1e-3", "--step", "1e-5"},
       {"--step = 1e-5 s", "cannot be given with --accuracy"}},
      // charts
      {{"chart", "camshaft", "--step", "1e-5"}, {"--step", "drev run has it"}},
      {{"chart", "camshaft", "--methods", "exact", "hht", "exact"}, {"exact", "twice"}},
      {{"chart", "camshaft", "--methods", "hht:2"}, {"--methods alpha = 2", "0 and 0.333"}},
      {{"advise", "camshaft", "--within", "0"}, {"--within = 0", "0.01%"}},
      {{"advise", "camshaft", "--within", "80%"}, {"--within = 80%", "50%"}},
      {{"advise", "camshaft", "--for", "peak deflexion"}, {"--for = peak deflexion", "peak deflection"}},
      {{"advise", "camshaft", "--for", "mesh_3.force_N"}, {"--for", "mesh_3.force_N", "did you mean"}},
      {{"chart", "camshaft", "--limit", "0"}, {"--limit = 0 s", "0.001 s"}},
      {{"chart", "camshaft", "--limit", "soon"}, {"--limit = soon", "seconds"}},
      // parameters
      {{"run", "camshaft", "--set", "cylindres=6"}, {"cylindres", "did you mean 'cylinders'?"}},
      {{"run", "camshaft", "--set", "cylinders=11"}, {"cylinders = 11", "6 to 10"}},
      {{"run", "camshaft", "--set", "cylinders=6.5"}, {"cylinders = 6.5", "whole number"}},
      {{"run", "camshaft", "--set", "cylinders"}, {"cylinders", "name=value"}},
      {{"run", "camshaft", "--set", "cylinders="}, {"cylinders=", "name=value"}},
      {{"run", "camshaft", "--set", "=6"}, {"=6", "name=value"}},
      {{"run", "camshaft", "--set", "cylinders=6", "cylinders=7"}, {"already, to 6"}},
      {{"run", "camshaft", "--set", "drive=gear"}, {"drive = gear", "did you mean 'gears'?"}},
      {{"run", "camshaft", "--set", "backlash_mm=-0.1"}, {"backlash_mm = -0.1 mm", "0 to 10"}},
      {{"run", "camshaft", "--set", "backlash_mm=+-1"}, {"backlash_mm = +-1", "not a number"}},
      {{"run", "camshaft", "--set", "engine_rpm=nan"}, {"engine_rpm = nan rpm", "1 to 5000"}},
      {{"run", "camshaft", "--set", "engine_rpm=fast"}, {"engine_rpm = fast", "not a number"}},
      {{"run", "camshaft", "--set", "duration_s=0"}, {"duration_s = 0 s", "to 10000"}},
      {{"run", "camshaft", "--set", "firing_order=1-2-3"}, {"1-2-3", "9 cylinders"}},
      {{"run", "camshaft", "--set", "firing_order=1-1-3"}, {"1-1-3", "once"}},
      {{"modes", "two_inertia", "--set", "inertia_1_kg_m2=0"}, {"inertia_1_kg_m2 = 0 kg m^2"}},
      {{"list", "two_inertia", "--set", "stiffnes_Nm_per_rad=1"}, {"'stiffness_Nm_per_rad'"}},
      {{"run", "camshaft", "--reduce", "60%"}, {"--reduce = 60%", "to 50%"}},
      {{"run", "camshaft", "--reduce", "some"}, {"--reduce = some", "must be off"}},
      {{"run", "camshaft", "--reduce", "1%", "--accuracy", "0.01"}, {"--reduce", "--accuracy"}},
      // channels
      {{"run", "camshaft", "--record", "end.angle_rad"}, {"--record", "needs --out DIR"}},
      {{"run", "camshaft", "--out", "no_folder", "--record", "end.angle"},
       {"end.angle", "did you mean 'end.angle_rad'?"}},
      {{"run", "camshaft", "--out", "no_folder", "--record", "gear-ned.twist_rad"},
       {"gear-ned.twist_rad", "is no channel"}},
      {{"run", "camshaft", "--out", "no_folder", "--record", "end.angle_rad,"}, {"CHANNEL"}},
      {{"run", "camshaft", "--out", "no_folder", "--record", "end.angle_rad,end.angle_rad"},
       {"end.angle_rad", "twice"}},
      // modes
      {{"modes", "two_inertia", "--count", "0"}, {"--count = 0", "from 1 to 1"}},
      {{"modes", "two_inertia", "--count", "2"}, {"--count = 2", "from 1 to 1"}},
      {{"modes", "two_inertia", "--count", "2.5"}, {"--count = 2.5", "whole number"}},
      {{"modes", "two_inertia", "--count", "many"}, {"--count = many", "whole number"}},
      {{"modes", "camshaft", "--contact", "close"}, {"did you mean 'closed'?"}},
      {{"sweep", "camshaft", "--speed", "500"}, {"did you mean '--speeds'?", "drev modes has --speed"}},
      {{"chart", "two_inertia", "--methods"}, {"--methods, needs a value"}},
      {{"sweep", "camshaft", "--speeds", "500rpm"},
       {"--speeds = 500rpm, must be", "numbers of rpm without unit"}},
      {{"campbell", DREV_SOURCE_DIR "/models/gear_pair/gear_pair.toml", "--speeds", "500"},
       {"--contact, must be closed", "gear_pair"}},
      {{"run", "two_inertia", "--out", "no_folder.csv"}, {"must be the name of a directory"}},
      {{"run", "camshaft", "--vary", "engine_rpm=triangular(1,2)", "--out", "no_folder"},
       {"uniform(LOW,HIGH)"}},
      {{"run", "camshaft", "--vary", "engine_rpm=750,nan", "--out", "no_folder"},
       {"--vary engine_rpm = nan rpm", "must be 1 to 5000"}},
      // 155.2 Hz, 975 rad/s, in steps of 3/omega
      {{"run", "two_inertia", "--duration", "1e12"},
       {"--duration = 1000000000000 s", "at least 3.3e+14 steps, more than 1e+12", "take at most 3e+09 s"}},
      {{"run", "two_inertia", "--duration", "1e12", "--method", "hht"},
       {"--duration = 1000000000000 s", "steps, more than 1e+12"}},
      {{"run", "camshaft", "--record", "mesh_*.torque_Nm", "--rainflow", "shft_*.torque_Nm", "--out",
        "no_folder"},
       {"channel = mesh_*.torque_Nm, fits no channel of this model", "channel = shft_*.torque_Nm",
        "there are ", " more"}},
      {{"class", "camshaft", "--speeds", "500"}, {"[class], is missing"}},
  };
  return all;
}

}  // namespace

TEST_CASE("Faults of the command line are named", "[once]") {
  for (const OptionFault& fault : faults()) {
    std::string line = "drev";
    for (const std::string& word : fault.words) line += " " + word;
    const auto run = drev_command(fault.words);
    INFO(line << "\n" << run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    for (const std::string& part : fault.said) CHECK(contains(run.err, part));
  }
  CHECK_FALSE(std::filesystem::exists("no_folder"));
}

TEST_CASE("All faults of one command line are listed at once") {
  const auto run = drev_command({"run", "camshaft", "--stp", "--step", "1ms", "--every", "-1", "--method",
                                 "hht:2", "--set", "cylinders=5", "drve=held", "backlash_mm=x", "--record",
                                 "end.angle,mesh_9.force_N"});
  INFO(run.err);
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "11 faults"));
  for (const char* part :
       {"--stp", "--step = 1ms", "--every = -1 s", "alpha = 2", "cylinders = 5", "drve", "backlash_mm = x",
        "end.angle", "mesh_9.force_N", "--every, needs", "--record, needs"})
    CHECK(contains(run.err, part));
}

TEST_CASE("An option that is near to none is compared with none") {
  CHECK_FALSE(contains(drev_command({"modes", "camshaft", "--number", "3"}).err, "did you mean"));
  CHECK_FALSE(contains(drev_command({"run", "camshaft", "--version"}).err, "did you mean"));
  CHECK_FALSE(contains(drev_command({"study", "--help"}).out, "--json"));
}

TEST_CASE("Only the option that is wrong is blamed") {
  const auto within = drev_command({"advise", "two_inertia", "--within", "0"});
  INFO(within.err);
  CHECK(within.exit_code == 2);
  CHECK_FALSE(contains(within.err, "--for"));
  CHECK_FALSE(contains(within.err, "2 faults"));
}

TEST_CASE("The value of an option that does not exist is no model") {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "camshaft", "--stp", "3"}, {"run", "--stp", "3", "camshaft"}}) {
    const auto run = drev_command(words);
    INFO(run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.err ==
          "drev: command line: option = --stp, is no option of drev run; did you mean '--step'?\n");
  }
}

TEST_CASE("What is wrong with an option is said once, and beside all other faults") {
  const auto said = [](const std::vector<std::string>& words) {
    const auto run = drev_command(words);
    CHECK(run.exit_code == 2);
    return run.err;
  };
  CHECK_FALSE(contains(said({"run", "camshaft", "--start", "periodc"}), "faults"));
  CHECK_FALSE(contains(said({"sweep", "camshaft", "--speeds", ""}), "faults"));
  const std::string gear_pair = DREV_SOURCE_DIR "/models/gear_pair/gear_pair.toml";
  const std::string open = said({"sweep", gear_pair, "--speeds", "500", "--tolerance", "nan", "--cycle",
                                 "abc", "--jobs", "-3", "--balance", "hub,gen", "--absolute-sum"});
  for (const char* part : {"--tolerance = nan", "--cycle = abc", "--jobs = -3", "hub,gen", "--absolute-sum"})
    CHECK(contains(open, part));
  const std::string closed = said({"sweep", gear_pair, "--speeds", "500", "--contact", "closed",
                                   "--tolerance", "nan", "--cycle", "abc", "--balance", "hub,gen"});
  for (const char* part : {"--tolerance = nan, is for models that are not linear, which --contact closed",
                           "--cycle = abc", "hub,gen"})
    CHECK(contains(closed, part));
}

TEST_CASE("Faults of --vary, of the figure and of the folder come together, each with the admissible range") {
  for (const char* value : {"inf", "nan", "1,-inf"}) {
    const std::string varied = std::string("stiffness_Nm_per_rad=") + value;
    const auto several =
        drev_command({"run", "two_inertia", "--vary", varied, "--record", "nix", "--jobs", "0"});
    INFO(several.err);
    CHECK(several.exit_code == 2);
    CHECK(contains(several.err, "4 faults"));
    for (const char* part :
         {"--vary stiffness_Nm_per_rad = ", "inf N m/rad", "must be 1e-06 to 1000000000000000",
          "--out, is needed", "channel = nix", "--jobs = 0"})
      CHECK((contains(several.err, part) || (part[0] == 'i' && contains(several.err, "nan N m/rad"))));
    const auto best = drev_command({"optimise", "two_inertia", "--vary", varied, "--minimise", "foo"});
    INFO(best.err);
    CHECK(best.exit_code == 2);
    CHECK(contains(best.err, "2 faults"));
    for (const char* part :
         {"--vary stiffness_Nm_per_rad = ", "must be 1e-06 to 1000000000000000", "--minimise = foo"})
      CHECK(contains(best.err, part));
  }
  const std::string drive = DREV_SOURCE_DIR "/models/drive/drive.toml";
  const auto table = drev_command({"run", drive, "--table", "--vary", "torque_Nm=1,inf"});
  INFO(table.err);
  CHECK(contains(table.err, "2 faults"));
  CHECK(contains(table.err, "--vary torque_Nm = inf"));
  CHECK(contains(table.err, "must be 0 to 100"));
}
