// Friction, OneWayClutch and OneWayClutchDisengaged of the Modelica Standard Library (commit b756f9de, BSD-3-Clause,
// Copyright Modelica Association and contributors): events as published (Dymola, MAP-LIB_ReferenceResults) and as
// computed by an independent code with located events (data/msl_friction_expected.csv).
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/published/read_csv.hpp"

using namespace drev;

namespace {

void check_events(const RunSummary& run, const std::string& element, const std::vector<double>& times,
                  double within) {
  std::vector<double> found;
  for (const FrictionEvent& e : run.friction_events)
    if (e.element == element) found.push_back(e.t);
  INFO(element);
  REQUIRE(found.size() == times.size());
  for (std::size_t i = 0; i < times.size(); ++i) CHECK(std::abs(found[i] - times[i]) < within);
}

Model inertias(const std::vector<std::pair<std::string, std::pair<double, double>>>& all) {
  Model m("friction");
  for (const auto& [name, values] : all) {
    m.add_node(name);
    m.add<Inertia>("J_" + name, {name}, {.inertia = values.first});
    m.set_initial(name, 0.0, values.second);
  }
  return m;
}

}  // namespace

TEST_CASE("Published: Friction of the Modelica Standard Library, clutch and brake") {
  Model m = inertias({{"w1", {1.0, 90.0}}, {"w2", {0.05, 90.0}}, {"w3", {1.0, 100.0}}});
  m.add<AppliedTorque>(
      "motor", {"w3"},
      {.torque = [](double t) { return t < 0.5 ? 200.0 * std::sin(100.0 * t) : 0.0; }, .breakpoints = {0.5}});
  m.add<Clutch>("clutch", {"w3", "w2"},
                {.normal_force = 160.0, .geometry = 1.0, .friction_coefficient = 0.5});
  m.add<ShaftSpring>("spring", {"w2", "w1"}, {.stiffness = 160.0, .damping = 1.0});
  m.add<Brake>("brake", {"w1"}, {.torque = 800.0, .engagement = TimeTable({0.5, 0.5}, {0.0, 1.0})});
  const System system = m.build();
  Recorder recorder(
      system,
      {"w3.speed_rad_per_s", "w2.speed_rad_per_s", "w1.speed_rad_per_s", "clutch.heat_J", "brake.heat_J"},
      0.05);
  const RunSummary run =
      propagate(system, {.tolerance = 1e-12, .t_end = 3.0, .energy_tolerance = 1e-11}, {&recorder});
  INFO(run.brief_report());
  CHECK(run.ok());
  check_events(run, "clutch", {.006779709, .059339284, .109289827, .534248339, 1.663641443}, 1e-8);
  check_events(run, "clutch", {.00677971, .05934006, .10928950, .53424865, 1.66363978}, 3e-6);  // published
  check_events(run, "brake", {0.5, .640613941}, 1e-8);
  int compared = 0;
  for (const auto& row : read_csv("msl_friction_expected.csv")) {
    if (row[0][0] == '#') continue;
    const auto i = static_cast<std::size_t>(std::lround(std::stod(row[0]) / 0.05));
    INFO("t = " << row[0]);
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(std::abs(recorder.samples(c)[i] - std::stod(row[c + 1])) <
            1e-9 + 5.1e-10 * std::abs(std::stod(row[c + 1])));  // 10 digits are printed
    ++compared;
  }
  CHECK(compared == 61);
  CHECK(recorder.samples(3).back() == Approx(3776.86208).epsilon(1e-8));
  CHECK(recorder.samples(4).back() == Approx(5446.31713).epsilon(1e-8));
}

TEST_CASE("Published: OneWayClutchDisengaged of the Modelica Standard Library, a freewheel") {
  Model m = inertias({{"in", {1.0, -0.5}}, {"out", {1.0, 0.0}}});
  m.add<Freewheel>("freewheel", {"in", "out"}, {});
  m.add<AppliedTorque>("sine", {"in"}, {.harmonics = {{2.0, 10.0, -kPi / 2.0}}});
  m.add<AppliedTorque>("offset", {"in"}, {.table = TimeTable({0.0}, {0.3})});
  m.add<AppliedTorque>("load", {"out"}, {.table = TimeTable({0.0}, {-0.3})});
  const System system = m.build();
  Recorder recorder(system, {"in.speed_rad_per_s", "out.speed_rad_per_s"}, 0.1);
  const RunSummary run =
      propagate(system, {.tolerance = 1e-13, .t_end = 1.4, .energy_tolerance = 1e-10}, {&recorder});
  INFO(run.brief_report());
  CHECK(run.ok());
  check_events(run, "freewheel",
               {.0888614174, .2547775177, .6839241406, .7547775177, 1.1839241406, 1.2547775177}, 2e-10);
  CHECK(recorder.samples(0)[3] == Approx(.408078856).epsilon(2e-9));
  CHECK(recorder.samples(1)[3] == Approx(.531491128).epsilon(2e-9));
  CHECK(recorder.samples(0)[5] == Approx(-.971491128).epsilon(2e-9));
  CHECK(recorder.samples(1)[5] == Approx(.471491128).epsilon(2e-9));
}

namespace {

System freewheel_beside_clutch() {
  Model m = inertias({{"in", {1.0, -0.5}}, {"out", {1.0, 0.0}}});
  m.add<Freewheel>("freewheel", {"in", "out"}, {});
  m.add<Clutch>("clutch", {"in", "out"},
                {.torque = 1.5,
                 .break_away_ratio = 25.0,
                 .engagement = TimeTable({0.3, 0.3, 0.95, 0.95, 1.6, 1.6, 2.25, 2.25},
                                         {0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0})});
  m.add<AppliedTorque>("sine", {"in"}, {.harmonics = {{3.0, 10.0, -kPi / 2.0}}});
  return m.build();
}

}  // namespace

TEST_CASE("Published: OneWayClutch of the Modelica Standard Library, a freewheel beside a clutch") {
  const System system = freewheel_beside_clutch();
  Recorder recorder(system, {"in.speed_rad_per_s", "out.speed_rad_per_s"}, 0.05);
  const RunSummary run =
      propagate(system, {.tolerance = 1e-13, .t_end = 2.2, .energy_tolerance = 1e-10}, {&recorder});
  INFO(run.brief_report());
  CHECK(run.ok());
  // Locks, frees, locks, frees, locks, frees, locks.
  std::vector<double> met;
  for (const FrictionEvent& e : run.friction_events) met.push_back(e.t);
  for (const double t : {.0802795, 1.0 / 6.0, .4306773957, .95, 1.05, 1.1666666667, 1.7562044474}) {
    double nearest = 1.0;
    for (const double found : met) nearest = std::min(nearest, std::abs(found - t));
    INFO(t);
    CHECK(nearest < (t < 0.1 ? 1e-5 : 1e-8));
  }
  CHECK(recorder.samples(0)[10] == Approx(.280516477).epsilon(2e-9));
  CHECK(recorder.samples(1)[10] == Approx(.280516477).epsilon(2e-9));
  CHECK(recorder.samples(0)[19] == Approx(-.140656642).epsilon(4e-9));
  CHECK(recorder.samples(0)[26] == Approx(-.679196846).epsilon(2e-9));
  CHECK(recorder.samples(1)[26] == Approx(.280516477).epsilon(2e-9));
  CHECK(std::abs(recorder.samples(0)[40] + .25) < 1e-9);
  CHECK(std::abs(recorder.samples(1)[40] + .25) < 1e-9);
}

TEST_CASE("Published: the freewheel of OneWayClutch, whatever the tolerance") {
  // At 1.5 s it just locks, with a torque that is rounding of sin(9 pi), and lets go: the speeds meet without crossing.
  const System system = freewheel_beside_clutch();
  for (double exponent = 6.0; exponent < 13.0; exponent += 0.02) {
    State state = State::initial(system);
    const RunSummary run = propagate(system, {.tolerance = std::pow(10.0, -exponent), .t_end = 2.0}, state);
    INFO("tolerance 1e-" << exponent << ": " << run.brief_report());
    CHECK(run.ok());
    for (const double speed : state.v) CHECK(std::abs(speed + .25) < 1e-6);
  }
}
