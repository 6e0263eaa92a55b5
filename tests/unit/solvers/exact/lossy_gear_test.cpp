// LossyGear: efficiency by quadrant and self-locking, against closed forms and Modelica's results (cases G1 to G3).
// Covers solvers/exact/friction_gears.cpp through propagate().
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/statics.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

double value(const System& system, const State& state, const std::string& name) {
  Assembler assembler(system);
  assembler.set_time(state.t);
  return find_channel(system, name).evaluate(assembler, state);
}

struct GearRun {
  RunSummary summary;
  State state;
};

GearRun ran(const System& system, double t_end) {
  GearRun r{.summary = {}, .state = State::initial(system)};
  r.summary = propagate(system, {.tolerance = 1e-14, .t_end = t_end, .energy_tolerance = 1e-10}, r.state);
  INFO(r.summary.brief_report());
  CHECK(r.summary.ok());
  return r;
}

Model gear_train(double j_1, double j_2, LossyGear::Params gear) {
  Model m("lossy gear");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("J_a", {"a"}, {.inertia = j_1});
  m.add<Inertia>("J_b", {"b"}, {.inertia = j_2});
  m.add<LossyGear>("gear", {"a", "b"}, std::move(gear));
  return m;
}

void load(Model& m, const std::string& node, double torque) {
  m.add<AppliedTorque>("on " + node, {node}, {.table = TimeTable({0.0}, {torque})});
}

}  // namespace

TEST_CASE("Lossy gear: Demo1 of the Modelica Standard Library (case G1)") {
  Model m = gear_train(1.0, 1.5, {.ratio = 0.5, .efficiency_forward = 0.5, .efficiency_backward = 0.5});
  m.add<AppliedTorque>("sine", {"a"}, {.harmonics = {{1.0, 10.0, -kPi / 2.0}}});
  m.add<AppliedTorque>("ramp", {"b"}, {.table = TimeTable({0.0, 4.0}, {-10.0, 0.0})});
  const System system = m.build();
  const GearRun end = ran(system, 0.5);
  const std::vector<std::pair<double, std::string>> expected{{.0804771338559, "stuck"},
                                                             {.1995199008476, "sliding forward"},
                                                             {.3713427780495, "stuck"},
                                                             {.4645394616362, "sliding backward"}};
  REQUIRE(end.summary.friction_events.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(std::abs(end.summary.friction_events[i].t - expected[i].first) < 2e-12);
    CHECK(end.summary.friction_events[i].becomes == expected[i].second);
  }
  CHECK(std::abs(end.state.v[1] - -.0162619294) < 1e-10);
  CHECK(end.state.v[0] == Approx(2.0 * end.state.v[1]).epsilon(1e-14));
  CHECK(value(system, end.state, "gear.heat_J") == Approx(.0185210833).epsilon(1e-8));
  const State at_004 = ran(system, 0.04).state, at_03 = ran(system, 0.3).state;
  CHECK(std::abs(at_004.v[1] - -.0208414939) < 1e-10);
  CHECK(std::abs(at_03.v[1] - .0131811951) < 1e-10);
  CHECK(std::abs(at_03.z[1] - -5.17318149e-4) < 1e-12);
  CHECK(value(system, ran(system, 0.1).state, "gear.state") == 0.0);
}

TEST_CASE("Lossy gear: efficiency by quadrant (case G2)") {
  for (const bool first : {true, false}) {
    Model m = gear_train(1.0, 1.5, {.ratio = 0.5, .efficiency_forward = 0.5, .efficiency_backward = 0.5});
    load(m, first ? "a" : "b", 10.0);
    const System system = m.build();
    const GearRun r = ran(system, 0.5);
    const double a_b = first ? 10.0 / 3.5 : 10.0 / 9.5;
    CHECK(r.state.v[1] == Approx(0.5 * a_b).epsilon(1e-14));
    CHECK(value(system, r.state, "gear.driving_shaft") == (first ? 1.0 : 2.0));
    const double in = value(system, r.state, "gear.torque_in_Nm"),
                 out = value(system, r.state, "gear.torque_out_Nm");
    CHECK(in == Approx((first ? 10.0 : 0.0) - 2.0 * a_b).epsilon(1e-13));
    CHECK(out == Approx(1.5 * a_b - (first ? 0.0 : 10.0)).epsilon(1e-13));
    CHECK((first ? out / (2.0 * in) : 2.0 * in / out) == Approx(0.5).epsilon(1e-13));
    CHECK(value(system, r.state, "gear.loss_power_W") ==
          Approx(in * r.state.v[0] - out * r.state.v[1]).epsilon(1e-13));
  }
}

TEST_CASE("Lossy gear: which shaft drives is not obvious (Modelica's Demo3, case G3)") {
  Model m = gear_train(1e-3, 1e-3,
                       {.ratio = 1.0,
                        .efficiency_forward = 0.25,
                        .efficiency_backward = 0.25,
                        .bearing_torque_forward = 0.625,
                        .bearing_torque_backward = 2.5});
  m.set_initial("a", 0.0, 10.0);  // and with it b
  m.add<AppliedTorque>("step", {"a"}, {.table = TimeTable({0.5, 0.5}, {0.0, 1.0})});
  const System system = m.build();
  const GearRun r = ran(system, 2.0);
  REQUIRE(r.summary.friction_events.size() == 1);
  CHECK(r.summary.friction_events[0].t == Approx(0.02).epsilon(1e-13));
  CHECK(r.state.z[0] == Approx(0.1).epsilon(1e-13));
  CHECK(r.state.z[1] == Approx(0.1).epsilon(1e-13));
  CHECK(std::abs(r.state.v[0]) < 1e-15);
  CHECK(r.summary.steps < 20);
}
