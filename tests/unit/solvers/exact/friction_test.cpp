// Dry friction: sticking and sliding against closed forms (tests of the Modelica cases: friction_msl_test.cpp).
// Covers solvers/exact/friction_series.hpp through propagate().
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/statics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/solvers/exact/friction_run.hpp"

using namespace drev;
using test::channel_at, test::FrictionRun, test::ran_to;

namespace {

Model two_inertias(double j_1, double w_1, double j_2, double w_2) {
  Model m("two inertias");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("J_a", {"a"}, {.inertia = j_1});
  m.add<Inertia>("J_b", {"b"}, {.inertia = j_2});
  m.set_initial("a", 0.0, w_1);
  m.set_initial("b", 0.0, w_2);
  return m;
}

}  // namespace

TEST_CASE("Friction: a clutch engages, constant torque, ramp, torque falling with slip (case F5)") {
  const auto engage = [](Clutch::Params clutch, double slip_time) {
    Model m = two_inertias(0.5, 30.0, 0.6, -10.0);
    m.add<Clutch>("clutch", {"a", "b"}, std::move(clutch));
    const System system = m.build();
    const FrictionRun r = ran_to(system, 1.0);
    REQUIRE(r.summary.friction_events.size() == 1);
    CHECK(r.summary.friction_events[0].becomes == "stuck");
    CHECK(r.summary.friction_events[0].t == Approx(slip_time).epsilon(1e-9));
    CHECK(r.state.v[0] == Approx(90.0 / 11.0).epsilon(1e-14));
    CHECK(r.state.v[1] == Approx(90.0 / 11.0).epsilon(1e-14));
    CHECK(channel_at(system, r.state, "clutch.slip_speed_rad_per_s") == 0.0);
    CHECK(std::abs(channel_at(system, r.state, "clutch.torque_Nm")) < 1e-12);
    // J_1 J_2/(J_1 + J_2) dw^2/2
    CHECK(channel_at(system, r.state, "clutch.heat_J") == Approx(0.3 / 1.1 * 800.0).epsilon(1e-12));
  };
  engage({.torque = 60.0}, 2.0 / 11.0);
  engage({.normal_force = 1000.0, .geometry = 0.15, .friction_coefficient = 0.4}, 2.0 / 11.0);
  engage({.torque = 60.0, .engagement = TimeTable({0.0, 0.3}, {0.0, 1.0})}, 0.331818181818181818);
  // w' = -(60 - 0.5 w) (1/J_1 + 1/J_2) from 40: the torque falls with the slip speed.
  engage({.slip_speeds = {0.0, 100.0}, .sliding_torques = {60.0, 10.0}}, std::log(1.5) / (0.5 * 11.0 / 3.0));
  // It opens for good at 0.1 s: nothing changes from there on.
  Model m = two_inertias(0.5, 30.0, 0.6, -10.0);
  m.add<Clutch>("clutch", {"a", "b"}, {.torque = 60.0, .engagement = TimeTable({0.1, 0.1}, {1.0, 0.0})});
  const FrictionRun open = ran_to(m.build(), 1.0);
  CHECK(open.state.v[0] == Approx(18.0).epsilon(1e-14));
  CHECK(open.summary.friction_events[0].becomes == "open");
}

TEST_CASE("Friction: a torque that rises with the slip is a damper, on either side of zero slip") {
  // As long as the run, the first step behind zero slip would be longer than the damper's rate allows.
  for (const double t_end : {0.5, 1.0, 1.1, 10.0}) {
    Model m("brake");
    m.add_node("n");
    m.add<Inertia>("J", {"n"}, {.inertia = 1.0});
    m.add<GroundSpring>("spring", {"n"}, {.stiffness = 10.0, .damping = 2.0});
    m.set_initial("n", 0.5, 0.5);
    Model damped = m;
    m.add<Brake>("brake", {"n"}, {.slip_speeds = {0.0, 10.0}, .sliding_torques = {0.0, 10.0}});
    damped.add<Dashpot>("damper", {"n"}, {.damping = 1.0});
    const FrictionRun r = ran_to(m.build(), t_end), expected = ran_to(damped.build(), t_end);
    INFO(t_end);
    CHECK(r.state.z[0] == Approx(expected.state.z[0]).epsilon(1e-10).margin(1e-12));
    CHECK(r.state.v[0] == Approx(expected.state.v[0]).epsilon(1e-10).margin(1e-12));
  }
}

TEST_CASE("Friction: an engagement by a power of the time, whose series has gaps") {
  // J w' = -t^n w
  for (const double n : {1.0, 2.0, 3.0}) {
    Model m("brake");
    m.add_node("n");
    m.add<Inertia>("J", {"n"}, {.inertia = 1.0});
    m.set_initial("n", 0.0, 5.0);
    m.add<Brake>("brake", {"n"},
                 {.slip_speeds = {0.0, 10.0},
                  .sliding_torques = {0.0, 10.0},
                  .engagement_formula = TimeCurve(
                      {.function = [n](const Dual& t) { return pow(t, n); }, .from = 0.0, .to = 1.0})});
    CHECK(ran_to(m.build(), 1.0).state.v[0] == Approx(5.0 * std::exp(-1.0 / (n + 1.0))).epsilon(1e-12));
  }
}

TEST_CASE("Friction: stick-slip with a break-away torque (case F6)") {
  Model m("stick-slip");
  m.add_node("mass");
  m.add_node("drive");
  m.add<Inertia>("J", {"mass"}, {.inertia = 1.0});
  m.add<ShaftSpring>("spring", {"mass", "drive"}, {.stiffness = 100.0});
  Motion steady{[](double t) { return MotionPoint{0.2 * t, 0.2, 0.0}; }};
  steady.piecewise_quadratic = true;
  m.given_motion("drive", steady);
  m.add<BearingFriction>("bearing", {"mass"}, {.torque = 4.0, .break_away_ratio = 1.5});
  const System system = m.build();
  const double slip = 3.0 * kPi / 20.0, period = slip + 0.2;
  const FrictionRun r = ran_to(system, 0.3 + 10.0 * period);
  const auto& events = r.summary.friction_events;
  REQUIRE(events.size() >= 20);
  for (int i = 0; i < 10; ++i) {
    const auto k = static_cast<std::size_t>(2 * i);
    CHECK(events[k].t == Approx(0.3 + i * period).epsilon(1e-12));
    CHECK(events[k].becomes == "sliding forward");
    CHECK(events[k + 1].t == Approx(0.3 + slip + i * period).epsilon(1e-12));
    CHECK(events[k + 1].becomes == "stuck");
  }
  CHECK(channel_at(system, r.state, "bearing.heat_J") == Approx(10.0 * 0.536991118).epsilon(1e-8));
}

TEST_CASE("Friction: free decay stops at the turning points of Coulomb friction (case F7)") {
  Model m("decay");
  m.add_node("n");
  m.add<Inertia>("J", {"n"}, {.inertia = 2.0});
  m.add<GroundSpring>("spring", {"n"}, {.stiffness = 800.0});
  m.add<BearingFriction>("bearing", {"n"}, {.torque = 3.0});
  m.set_initial("n", 0.05, 0.0);
  const System system = m.build();
  for (int i = 1; i <= 7; ++i) {
    const double expected[] = {-0.0425, 0.035, -0.0275, 0.02, -0.0125, 0.005, 0.0025};
    const FrictionRun r = ran_to(system, i * kPi / 20.0 + (i == 7 ? 5.0 : 0.0));
    if (i < 7) CHECK(r.state.z[0] == Approx(expected[i - 1]).epsilon(1e-12));
    if (i == 7) CHECK(r.state.z[0] == Approx(0.0025).epsilon(1e-11));
    if (i == 7) CHECK(r.summary.friction_events.back().t == Approx(1.099557429).epsilon(1e-9));
    if (i == 7) CHECK(r.summary.friction_changes == 7);
  }
}

TEST_CASE("Friction: forced Coulomb oscillator, sliding and with stops (case F8, Den Hartog)") {
  std::vector<FrictionEvent> events;  // of the last cycle, from its start on
  const auto settled = [&events](double b, double r, double cycles, double& peak) {
    Model m("forced");
    m.add_node("n");
    m.add<Inertia>("J", {"n"}, {.inertia = 1.0});
    m.add<GroundSpring>("spring", {"n"}, {.stiffness = 1.0});
    m.add<BearingFriction>("bearing", {"n"}, {.torque = r});
    m.add<AppliedTorque>("load", {"n"}, {.harmonics = {{b / (2.0 * kPi), 1.0, 0.0}}});
    const System system = m.build();
    const double t_end = cycles * 2.0 * kPi / b;
    State state = State::initial(system);
    CHECK(propagate(system, {.tolerance = 1e-13, .t_end = t_end}, state).ok());
    Recorder recorder(system, {"n.angle_rad"}, 1e-3 * 2.0 * kPi / b);
    const RunSummary last = propagate(
        system, {.tolerance = 1e-13, .t_start = t_end, .t_end = t_end + 2.0 * kPi / b}, state, {&recorder});
    for (const double x : recorder.samples(0)) peak = std::max(peak, std::abs(x));
    events = last.friction_events;
    for (FrictionEvent& e : events) e.t -= t_end;
    return last.friction_changes;
  };
  double peak = 0.0;
  settled(2.0, 0.4, 60.0, peak);
  CHECK(peak == Approx(0.266666667).epsilon(2e-5));  // samples of a thousandth of the cycle
  peak = 0.0;
  settled(0.25, 0.5, 10.0, peak);
  CHECK(peak == Approx(0.691464065).epsilon(2e-5));
  // One stop in each half cycle: it slides from 5.51 to 10.74 of 8 pi, and half a cycle later the other way.
  REQUIRE(events.size() == 4);
  std::vector<double> times;
  for (const FrictionEvent& e : events) times.push_back(std::fmod(e.t, 4.0 * kPi));
  std::sort(times.begin(), times.end());
  for (const std::size_t i : {0u, 1u}) CHECK(times[i] == Approx(5.512570943).epsilon(2e-7));
  for (const std::size_t i : {2u, 3u}) CHECK(times[i] == Approx(10.739176161).epsilon(2e-7));
}

TEST_CASE(
    "Friction: forced Coulomb oscillator that never stops stays on its closed form (case F8, Den Hartog)") {
  // x'' + x + R sgn x' = cos(b t + phi): from a turning point A, x' = 0, with cos phi = A/V, sin phi = -R U/V the motion
  // is periodic: half a cycle later it turns at -A.
  for (const auto& [b, r, expected] :
       {std::tuple{0.7, 0.5, 1.744253936}, {1.3, 0.3, 1.315348197}, {2.0, 0.4, .266666667}}) {
    const double v = 1.0 / (1.0 - b * b), u = std::sin(kPi / b) / (b * (1.0 + std::cos(kPi / b))),
                 a = std::sqrt(v * v - r * r * u * u);
    INFO(b);
    CHECK(a == Approx(expected).epsilon(2e-9));
    Model m("forced");
    m.add_node("n");
    m.add<Inertia>("J", {"n"}, {.inertia = 1.0});
    m.add<GroundSpring>("spring", {"n"}, {.stiffness = 1.0});
    m.add<BearingFriction>("bearing", {"n"}, {.torque = r});
    m.add<AppliedTorque>("load", {"n"},
                         {.harmonics = {{b / (2.0 * kPi), 1.0, std::atan2(-r * u / v, a / v)}}});
    m.set_initial("n", a, 0.0);
    const System system = m.build();
    for (const int half_cycles : {1, 2, 7, 20}) {
      const FrictionRun half = ran_to(system, half_cycles * kPi / b - 1e-9);
      CHECK(std::abs(half.state.z[0]) == Approx(a).epsilon(1e-10));
      CHECK(half.state.z[0] * (half_cycles % 2 == 0 ? 1.0 : -1.0) > 0.0);
      for (const FrictionEvent& e : half.summary.friction_events) CHECK(e.becomes != "stuck");
    }
  }
}

TEST_CASE("Friction: engagement by a formula, closed forms of sticking and of slipping again") {
  const double rate = 60.0 * (1.0 / 0.5 + 1.0 / 0.6);  // of the slip speed, fully engaged
  const auto pressed = [](double t_0, double tau) {
    return TimeCurve(
        {.function = [=](const Dual& t) { return 1.0 - exp(-(t - t_0) / tau); }, .from = t_0, .to = 2.0});
  };
  {  // constant torque: 40 = rate (s - tau (1 - exp(-s/tau))), s = t - t_0
    Model m = two_inertias(0.5, 30.0, 0.6, -10.0);
    m.add<Clutch>("clutch", {"a", "b"}, {.torque = 60.0, .engagement_formula = pressed(0.05, 0.1)});
    double s = 0.2;
    for (int i = 0; i < 50; ++i)
      s -= (rate * (s - 0.1 * (1.0 - std::exp(-s / 0.1))) - 40.0) / (rate * (1.0 - std::exp(-s / 0.1)));
    const System system = m.build();
    const FrictionRun r = ran_to(system, 1.0);
    REQUIRE(r.summary.friction_events.size() >= 1);
    CHECK(r.summary.friction_events.back().becomes == "stuck");
    CHECK(r.summary.friction_events.back().t == Approx(0.05 + s).epsilon(1e-9));
    CHECK(channel_at(system, r.state, "clutch.heat_J") == Approx(0.3 / 1.1 * 800.0).epsilon(1e-12));
  }
  {  // torque falling with the slip speed, 60 - w/2: ln((120 - w)/80) = rate/120 integral of g, w = 0 at the end
    Model m = two_inertias(0.5, 30.0, 0.6, -10.0);
    m.add<Clutch>("clutch", {"a", "b"},
                  {.slip_speeds = {0.0, 100.0},
                   .sliding_torques = {60.0, 10.0},
                   .engagement_formula = pressed(0.0, 0.1)});
    double s = 0.3;
    for (int i = 0; i < 50; ++i)
      s -= (rate / 120.0 * (s - 0.1 * (1.0 - std::exp(-s / 0.1))) - std::log(1.5)) /
           (rate / 120.0 * (1.0 - std::exp(-s / 0.1)));
    const FrictionRun r = ran_to(m.build(), 1.0);
    CHECK(r.summary.friction_events.back().t == Approx(s).epsilon(1e-9));
  }
  {  // stuck, and let go: 10 N m on a, of which the clutch passes on 10 J_b/(J_a + J_b) = 60 exp(-t/0.1) at the end
    Model m = two_inertias(0.5, 5.0, 0.6, 5.0);
    m.add<Clutch>("clutch", {"a", "b"},
                  {.torque = 60.0,
                   .engagement_formula = TimeCurve(
                       {.function = [](const Dual& t) { return exp(-t / 0.1); }, .from = 0.0, .to = 3.0})});
    m.add<AppliedTorque>("load", {"a"}, {.table = TimeTable({0.0}, {10.0})});
    const FrictionRun r = ran_to(m.build(), 0.5);
    REQUIRE(r.summary.friction_events.size() >= 1);
    CHECK(r.summary.friction_events.front().t ==
          Approx(0.1 * std::log(60.0 / (10.0 * 0.6 / 1.1))).epsilon(1e-9));
    CHECK(r.summary.friction_events.front().becomes == "sliding backward");
  }
}

TEST_CASE("Friction: two clutches side by side carry together, and slip together") {
  Model m = two_inertias(1.0, 5.0, 2.0, 5.0);
  m.add<Clutch>("one", {"a", "b"}, {.torque = 10.0});
  m.add<Clutch>("two", {"a", "b"}, {.torque = 20.0});
  // The clutches carry two thirds of it: 30 N m at 45, after 4.5 s.
  m.add<AppliedTorque>("load", {"a"}, {.table = TimeTable({0.0, 10.0}, {0.0, 100.0})});
  const System system = m.build();
  const FrictionRun r = ran_to(system, 4.4);
  CHECK(r.state.v[0] == Approx(5.0 + 4.4 * 22.0 / 3.0).epsilon(1e-13));
  CHECK(channel_at(system, r.state, "one.torque_Nm") + channel_at(system, r.state, "two.torque_Nm") ==
        Approx(-44.0 * 2.0 / 3.0).epsilon(1e-12));
  const FrictionRun slips = ran_to(system, 6.0);
  // a' = 10 t - 30 behind 4.5 s, b' = 15.
  CHECK(slips.state.v[0] == Approx(5.0 + 33.75 + 5.0 * (36.0 - 20.25) - 45.0).epsilon(1e-13));
  CHECK(slips.state.v[1] == Approx(5.0 + 33.75 + 22.5).epsilon(1e-13));
  CHECK(slips.summary.friction_changes <= 4);
}

TEST_CASE("Friction: break-away in loops: contacts hold while some sharing of the torque lets them") {
  {  // Side by side: 1.5 (10 + 20) N m, two thirds of the load; then 30.
    Model m = two_inertias(1.0, 0.0, 2.0, 0.0);
    m.add<Clutch>("one", {"a", "b"}, {.torque = 10.0, .break_away_ratio = 1.5});
    m.add<Clutch>("two", {"a", "b"}, {.torque = 20.0, .break_away_ratio = 1.5});
    m.add<AppliedTorque>("load", {"a"}, {.table = TimeTable({0.0, 10.0}, {0.0, 100.0})});
    const FrictionRun r = ran_to(m.build(), 8.0);
    REQUIRE(r.summary.friction_events.size() == 2);
    for (const FrictionEvent& e : r.summary.friction_events) CHECK(e.t == Approx(6.75).epsilon(1e-12));
    CHECK(r.state.v[1] == Approx(6.75 * 6.75 * 5.0 / 3.0 + 15.0 * 1.25).epsilon(1e-12));
  }
  {  // Over the ground, with different ratios: two blocks tied by a joint on floors of 1.2 times 2 and 1.6 times 3.
    Model m = two_inertias(1.0, 0.0, 2.0, 0.0);
    m.add<BearingFriction>("floor_a", {"a"}, {.torque = 2.0, .break_away_ratio = 1.2});
    m.add<BearingFriction>("floor_b", {"b"}, {.torque = 3.0, .break_away_ratio = 1.6});
    m.add<CoulombJoint>("joint", {"a", "b"}, {.torque = 50.0, .break_away_ratio = 2.0});
    m.add<AppliedTorque>("load", {"a"}, {.table = TimeTable({0.0, 10.0}, {0.0, 10.0})});
    const FrictionRun r = ran_to(m.build(), 9.2);
    REQUIRE(r.summary.friction_events.size() == 2);
    for (const FrictionEvent& e : r.summary.friction_events) CHECK(e.t == Approx(7.2).epsilon(1e-12));
    CHECK(r.state.v[0] == Approx((0.5 * (9.2 * 9.2 - 7.2 * 7.2) - 5.0 * 2.0) / 3.0).epsilon(1e-12));
    CHECK(r.state.v[1] == Approx(r.state.v[0]).epsilon(1e-14));
  }
}

TEST_CASE("Friction: a row of blocks at rest lets go one after the other as the load grows") {
  // Chain of joints to ground and between nodes, all at rest: which slide is one problem over all of them.
  Model m("row");
  for (const char* n : {"a", "b", "c"}) {
    m.add_node(n);
    m.add<Inertia>(std::string("J_") + n, {n}, {.inertia = 1.0});
    m.add<BearingFriction>(std::string("floor_") + n, {n}, {.torque = 2.0});
  }
  m.add<CoulombJoint>("ab", {"a", "b"}, {.torque = 10.0});
  m.add<CoulombJoint>("bc", {"b", "c"}, {.torque = 1.0});
  m.add<AppliedTorque>("load", {"a"}, {.table = TimeTable({0.0, 10.0}, {0.0, 20.0})});
  const System system = m.build();
  // Together a and b go when the load is their floors and what bc holds: 2 + 2 + 1 = 5 N m, 2.5 s; c never.
  const FrictionRun r = ran_to(system, 4.0);
  CHECK(r.state.v[0] == Approx(0.5 * (1.5 * 1.5)).epsilon(1e-12));
  CHECK(r.state.v[1] == Approx(r.state.v[0]).epsilon(1e-14));
  CHECK(r.state.v[2] == 0.0);
  CHECK(channel_at(system, r.state, "bc.state") == -1.0);
  CHECK(channel_at(system, r.state, "ab.state") == 0.0);
  CHECK(channel_at(system, r.state, "floor_c.torque_Nm") == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("Friction: a train that is held at rest stays there, and its energy is no error") {
  Model m = two_inertias(0.3, 0.0, 0.7, 0.0);
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 300.0});
  m.add<Brake>("brake_a", {"a"}, {.torque = 5.0});
  m.add<Brake>("brake_b", {"b"}, {.torque = 5.0});
  m.add<AppliedTorque>("load", {"a"}, {.harmonics = {{3.0, 4.0, 0.3}}});
  const FrictionRun r = ran_to(m.build(), 1.0);
  CHECK(r.summary.friction_changes == 0);
  CHECK(r.state.v.lpNorm<Eigen::Infinity>() < 1e-15);
}

TEST_CASE("Friction: a train held at rest lets go when its harmonic load says so, at a few steps a cycle") {
  // 6 sin(2 pi f t) = 5 N m. A speed that is rounding stops at once; it is no measure of the motion to come.
  for (const double speed : {0.0, 1e-20}) {
    Model m("held");
    m.add_node("n");
    m.add<Inertia>("J", {"n"}, {.inertia = 0.1});
    m.add<BearingFriction>("bearing", {"n"}, {.torque = 5.0});
    m.add<AppliedTorque>("load", {"n"}, {.harmonics = {{3.0, 6.0, -0.5 * kPi}}});
    m.set_initial("n", 0.0, speed);
    const System system = m.build();
    const double lets_go = std::asin(5.0 / 6.0) / (6.0 * kPi);
    CHECK(ran_to(system, 0.999 * lets_go).summary.steps < 20);
    const FrictionRun r = ran_to(system, 0.1);
    const auto& events = r.summary.friction_events;
    const auto slides = std::find_if(events.begin(), events.end(), [](const FrictionEvent& e) {
      return e.becomes == "sliding forward" && e.t > 1e-6;
    });
    REQUIRE(slides != events.end());
    CHECK(slides->t == Approx(lets_go).epsilon(1e-9));
    // J v = int (6 sin - 5) dt
    const double omega = 6.0 * kPi;
    const double v =
        (6.0 / omega * (std::cos(omega * lets_go) - std::cos(omega * 0.1)) - 5.0 * (0.1 - lets_go)) / 0.1;
    CHECK(r.state.v[0] == Approx(v).epsilon(1e-9));
  }
  Model m = two_inertias(0.3, 0.0, 0.7, 0.0);
  m.add<CoulombJoint>("joint", {"a", "b"}, {.torque = 50.0});
  m.add<Brake>("brake_a", {"a"}, {.torque = 5.0});
  m.add<Brake>("brake_b", {"b"}, {.torque = 5.0});
  m.add<AppliedTorque>("load", {"a"}, {.harmonics = {{30.0, 4.0, 0.3}}});
  const FrictionRun r = ran_to(m.build(), 1.0);
  CHECK(r.summary.friction_changes == 0);
  CHECK(r.summary.steps < 20 * 30);
}

TEST_CASE("Friction: a stuck clutch costs no more than the shaft that it could be") {
  Model m = two_inertias(0.3, 1.0, 0.7, 1.0);
  m.add<GroundSpring>("spring", {"b"}, {.stiffness = 300.0});
  Model rigid = m;
  m.add<Clutch>("clutch", {"a", "b"}, {.torque = 1e6});
  rigid.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 300.0});
  const FrictionRun stuck = ran_to(m.build(), 5.0), shaft = ran_to(rigid.build(), 5.0);
  CHECK(stuck.summary.friction_changes == 0);
  CHECK(stuck.summary.steps <= shaft.summary.steps);
  CHECK(stuck.summary.solves <= shaft.summary.solves);
  const double omega = std::sqrt(300.0);
  CHECK(stuck.state.z[1] == Approx(std::sin(5.0 * omega) / omega).epsilon(1e-12));
}

TEST_CASE("Friction: contacts side by side that hold nothing at the start let go, either way") {
  // Both bounds of each meet at zero: by their torque, by their engagement, or by both.
  const Brake::Params none{.torque = 0.0}, viscous{.slip_speeds = {0.0, 9.0}, .sliding_torques = {0.0, 9.0}};
  const Brake::Params ramp{.torque = 0.0, .engagement = TimeTable({0.0, 1.0}, {0.0, 1.0})};
  const Brake::Params weak{
      .torque = 0.1, .break_away_ratio = 2.0, .engagement = TimeTable({0.0, 1.0}, {0.0, 1.0})};
  const auto angle = [](const Brake::Params& first, const Brake::Params& second, double load) {
    Model m("brakes");
    m.add_node("n");
    m.add<Inertia>("J", {"n"}, {.inertia = 1.0});
    m.add<Brake>("first", {"n"}, first);
    m.add<Brake>("second", {"n"}, second);
    m.add<AppliedTorque>("load", {"n"}, {.table = TimeTable({0.0, 1.0}, {0.0, load})});
    return ran_to(m.build(), 1.0).state.z[0];
  };
  for (const double load : {1.0, -1.0}) {
    CHECK(angle(none, ramp, load) == Approx(load / 6.0).epsilon(1e-12));
    CHECK(angle(ramp, none, load) == Approx(load / 6.0).epsilon(1e-12));
    CHECK(angle(none, weak, load) == Approx(0.9 * load / 6.0).epsilon(1e-12));
    // v' = t - 2 v
    const double damped = 0.125 * (1.0 - std::exp(-2.0));
    CHECK(angle(viscous, viscous, load) == Approx(load * damped).epsilon(1e-12));
  }
}

TEST_CASE(
    "Friction: a torque that touches the break-away torque and falls lets nothing go, at the start as "
    "later") {
  for (const double phase : {0.0, -0.5 * kPi}) {
    Model m("held");
    m.add_node("n");
    m.add<Inertia>("J", {"n"}, {.inertia = 1.0});
    m.add<Brake>("brake", {"n"}, {.torque = 10.0, .break_away_ratio = 2.0});
    m.add<AppliedTorque>("load", {"n"}, {.harmonics = {{0.5, 20.0, phase}}});
    CHECK(ran_to(m.build(), 0.9).state.z[0] == 0.0);
  }
}

TEST_CASE("Friction: methods that cannot take it say so, and speeds that a freewheel forbids are refused") {
  Model m = two_inertias(1.0, 1.0, 1.0, 0.0);
  m.add<Freewheel>("freewheel", {"a", "b"}, {});
  const System system = m.build();
  CHECK_THROWS_WITH(propagate(system, {.t_end = 1.0}),
                    Catch::Contains("turns in the direction that it locks"));
  CHECK_THROWS_WITH(simulate(system, {.step = 1e-3, .t_end = 1.0}), Catch::Contains("sticks and slips"));
  CHECK(choose_method(system, 1.0, 1e-3).method.exact());
  CHECK_THROWS_WITH(StaticSolver(system),
                    Catch::Contains("does not take dry friction") && Catch::Contains("start = \"rest\""));
}

TEST_CASE(
    "A clutch that carries nothing does not break away, whatever its ratio: a freewheel beside it goes on") {
  Model m("idle clutch");
  for (const char* node : {"a", "b", "c"}) {
    m.add_node(node);
    m.add<Inertia>(std::string("J ") + node, {node}, {.inertia = 1.0});
  }
  m.add<Freewheel>("freewheel", {"a", "b"}, {});
  const TimeTable from_1({1.0, 1.0}, {0.0, 1.0});
  m.add<Clutch>("clutch", {"b", "c"}, {.torque = 0.0, .break_away_ratio = 1.5, .engagement = from_1});
  m.add<Brake>("brake", {"a"}, {.torque = 2.0, .engagement = from_1});
  m.add<AppliedTorque>("load", {"b"}, {.harmonics = {{.order = 1.0, .amplitude = 1.0, .phase = -kPi / 2}}});
  const System system = m.build();
  const FrictionRun r = test::ran_to(system, 1.5);
  // b alone: v = (1 - cos 2 pi t)/(2 pi), at rest at each whole second.
  CHECK(r.state.v[system.node_map(system.node("b")).unknown] == Approx(1.0 / kPi).epsilon(1e-12));
}

TEST_CASE("Friction: a run in parts, whose train has come to rest, ends as the whole one") {
  Model m = two_inertias(1.0, 5.0, 2.0, 0.0);
  m.add_node("wall");
  m.hold("wall");
  m.add<Clutch>("clutch", {"a", "b"}, {.torque = 8.0});
  m.add<ShaftSpring>("spring", {"b", "wall"}, {.stiffness = 20.0});
  m.add<Freewheel>("freewheel", {"a"}, {});
  const System system = m.build();
  const FrictionRun whole = ran_to(system, 5.0);
  for (const int parts : {20, 50, 100}) {
    State state = State::initial(system);
    for (int i = 0; i < parts; ++i)
      REQUIRE_NOTHROW(propagate(system, {.t_start = 5.0 * i / parts, .t_end = 5.0 * (i + 1) / parts}, state));
    CHECK(state.z[0] == Approx(whole.state.z[0]).epsilon(1e-9));
  }
}
