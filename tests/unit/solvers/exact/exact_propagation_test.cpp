// Exact propagation: closed forms, breakpoints, known motions, dampers, refusals, laws without a
// solution.
// Covers solvers/series/taylor_series.hpp, series_kernels.hpp, load_series.hpp and law_series.hpp through
// propagate().
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/twist_backlash.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;

TEST_CASE("Exact propagation: damped free vibration in closed form to 1e-13") {
  Model m = unit_oscillator();
  const double c = 0.8, d = 0.5 * c, w = std::sqrt(4 * kPi * kPi - d * d);
  m.add<Dashpot>("damper", {"m"}, {.damping = c});
  m.set_initial("m", 1.0, -0.5);
  const System system = m.build();
  Recorder r(system, {"m.position_m", "m.velocity_m_per_s", "m.acceleration_m_per_s2"}, 0.1);
  const RunSummary run =
      propagate(system, {.tolerance = 1e-15, .t_end = 10.0, .energy_tolerance = 1e-13}, {&r});
  INFO(run.brief_report());
  CHECK(run.ok());
  REQUIRE(r.times().size() == 101);
  const double b = (-0.5 + d) / w;
  for (std::size_t i = 0; i < r.times().size(); ++i) {
    const double t = 0.1 * static_cast<double>(i), e = std::exp(-d * t);
    CHECK(r.times()[i] == Approx(t).epsilon(1e-15));
    const double u = e * (std::cos(w * t) + b * std::sin(w * t));
    const double v = e * (w * (b * std::cos(w * t) - std::sin(w * t))) - d * u;
    CHECK(std::abs(r.samples(0)[i] - u) < 1e-13);
    CHECK(std::abs(r.samples(1)[i] - v) < 1e-13 * kTwoPi);
    CHECK(std::abs(r.samples(2)[i] + c * v + 4 * kPi * kPi * u) < 1e-12 * 4 * kPi * kPi);
  }
}

TEST_CASE("Exact propagation: a table's ramp and release, breakpoints hit, to rounding") {
  // Ramp of k t over 1 s: u = t - sin(2 pi t)/(2 pi), at rest with u = 1 at t = 1; released at 1.3
  // s.
  Model m = unit_oscillator();
  const double k = 4 * kPi * kPi;
  m.add<AppliedTorque>("load", {"m"}, {.table = TimeTable({0.0, 1.0, 1.3, 1.3}, {0.0, k, k, 0.0})});
  const System system = m.build();
  State state = State::initial(system);
  CHECK(propagate(system, {.tolerance = 1e-15, .t_end = 0.6}, state).ok());
  CHECK(state.z[0] == Approx(0.6 - std::sin(kTwoPi * 0.6) / kTwoPi).epsilon(1e-14));
  state = State::initial(system);
  const RunSummary run = propagate(system, {.tolerance = 1e-15, .t_end = 2.25}, state);
  CHECK(run.ok());
  CHECK(state.z[0] == Approx(std::cos(kTwoPi * 0.95)).epsilon(1e-13));
  CHECK(std::abs(run.energy.relative_error()) < 1e-14);
}

TEST_CASE("Exact propagation: prescribed motion with constant acceleration, and what it puts in") {
  // Base follows u = t^2/2 from rest: x - u = -(1 - cos w t)/w^2.
  for (const bool through_law : {false, true}) {
    Model m("base");
    m.add_node("base");
    m.add_node("disc");
    m.add<Inertia>("J", {"disc"}, {.inertia = 1.0});
    if (through_law)
      m.add<PolylineSpring>("spring", {"base", "disc"}, PolylineSpring::dead_band(9.0, 0.0));
    else
      m.add<ShaftSpring>("spring", {"base", "disc"}, {.stiffness = 9.0});
    m.given_motion("base", {[](double t) { return MotionPoint{0.5 * t * t, t, 1.0}; }, {}, true});
    const System system = m.build();
    State state = State::initial(system);
    const RunSummary run =
        propagate(system, {.tolerance = 1e-14, .t_end = 4.0, .energy_tolerance = 1e-12}, state);
    INFO(through_law << " " << run.brief_report());
    CHECK(run.ok());
    CHECK(state.z[0] == Approx(8.0 - (1.0 - std::cos(12.0)) / 9.0).epsilon(1e-13));
  }
}

TEST_CASE("Exact propagation: engine orders over a run-up, against small steps") {
  Model m("engine");
  m.add_node("engine");
  m.add_node("load");
  m.add<Inertia>("J_1", {"engine"}, {.inertia = 0.2});
  m.add<Inertia>("J_2", {"load"}, {.inertia = 0.5});
  m.add<ShaftSpring>("shaft", {"engine", "load"}, {.stiffness = 5e3});
  m.add<Dashpot>("damper", {"engine", "load"}, {.damping = 0.8});
  m.add<Dashpot>("drag", {"load"}, {.damping = 0.05});
  m.add<EngineOrderTorque>("gas", {"engine"},
                           {.harmonics = {{2.0, 40.0, 0.3}, {4.0, 15.0, -1.0}}, .mean = 3.0});
  m.set_reference("engine", run_up(40.0, 160.0, 0.1, 0.9));
  const System system = m.build();
  State exact = State::initial(system), fine = exact, coarse = exact;
  const RunSummary run = propagate(system, {.t_end = 1.0, .energy_tolerance = 1e-11}, exact);
  INFO(run.brief_report());
  CHECK(run.ok());
  CHECK(simulate(system, {.step = 1e-4, .t_end = 1.0}, coarse).ok());
  CHECK(simulate(system, {.step = 5e-5, .t_end = 1.0}, fine).ok());
  // Average acceleration is of second order: extrapolated, of fourth.
  const Vector limit = fine.z + (fine.z - coarse.z) / 3.0;
  CHECK((exact.z - limit).lpNorm<Eigen::Infinity>() < 1e-6 * exact.z.lpNorm<Eigen::Infinity>());
}

TEST_CASE("Exact propagation: a mass matrix that is not diagonal") {
  Model m("distributed");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("J", {"b"}, {.inertia = 2.0});
  m.add<DistributedShaft>(
      "shaft", {"a", "b"},
      {.shear_modulus = 8e10, .density = 7850.0, .outer_diameter = 0.1, .length = 3.0, .segments = 6});
  m.add<PolylineSpring>("stop", {"b"}, PolylineSpring::dead_band(1e5, 1e-3));
  m.hold("a");
  m.set_initial("b", 5e-3, 0.0);
  const System system = m.build();
  REQUIRE(!system.mass_is_diagonal());
  State exact = State::initial(system), fine = exact, coarse = exact;
  const RunSummary run = propagate(system, {.t_end = 0.02, .energy_tolerance = 1e-11}, exact);
  INFO(run.brief_report());
  CHECK(run.ok());
  CHECK(run.contact_changes > 0);
  CHECK(simulate(system, {.step = 2e-7, .t_end = 0.02}, coarse).ok());
  CHECK(simulate(system, {.step = 1e-7, .t_end = 0.02}, fine).ok());
  const Vector limit = fine.z + (fine.z - coarse.z) / 3.0;
  CHECK((exact.z - limit).lpNorm<Eigen::Infinity>() < 1e-5 * exact.z.lpNorm<Eigen::Infinity>());
}

TEST_CASE("Exact propagation: at rest on the gap's edge, pushed in, pulled off, and left alone") {
  for (const double force : {1.0, -1.0, 0.0}) {
    Model m("edge");
    m.add_node("m", NodeKind::translational);
    m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
    m.add<PolylineSpring>("stop", {"m"}, PolylineSpring::dead_band(100.0, 0.3));
    m.add<AppliedTorque>("load", {"m"}, {.table = TimeTable({0.0}, {force})});
    m.set_initial("m", 0.3, 0.0);
    const System system = m.build();
    State state = State::initial(system);
    const double t = 0.5;
    CHECK(propagate(system, {.tolerance = 1e-15, .t_end = t}, state).ok());
    const double pushed = 0.3 + 0.01 * (1.0 - std::cos(10.0 * t)), pulled = 0.3 - 0.5 * t * t;
    CHECK(state.z[0] == Approx(force > 0 ? pushed : force < 0 ? pulled : 0.3).epsilon(1e-13));
  }
}

TEST_CASE("Exact propagation: two masses hit their stops at one instant") {
  Model m("twins");
  for (const char* n : {"a", "b"}) {
    m.add_node(n, NodeKind::translational);
    m.add<Inertia>(std::string("m_") + n, {n}, {.inertia = 2.0});
    m.add<PolylineSpring>(std::string("stop_") + n, {n}, PolylineSpring::dead_band(800.0, 0.1));
    m.set_initial(n, 0.0, 1.0);
  }
  const System system = m.build();
  State state = State::initial(system);
  const double period = 0.4 + kTwoPi / 20.0;
  const RunSummary run = propagate(system, {.tolerance = 1e-15, .t_end = 7 * period}, state);
  CHECK(run.ok());
  CHECK(run.contact_changes == 2 * 4 * 7);
  CHECK(std::abs(state.z[0]) < 1e-13);
  CHECK(state.z[0] == Approx(state.z[1]).margin(1e-15));
}

TEST_CASE("Exact propagation: a law without a solution ends with an error that names it") {
  // A relay that always pushes away from x = 0 to the other side: it would slide there.
  struct Relay {
    std::vector<LawPiece> pieces() const {
      return {{.y_0 = -1.0, .elastic_0 = -1.0, .bounds = {{0.0, -1.0, -1.0, 1}}},
              {.y_0 = 1.0, .elastic_0 = 1.0, .bounds = {{0.0, 1.0, 1.0, 0}}}};
    }
  };
  Model m("relay");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<LawElement<Relay>>("relay", {"m"}, {});
  m.set_initial("m", 0.5, 0.0);
  const System system = m.build();
  CHECK_THROWS_WITH(propagate(system, {.t_end = 5.0}),
                    Catch::Contains("relay") && Catch::Contains("to and fro") && Catch::Contains("at t ="));
}

TEST_CASE("Exact propagation: what cannot be propagated is refused with the reason") {
  const auto refusal = [](const auto& add) {
    Model m("refused");
    m.add_node("a");
    m.add_node("b");
    m.add<Inertia>("J_a", {"a"}, {.inertia = 1.0});
    m.add<Inertia>("J_b", {"b"}, {.inertia = 1.0});
    add(m);
    const System system = m.build();
    const auto why = why_not_exact(system);
    if (why) CHECK_THROWS_AS(propagate(system, {.t_end = 1.0}), ModelError);
    return why.value_or("");
  };
  using Catch::Contains;
  CHECK(refusal([](Model&) {}) == "");
  CHECK_THAT(refusal([&](Model& m) {
               m.given_motion("b", {[](double) { return MotionPoint{}; }, {}});
             }),
             Contains("motion of b"));
  CHECK_THAT(refusal([&](Model& m) {
               m.set_reference("b", {[](double) { return MotionPoint{}; }, {}});
             }),
             Contains("reference"));
  const System system = unit_oscillator().build();
  CHECK_THROWS_AS(propagate(system, {.t_end = -1.0}), ModelError);
  CHECK_THROWS_AS(propagate(system, {.tolerance = 0.0, .t_end = 1.0}), ModelError);
}

TEST_CASE("Exact propagation: a step takes 4 rad of the fastest mode, and 3 rad where forces are projected") {
  const auto steps = [](bool projected) {
    Model m = unit_oscillator();
    m.set_initial("m", 1.0, 0.0);
    if (projected)
      m.add<AppliedTorque>("load", {"m"}, {.torque = [](double t) { return std::sin(0.1 * t); }});
    const RunSummary run = propagate(m.build(), {.tolerance = 1e-8, .t_end = 120.0});
    CHECK(run.ok());
    return static_cast<double>(run.steps);
  };
  CHECK(steps(false) == Approx(std::ceil(120.0 * kTwoPi / 4.0)).epsilon(0.01));
  CHECK(steps(true) == Approx(std::ceil(120.0 * kTwoPi / 3.0)).epsilon(0.01));
}
