// Which orders excite which modes, with loads at the speeds at which they meet; beside closed forms.
// Covers app/run/excitation.hpp and order_shaft() of app/run/run_up.hpp
#include "app/run/excitation.hpp"

#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/run/run_up.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;
using namespace drev::app;

namespace {

constexpr double kStiffness = 4e4;  // N m/rad; of a disc of 1 kg m2: the only mode has 200 rad/s

/// A disc on a shaft from a held node that runs up, with a load on the disc.
template <class Load>
System loaded_disc(double first, double last, typename Load::Params load) {
  Model m("disc on a shaft");
  const NodeId end = m.add_node("end"), disc = m.add_node("disc");
  m.set_reference(end, run_up(first, last, 0.0, 10.0));
  m.hold(end);
  m.add<Inertia>("J", {disc}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {end, disc}, {.stiffness = kStiffness, .damping = 3.0});
  m.add<Load>("load", {disc}, std::move(load));
  return m.build();
}

Excitation excitation_of(const System& system) {
  return find_excitation(system, solve_modes(system, {}), speed_range(system, 10.0));
}

/// Of the disc at an order; 0: the order is not found.
double answer_at(const Excitation& found, double order) {
  for (const Crossing& c : found.crossings)
    if (std::abs(c.order - order) < 1e-6) return c.answer;
  return 0.0;
}

}  // namespace

TEST_CASE("A propeller excites with its torque at the critical speed, from whatever speed the run starts") {
  // 10 % of 1000 (w/w_N)^2 N m in order 4, at w = 200/4 rad/s; a static response is torque over stiffness.
  for (const double first : {0.0, 1.0, 30.0, 110.0}) {
    const System system = loaded_disc<Propeller>(first, 120.0,
                                                 {.rated_torque = 1000.0,
                                                  .rated_speed = 125.0,
                                                  .harmonics = {{.order = 4.0, .amplitude = 0.1}},
                                                  .twist_feedback = false});
    const Excitation found = excitation_of(system);
    REQUIRE(found.crossings.size() == 1);
    CHECK(found.crossings[0].order == 4.0);
    CHECK(found.crossings[0].speed == Approx(50.0));
    // From 110 rad/s on the critical is below half of all speeds, and the loads are those at 55 rad/s.
    const double at = std::max(50.0, 0.5 * first);
    CHECK(found.crossings[0].answer == Approx(100.0 * std::pow(at / 125.0, 2) / kStiffness).epsilon(1e-9));
    CHECK(chief_orders(found.crossings, speed_range(system, 10.0)) == std::vector<double>{4.0});
  }
}

TEST_CASE("Gas and mass torques of a cylinder excite by what they are at each critical speed") {
  // Mass torque, with q = r/l: m r^2 w^2 (q/4 + q^3/16, 1/2 + q^4/32, 3 q/4 + 9 q^3/32 of orders 1, 2, 3): J. P. Den
  // Hartog, Mechanical Vibrations, 1956, section 5.3. Gas: 5 bar A r in order 0.5 at any speed.
  const double r = 0.05, q = 0.25, mass = 4.0, area = 0.25 * kPi * 0.01;
  const double mass_part[] = {q / 4.0 + q * q * q / 16.0, 0.5, 0.75 * q + 9.0 / 32.0 * q * q * q};
  for (const double first : {0.0, rpm(10.0), rpm(600.0)}) {
    const System system =
        loaded_disc<EngineCylinders>(first, rpm(1200.0),
                                     {.bore = 0.1,
                                      .stroke = 2.0 * r,
                                      .rod = r / q,
                                      .oscillating_mass = mass,
                                      .firing_angles = {0.0},
                                      .tangential_pressure = {{.order = 0.5, .amplitude = 5e5}}});
    const Excitation found = excitation_of(system);
    for (int order = 1; order <= 3; ++order) {
      const double torque = mass * r * r * std::pow(200.0 / order, 2) * mass_part[order - 1];
      CHECK(answer_at(found, order) == Approx(torque / kStiffness).epsilon(2e-3));
    }
    CHECK(answer_at(found, 0.5) == Approx(5e5 * area * r / kStiffness).epsilon(1e-6));
  }
  CHECK(driven_nodes(loaded_disc<EngineCylinders>(0.0, rpm(1200.0),
                                                  {.bore = 0.1,
                                                   .stroke = 2.0 * r,
                                                   .rod = r / q,
                                                   .oscillating_mass = mass,
                                                   .firing_angles = {0.0}})) ==
        std::vector<std::string>{"disc"});
}

TEST_CASE("The shaft of orders is one that can turn: not the nodes that springs tie to ground") {
  const auto grounded = [](bool other) {
    Model m("arm and motor");
    for (const char* node : {"motor", "arm"}) {
      m.add_node(node);
      m.add<Inertia>(std::string("J ") + node, {node}, {.inertia = 1.0});
    }
    m.add<GroundSpring>("spring", {"arm"}, {.stiffness = 10.0});
    const auto swings = [](double size) {
      return TorqueFunction::Params{
          .torque = [size](const TorqueVariables& x) { return size * sin(x.angle); }};
    };
    m.add<TorqueFunction>("gravity", {"arm"}, swings(-2.0));
    if (other) m.add<TorqueFunction>("cogging", {"motor"}, swings(0.1));
    return m;
  };
  for (const bool other : {false, true}) {
    const Model m = grounded(other);
    CHECK(order_shaft(m, m.build(), "", 1.0).node == (other ? "motor" : ""));
    CHECK_FALSE(turned_with(m, m.build(), "arm"));
  }
}

TEST_CASE("Orders that a load states are its orders, whether they repeat in two turns or not") {
  const System system = loaded_disc<EngineOrderTorque>(
      60.0, 250.0,
      {.harmonics = {{.order = 2.2, .amplitude = 1.0},
                     {.order = 1.0, .amplitude = 30.0, .phase = 0.4},
                     {.order = 1.0, .amplitude = 40.0, .phase = 0.4 + kPi / 2}},
       .twist_feedback = false});
  const Excitation found = excitation_of(system);
  REQUIRE(found.crossings.size() == 2);
  CHECK(found.crossings[0].order == 1.0);
  CHECK(found.crossings[0].answer == Approx(50.0 / kStiffness).epsilon(1e-12));
  CHECK(found.crossings[1].order == Approx(2.2));
  CHECK(found.crossings[1].speed == Approx(200.0 / 2.2));
  CHECK(found.unknown.empty());
}

TEST_CASE("A load whose orders are not known is named instead of having none") {
  // A table that repeats in three turns of its node.
  const test::TemporaryFolder folder;
  const std::string path = (folder / "three.toml").string();
  const auto write = [&](const char* speed_0) {
    std::ofstream(path) << "format = 1\n[nodes]\nend = { hold = true, run_up = { speed_0_rpm = " << speed_0
                        << ", speed_1_rpm = 1200, time_1_s = 2 } }\ndisc = {}\n[elements]\n"
                           "J = { type = \"inertia\", node = \"disc\", inertia_kg_m2 = 1 }\n"
                           "shaft = { type = \"shaft_spring\", nodes = [\"end\", \"disc\"], "
                           "stiffness_Nm_per_rad = 40000, damping_Nms_per_rad = 3 }\n"
                           "pump = { type = \"cam_torque\", node = \"disc\", period_deg = 1080, table = { "
                           "angle_deg = [0, 300, 800], torque_Nm = [0, 50, -20] } }\n[run]\nduration_s = 2\n";
    const auto run = test::drev_command({"run", path, "--json", "--report", (folder / "r.html").string()});
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    return nlohmann::json::parse(run.out);
  };
  const auto up = write("600");
  REQUIRE(up.at("notes").size() == 1);
  CHECK(test::contains(up.at("notes")[0].get<std::string>(), "the orders of pump are not known"));
  CHECK(up.at("run_up").at("criticals").empty());
  CHECK(test::contains(test::drev_command({"run", path}).out, "Criticals passed        none known"));
  CHECK(write("1200").at("notes").empty());
  CHECK(write("-1300").at("run_up").at("slowest_rpm") == 0.0);
  CHECK(test::contains(test::drev_command({"run", path}).out,
                       "Run-up                  -1300.0 rpm to 1200.0 rpm\n"));
  write("1200");
  CHECK(test::contains(test::read_file(folder / "r.html"), "\"unknown\":[\"pump\"]"));
}
