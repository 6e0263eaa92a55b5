// What the commands print, as text and as JSON, and how they exit.
#include <drev/core/units.hpp>
#include <drev/models/model_case.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/statics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using Json = nlohmann::json;

TEST_CASE("Help and version") {
  for (const char* command : {"run", "modes", "sweep", "campbell", "list", "chart", "study", "advise",
                              "optimise", "check", "export", "report"}) {
    const auto help = drev_command({command, "--help"});
    CHECK(help.exit_code == 0);
    CHECK(contains(help.out, "Examples:"));
  }
  const auto help = drev_command({"--help"});
  CHECK(help.exit_code == 0);
  for (const char* part : {"Examples:", "Exit codes:", "130", "run", "modes", "list"})
    CHECK(contains(help.out, part));
  const auto version = drev_command({"--version"});
  CHECK(version.exit_code == 0);
  CHECK(version.out.starts_with("drev "));
}

TEST_CASE("The models are listed, each with its parameters") {
  const Json models = Json::parse(drev_command({"list", "--json"}).out).at("models");
  const auto text = drev_command({"list"});
  REQUIRE(models.size() == drev::ready_made_models().size());
  for (const drev::ModelEntry& entry : drev::ready_made_models()) {
    CHECK(contains(text.out, entry.name));
    const auto one = drev_command({"list", entry.name});
    CHECK(one.exit_code == 0);
    const Json json = Json::parse(drev_command({"list", entry.name, "--json"}).out);
    REQUIRE(json.at("parameters").size() == entry.parameters.size());
    for (std::size_t i = 0; i < entry.parameters.size(); ++i) {
      CHECK(contains(one.out, entry.parameters[i].name));
      CHECK(json["parameters"][i].at("name") == entry.parameters[i].name);
      for (const char* key : {"unit", "default", "range", "low", "high", "choices", "meaning"})
        CHECK(json["parameters"][i].contains(key));
    }
    CHECK(json.at("channels").size() > 3);
    CHECK(json.at("default_channels").size() > 0);
  }
}

TEST_CASE("The channels listed are those of the parameters given") {
  const Json json = Json::parse(drev_command({"list", "camshaft", "--set", "cylinders=6", "--json"}).out);
  const std::string all = json.at("channels").dump();
  CHECK(contains(all, "\"inlet_6.angle_rad\""));
  CHECK_FALSE(contains(all, "inlet_7"));
}

TEST_CASE("Modes agree with the library") {
  const Json json = Json::parse(drev_command({"modes", "camshaft", "--json"}).out);
  const drev::ModelEntry& entry = drev::find_model("camshaft");
  const drev::ModelCase model_case = entry.build(drev::Parameters("camshaft", entry.parameters));
  const drev::ModeSet modes = drev::solve_modes(model_case.model.build());
  CHECK(json.at("model") == "camshaft");
  CHECK(json.at("contact") == "closed");
  CHECK(json.at("rigid_modes") == modes.rigid_modes);
  CHECK(json.at("parameters").at("cylinders") == 9);
  CHECK(json.at("parameters").at("drive") == "gears");
  const auto frequencies = json.at("frequencies_Hz").get<std::vector<double>>();
  REQUIRE(frequencies.size() == 10);
  for (std::size_t i = 0; i < frequencies.size(); ++i)
    CHECK(frequencies[i] == Approx(modes.frequency_Hz[i]).epsilon(1e-9));
}

TEST_CASE("Modes of small and of free models need no count") {
  const Json small = Json::parse(drev_command({"modes", "two_inertia", "--json"}).out);
  CHECK(small.at("frequencies_Hz").size() == 1);
  CHECK(small.at("rigid_modes") == 1);
  const auto open = drev_command({"modes", "two_mass_backlash", "--contact", "open", "--json"});
  CHECK(open.exit_code == 0);
  const Json none = Json::parse(open.out);
  CHECK(none.at("frequencies_Hz").empty());
  CHECK(none.at("rigid_modes") == 2);
  CHECK(none.at("contact") == "open");
  CHECK(drev_command({"modes", "two_inertia", "--count", "2"}).exit_code == 2);
  CHECK(Json::parse(drev_command({"modes", "camshaft", "--count", "3", "--json"}).out)
            .at("frequencies_Hz")
            .size() == 3);
}

TEST_CASE("Advice: every model tried, the cheapest that holds", "[once]") {
  const std::vector<std::string> words{"advise",
                                       "gear_drive",
                                       "--set",
                                       "duration_s=0.2",
                                       "torque_mean_Nm=-8000",
                                       "torque_amplitude_Nm=2000",
                                       "mesh_damping_Ns_per_m=20000",
                                       "--for",
                                       "steady peak mesh_2.force_N",
                                       "--within",
                                       "2%"};
  const auto text = drev_command(words);
  CHECK(text.exit_code == 0);
  for (const char* part : {"full model", "no backlash", "cannot be used", "Use ", "2 %", "holds"})
    CHECK(contains(text.out, part));
  std::vector<std::string> as_json = words;
  as_json.push_back("--json");
  const Json json = Json::parse(drev_command(as_json).out);
  CHECK(json.at("within") == 0.02);
  CHECK(json.at("unit") == "N");
  const Json& rungs = json.at("rungs");
  REQUIRE(rungs.size() >= 4);
  CHECK(rungs.back().at("name") == "full model");
  for (const Json& rung : rungs) {
    if (rung.at("name") != json.at("chosen")) continue;
    CHECK(rung.at("holds") == true);
    CHECK(std::abs(rung.at("value").get<double>() / rungs.back().at("value").get<double>() - 1.0) <= 0.02);
    CHECK(rung.at("cost").get<double>() <= 1.0);
  }
}

TEST_CASE("A run as JSON is one object with everything in it") {
  const auto run = drev_command({"run", "camshaft", "--set", "duration_s=0.05", "drive=held", "--json"});
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());
  const Json json = Json::parse(run.out);  // throws if there is anything else
  for (const char* key :
       {"model", "parameters", "method", "step_s", "status", "reason", "results", "energy_error", "energy",
        "steps", "halved_steps", "iterations", "run_time_s", "note"})
    CHECK(json.contains(key));
  const Json& results = json.at("results");
  for (const char* key :
       {"deflection_deg", "deflection_m", "max_torque_Nm", "max_torque_at", "max_force_N", "static_torque_Nm",
        "dynamic_amplification", "front_contacts", "back_contacts", "time_separated_s", "max_mesh_force_N",
        "contacts", "frequencies_Hz", "rigid_modes"})
    CHECK(results.contains(key));
  CHECK(json.at("status") == "success");
  CHECK(json.at("method") == "exact");
  CHECK(json.at("parameters").at("duration_s") == 0.05);
  CHECK(contains(json.at("note").get<std::string>(), "reconstruction"));
  CHECK(results.at("max_mesh_force_N").is_null());  // held: no mesh
  CHECK(results.at("contacts").empty());
  CHECK(results.at("dynamic_amplification").get<double>() ==
        Approx(results.at("max_torque_Nm").get<double>() / results.at("static_torque_Nm").get<double>()));
}

TEST_CASE("The figures of a run are the library's") {
  const auto run = drev_command(
      {"run", "camshaft", "--set", "duration_s=0.05", "cylinders=6", "--step", "1e-5", "--json"});
  const Json results = Json::parse(run.out).at("results");
  const drev::ModelEntry& entry = drev::find_model("camshaft");
  drev::Parameters parameters("camshaft", entry.parameters);
  parameters.set("duration_s", "0.05");
  parameters.set("cylinders", "6");
  const drev::ModelCase model_case = entry.build(parameters);
  const drev::System system = model_case.model.build();
  drev::Peaks torques(drev::find_channels(system, model_case.torques));
  drev::Peaks twist(drev::find_channels(system, {"inlet_6-fuel_1.twist_rad"}));
  drev::ContactStatistics contacts(system);
  drev::simulate(system, {.step = 1e-5, .t_end = 0.05}, {&torques, &twist, &contacts});
  CHECK(results.at("max_torque_Nm").get<double>() ==
        Approx(torques.peaks()[torques.largest()].amplitude()).epsilon(1e-12));
  CHECK(results.at("max_torque_at").get<std::string>() + ".torque_Nm" ==
        torques.channels()[torques.largest()].name());
  CHECK(results.at("deflection_deg").get<double>() ==
        Approx(drev::to_deg(twist.peaks()[0].amplitude())).epsilon(1e-12));
  long front = 0;
  double force = 0.0;
  for (const drev::ContactRecord& record : contacts.records()) {
    front += record.front_impacts;
    force = std::max(force, record.largest_force);
  }
  REQUIRE(results.at("contacts").size() == 2);
  CHECK(results.at("front_contacts") == front);
  const drev::ContactRecord& record = contacts.records()[0];
  const Json& mesh = results.at("contacts")[0];
  CHECK(mesh.at("impact_speed").at("unit") == "m/s");
  CHECK(mesh.at("impact_speed").at("both").at("p90").get<double>() ==
        Approx(record.speed().quantile(0.9)).epsilon(1e-12));
  CHECK(mesh.at("impact_speed").at("front").at("max").get<double>() ==
        Approx(record.front_speed.largest()).epsilon(1e-12));
  CHECK(mesh.at("impact_force").at("back").at("count") == record.back_force.count());
  CHECK(mesh.at("rattle_index_W").get<double>() == Approx(record.impact_energy / 0.05).epsilon(1e-12));
  CHECK(results.at("max_mesh_force_N").get<double>() == Approx(force).epsilon(1e-12));
  double largest_static = 0.0;  // at other angles than drev's
  for (const drev::Peak& p : drev::static_sweep(system, drev::find_channels(system, model_case.torques), 0.0,
                                                2 * drev::kTwoPi, 1000))
    largest_static = std::max(largest_static, p.amplitude());
  CHECK(results.at("static_torque_Nm").get<double>() == Approx(largest_static).epsilon(2e-3));
}

TEST_CASE("What has no meaning for a model is null") {
  const auto of = [](std::vector<std::string> words) {
    words.push_back("--json");
    const auto run = drev_command(words);
    CHECK(run.exit_code == 0);
    CHECK_FALSE(contains(run.out, "nan"));
    return Json::parse(run.out).at("results");
  };
  const Json free = of({"run", "camshaft", "--set", "drive=free", "--set", "duration_s=0.01"});
  CHECK(free.at("static_torque_Nm").is_null());
  CHECK(free.at("dynamic_amplification").is_null());
  CHECK(free.at("rigid_modes") == 1);
  const Json masses = of({"run", "two_mass_backlash", "--set", "duration_s=2"});
  CHECK(masses.at("deflection_deg").is_null());
  CHECK(masses.at("deflection_m").get<double>() > 0.0);
  CHECK(masses.at("max_torque_Nm").is_null());
  CHECK(masses.at("max_force_N").get<double>() > 0.0);
  CHECK(masses.at("static_torque_Nm").is_null());
  const Json shaft = of({"run", "two_inertia", "--set", "duration_s=0.01"});
  CHECK(shaft.at("front_contacts").is_null());
  CHECK(shaft.at("static_torque_Nm").is_null());
}

TEST_CASE("Meshes without backlash have a force and no impacts") {
  const Json results = Json::parse(drev_command({"run", "gear_drive", "--set=duration_s=0.1",
                                                 "--set=backlash_mm=0", "--step=1e-5", "--json"})
                                       .out)
                           .at("results");
  CHECK(results.at("max_mesh_force_N").get<double>() > 1000.0);
  CHECK(results.at("front_contacts").is_null());
  CHECK(results.at("contacts").empty());
}

TEST_CASE("The table has its units, and says what the data are") {
  const auto run = drev_command({"run", "camshaft", "--set", "duration_s=0.02", "--step", "1e-5"});
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());  // no progress where there is no terminal
  for (const char* part :
       {" deg between fuel_1 and inlet_9", " N m in shaft_", " Hz", "mesh_1", "mesh_2", "front", "back",
        "separated [s]", "rattle index", "[%]", "equilibrium", "Dynamic amplification", "Energy balance",
        "average_acceleration", "step 1e-05 s", "halved", "iterations", "reconstruction"})
    CHECK(contains(run.out, part));
}

TEST_CASE("A run that failed looks like one") {
  const std::vector<std::string> stiff{"run",   "two_mass_backlash", "--set",  "k_1_N_per_m=2e8",
                                       "--set", "k_2_N_per_m=2e8",   "--step", "1e-3"};
  SECTION("unstable") {
    const auto run = drev_command(stiff);
    CHECK(run.exit_code == 1);
    CHECK(run.out.starts_with("*** RUN FAILED (unstable)"));
    CHECK(contains(run.err, "RUN FAILED (unstable)"));
    CHECK_FALSE(contains(run.out, "Largest force"));
    std::vector<std::string> with_json = stiff;
    with_json.push_back("--json");
    const auto json_run = drev_command(with_json);
    CHECK(json_run.exit_code == 1);
    const Json json = Json::parse(json_run.out);
    CHECK(json.at("status") == "unstable");
    CHECK(json.at("reason").get<std::string>().size() > 20);
    CHECK(json.at("results").at("max_force_N").is_null());
    CHECK(json.at("results").at("deflection_m").is_null());
  }
  SECTION("energy balance off") {
    const auto run = drev_command(
        {"run", "two_mass_backlash", "--set", "k_1_N_per_m=1e6", "k_2_N_per_m=1e6", "--step", "2e-3"});
    CHECK(run.exit_code == 1);
    CHECK(run.out.starts_with("*** DO NOT TRUST THIS RUN"));
    CHECK(contains(run.err, "DO NOT TRUST THIS RUN"));
    CHECK(contains(run.err, "energy balance is off by"));
  }
}

TEST_CASE("Methods and parameters reach the computation") {
  const auto run = drev_command({"run", "--set", "duration_s=0.5", "two_mass_backlash", "--method", "hht:0.1",
                                 "--step", "0.001", "--json"});
  CHECK(run.exit_code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json.at("method") == "hht:0.1");
  CHECK(json.at("step_s") == 0.001);
  CHECK(json.at("steps") == 500);
}

TEST_CASE("Exact propagation: the benchmark's exact curve, and what keeps a model from it") {
  const auto run = drev_command({"run", "two_mass_backlash", "--method", "exact", "--json"});
  CHECK(run.exit_code == 0);
  const Json object = Json::parse(run.out);
  CHECK(object.at("method") == "exact");
  CHECK(object.at("step_s").is_null());
  CHECK(object.at("tolerance") == 1e-10);
  CHECK(object.at("contact_changes") == 72);  // of the exact solution over 10 s
  CHECK(std::abs(object.at("energy_error").get<double>()) < 1e-9);
  // Largest values of 1e6 steps of average acceleration: off by h^2.
  const auto fine =
      drev_command({"run", "two_mass_backlash", "--step", "1e-5", "--set", "duration_s=2", "--json"});
  const auto exact =
      drev_command({"run", "two_mass_backlash", "--method", "exact", "--set", "duration_s=2", "--json"});
  for (const char* figure : {"deflection_m", "max_force_N", "max_mesh_force_N"})
    CHECK(Json::parse(exact.out)["results"][figure].get<double>() ==
          Approx(Json::parse(fine.out)["results"][figure].get<double>()).epsilon(3e-5));

  const auto refused =
      drev_command({"run", "gear_drive", "--method", "exact", "--step", "1e-5", "--tolerance", "2"});
  CHECK(refused.exit_code == 2);
  for (const char* part : {"2 faults", "--step = 1e-5 s, has no meaning", "--tolerance = 2, must be"})
    CHECK(contains(refused.err, part));
  const auto both = drev_command({"run", "camshaft", "--step", "1e-5", "--tolerance", "1e-8"});
  CHECK(both.exit_code == 2);
  CHECK(contains(both.err, "--step = 1e-5 s, needs a --method with --tolerance"));
}

TEST_CASE("A tolerance controls the steps of a stepping method, what it took is said") {
  const std::vector<std::string> words{
      "run", "two_mass_backlash", "--method", "dormand_prince", "--tolerance", "1e-8"};
  const Json truth = Json::parse(drev_command({"run", "two_mass_backlash", "--json"}).out);
  std::vector<std::string> with_json = words;
  with_json.push_back("--json");
  const auto run = drev_command(with_json);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json.at("method") == "dormand_prince");
  CHECK(json.at("tolerance") == 1e-8);
  CHECK(json.at("step_s").is_null());
  CHECK(json.at("located") == 72);  // of the exact solution over 10 s
  CHECK(json.at("forced_steps") == 0);
  for (const char* figure : {"deflection_m", "max_force_N", "max_mesh_force_N"})
    CHECK(json["results"][figure].get<double>() ==
          Approx(truth["results"][figure].get<double>()).epsilon(1e-5));
  const std::string text = drev_command(words).out;
  for (const char* part : {"dormand_prince, tolerance 1e-08, to t", " rejected", "72 kinks or knots located"})
    CHECK(contains(text, part));
  CHECK_FALSE(contains(text, "halved"));
  // --step is the largest.
  std::vector<std::string> short_steps = with_json;
  short_steps.insert(short_steps.end(), {"--step", "1e-3"});
  const Json more = Json::parse(drev_command(short_steps).out);
  CHECK(more.at("step_s") == 1e-3);
  CHECK(more.at("steps").get<long>() >= 10000);
  // Everything wrong with it at once.
  const auto wrong =
      drev_command({"run", "two_mass_backlash", "--method", "hht:2", "--tolerance", "2", "--step", "11"});
  CHECK(wrong.exit_code == 2);
  for (const char* part :
       {"3 faults", "alpha = 2", "--tolerance = 2, must be a number from 1e-13 to 0.1", "--step = 11 s"})
    CHECK(contains(wrong.err, part));
}

TEST_CASE("The method follows the model unless it is asked for, and the run says which and why") {
  const auto method = [](std::vector<std::string> words) {
    words.insert(words.end(), {"--set", "duration_s=0.01", "--json"});
    const Json json = Json::parse(drev_command(words).out);
    return json.at("method").get<std::string>() + ": " + json.at("method_reason").get<std::string>();
  };
  CHECK(contains(method({"run", "camshaft"}), "exact: the model is piecewise linear, with"));
  CHECK(contains(method({"run", "gear_drive", "--set", "mesh_stiffness=fourier"}),
                 "exact: the model is smooth between contact changes, with"));
  CHECK(contains(method({"run", "gear_drive", "--step", "1e-5"}), "average_acceleration: "));
  CHECK(contains(method({"run", "gear_drive", "--tolerance", "1e-8"}), "exact: "));
  CHECK(contains(method({"run", "gear_drive", "--method", "hht"}), "hht:0.05: asked for"));
  CHECK(contains(drev_command({"run", "two_mass_backlash"}).out,
                 "Why this method         the model is piecewise linear, with 2 unknowns and 2 contacts"));
}

TEST_CASE("A mistyped method names the nearest one, exact among them") {
  const auto near = drev_command({"run", "camshaft", "--method", "exac"});
  CHECK(near.exit_code == 2);
  CHECK(contains(near.err, "did you mean 'exact'?"));
  CHECK(contains(drev_command({"run", "camshaft", "--method", "exact:1e-9"}).err, "--tolerance"));
}

TEST_CASE("The default step follows the fastest thing in a model") {
  // A torque of 31 kHz on two inertias: the twist is that of the forced vibration far above the mode,
  // at most twice A/(J_1 (w^2 - w_n^2)) k while the start rings.
  const auto fast = drev_command({"run", "two_inertia", "--method", "average_acceleration", "--set",
                                  "torque_frequency_Hz=31044.4", "duration_s=0.02", "--json"});
  const Json object = Json::parse(fast.out);
  CHECK(object.at("step_s").get<double>() < 1.0 / 31044.4 / 100);
  CHECK(object["results"]["max_torque_Nm"].get<double>() < 0.1);
  // A light mass between the springs rattles fast: the impacts of exact propagation.
  const std::vector<std::string> light{"run",   "two_mass_backlash", "--json",
                                       "--set", "mass_1_kg=1e-4",    "duration_s=1.5"};
  std::vector<std::string> average = light;
  average.insert(average.end(), {"--method", "average_acceleration"});
  const Json stepped = Json::parse(drev_command(average).out), truth = Json::parse(drev_command(light).out);
  for (const char* count : {"front_contacts", "back_contacts"})
    CHECK(stepped["results"][count] == truth["results"][count]);
}

#ifndef __SANITIZE_ADDRESS__  // which takes address space for itself, without end
namespace {

/// The file of so many shafts of 10,000 segments each, one behind the other, between discs.
std::string shafts_file(const drev::test::TemporaryFolder& folder, int shafts) {
  std::ostringstream nodes, elements;
  for (int i = 0; i <= shafts; ++i) {
    nodes << "n" << i << " = {}\n";
    elements << "J" << i << " = { type = \"inertia\", node = \"n" << i << "\", inertia_kg_m2 = 1 }\n";
  }
  for (int i = 0; i < shafts; ++i)
    elements
        << "s" << i << " = { type = \"distributed_shaft\", nodes = [\"n" << i << "\", \"n" << i + 1
        << "\"], outer_diameter_mm = 100, length_m = 1, density_kg_per_m3 = 7850, shear_modulus_GPa = 80, "
        << "segments = 10000 }\n";
  std::ofstream(folder / "shaft.toml") << "format = 1\n[nodes]\n"
                                       << nodes.str() << "[elements]\n"
                                       << elements.str();
  return (folder / "shaft.toml").string();
}

}  // namespace

TEST_CASE("The most segments that a shaft may have take memory that grows with their number alone") {
  // A matrix over 10,001 nodes is 800 MB.
  const drev::test::TemporaryFolder folder;
  const std::string file = shafts_file(folder, 1);
  const auto check = drev_command({"check", file}, {.memory = 400'000'000});
  CAPTURE(check.err);
  CHECK(check.exit_code == 0);
  CHECK(contains(check.out, "10001 nodes"));
  const auto list = drev_command({"list", file}, {.memory = 400'000'000});
  CHECK(list.exit_code == 0);
  CHECK(contains(list.out, "s0_10000"));
}

TEST_CASE("Too little memory is said, with what helps") {
  const drev::test::TemporaryFolder folder;
  const auto check = drev_command({"check", shafts_file(folder, 5)}, {.memory = 100'000'000});
  CAPTURE(check.err);
  CHECK(check.exit_code == 1);
  CHECK(contains(check.err, "there is not enough memory: take a model with fewer nodes or segments"));
}

#endif

TEST_CASE("A number that is too large is blamed, and not something else") {
  const drev::test::TemporaryFolder folder;
  const auto run =
      [&](const std::string& stiffness, const std::string& amplitude, const std::string& duration,
          std::vector<std::string> words) {
        std::ofstream(folder / "m.toml")
            << "format = 1\n[nodes]\na = {}\nb = {}\n[elements]\n"
            << "Ja = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
            << "Jb = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n"
            << "s = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = " << stiffness
            << " }\nload = { type = \"applied_torque\", node = \"a\", "
            << "harmonics = { frequency_Hz = [40], amplitude_Nm = [" << amplitude
            << "] } }\n[run]\nduration_s = " << duration << "\n";
        words.insert(words.begin(), {"run", (folder / "m.toml").string()});
        return drev_command(words);
      };
  const auto long_step = run("1e4", "10", "1e9", {"--step", "1e9"});
  CHECK(long_step.exit_code == 1);
  CHECK(contains(
      long_step.err,
      "so long a step, or so stiff a part, leaves nothing of the inertia of a; take a shorter step"));
  CHECK_FALSE(contains(long_step.err, "negative"));
  for (const char* method : {"exact", "average_acceleration", "sdirk4"}) {
    CAPTURE(method);
    const auto stiff = run("1e300", "10", "0.1", {"--method", method});
    CAPTURE(stiff.err);
    CHECK(stiff.exit_code == 1);
    CHECK_FALSE(contains(stiff.err, "load not finite"));
    CHECK_FALSE(contains(stiff.err, "negative"));
    CHECK((contains(stiff.err, "stiff")));
    for (const char* amplitude : {"1e300", "1e156", "1e150"}) {
      const auto large = run("1e4", amplitude, "0.1", {"--method", method});
      CAPTURE(large.err);
      CHECK_FALSE(contains(large.err, "nan"));
    }
  }
}
