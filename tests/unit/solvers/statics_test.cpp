// Static equilibrium with contact.
#include <drev/core/channel.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/statics.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Twist of a held shaft under an end torque: tau/k per section") {
  Model m("cantilever");
  for (const char* n : {"a", "b", "c"}) m.add_node(n);
  m.add<Inertia>("Jb", {"b"}, {.inertia = 1.0});
  m.add<Inertia>("Jc", {"c"}, {.inertia = 1.0});
  m.add<ShaftSpring>("ab", {"a", "b"}, {.stiffness = 1e6});
  m.add<ShaftSpring>("bc", {"b", "c"}, {.stiffness = 4e6});
  m.add<AppliedTorque>("load", {"c"}, {.torque = [](double) { return 1000.0; }});
  m.hold("a");
  const System system = m.build();
  StaticSolver solver(system);
  const StaticResult r = solver.solve();
  const auto value = [&](const char* channel) {
    return find_channel(system, channel).evaluate(solver.assembler(), r.state);
  };
  CHECK(value("c.angle_rad") == Approx(1e-3 + 2.5e-4).epsilon(1e-12));
  CHECK(value("ab.torque_Nm") == Approx(1000.0).epsilon(1e-12));
  CHECK(value("a.reaction_Nm") == Approx(-1000.0).epsilon(1e-12));
}

TEST_CASE("Static equilibrium closes the gap on the flank that the load asks for") {
  // crank held, mesh ratio 2: the force on the line of action is tau/r, the gap half the backlash.
  for (const double tau : {500.0, -500.0}) {
    Model m("geared");
    m.add_node("held");
    m.add_node("wheel");
    m.add<Inertia>("J1", {"held"}, {.inertia = 1.0});
    m.add<Inertia>("J2", {"wheel"}, {.inertia = 2.0});
    m.add<GearMesh>("mesh", {"held", "wheel"},
                    {.base_radius_1 = 0.1, .base_radius_2 = 0.2, .stiffness = 1e8, .normal_backlash = 1e-4});
    m.add<AppliedTorque>("load", {"wheel"}, {.torque = [tau](double) { return tau; }});
    m.hold("held");
    const System system = m.build();
    StaticSolver solver(system);
    const StaticResult r = solver.solve();
    const double sign = tau > 0 ? 1.0 : -1.0;
    // x = r_2 q_2; r_2 k (x - b) = tau.
    CHECK(r.state.z[0] == Approx((sign * 5e-5 + tau / 0.2 / 1e8) / 0.2).epsilon(1e-9));
    CHECK(find_channel(system, "mesh.force_N").evaluate(solver.assembler(), r.state) ==
          Approx(tau / 0.2).epsilon(1e-9));
  }
}

TEST_CASE("A free-free static solve is refused, with the floating parts named") {
  for (const int n : {10, 50, 200, 2000}) {
    Model m("free");
    for (int i = 0; i < n; ++i) {
      const std::string node = "n" + std::to_string(i);
      m.add_node(node);
      m.add<Inertia>("J" + std::to_string(i), {node}, {.inertia = 0.5});
      if (i > 0)
        m.add<ShaftSpring>("k" + std::to_string(i), {"n" + std::to_string(i - 1), node},
                           {.stiffness = 1000.0});
    }
    m.add<AppliedTorque>("load", {"n0"}, {.torque = [](double) { return 1.0; }});
    const System system = m.build();
    CHECK(system.rigid_mode_count(Contact::closed) == 1);
    try {
      solve_static(system);
      FAIL("a free-free model has no static equilibrium");
    } catch (const SolverError& e) {
      CHECK(std::string(e.what()).find("float") != std::string::npos);
      CHECK(std::string(e.what()).find("n0") != std::string::npos);
    }
  }
}

TEST_CASE("A load inside a free gap rests on the flank, without a load anything in the gap is in balance") {
  Model m("gap");
  m.add_node("m");
  m.add<Inertia>("J", {"m"}, {.inertia = 1.0});
  m.add<PolylineSpring>("stop", {"m"}, PolylineSpring::dead_band(1e6, 0.01));
  const System unloaded = m.build();
  CHECK(std::abs(solve_static(unloaded).state.z[0]) <= 0.01);
  m.add<AppliedTorque>("load", {"m"}, {.torque = [](double) { return -100.0; }});
  const System loaded = m.build();
  CHECK(solve_static(loaded).state.z[0] == Approx(-0.01 - 1e-4).epsilon(1e-9));
}

TEST_CASE("Sweep over a revolution: the load follows the nominal angle") {
  // tau = 10 cos(2 theta) on a shaft of k = 1000: largest 10, at 0; least -10, at pi/2.
  Model m("sweep");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("J", {"b"}, {.inertia = 1.0});
  m.add<ShaftSpring>("s", {"a", "b"}, {.stiffness = 1000.0});
  m.add<EngineOrderTorque>("tau", {"b"}, {.harmonics = {{2.0, 10.0, 0.0}}, .twist_feedback = false});
  m.constant_speed("a", 10.0);
  const System system = m.build();
  const auto peaks = static_sweep(system, {find_channel(system, "s.torque_Nm")}, 0.0, kTwoPi, 360);
  CHECK(peaks[0].max == Approx(10.0).epsilon(1e-9));
  CHECK(peaks[0].min == Approx(-10.0).epsilon(1e-9));
  CHECK(peaks[0].min_time == Approx(kPi / 2).epsilon(1e-9));
  CHECK_THROWS_AS(static_sweep(system, {}, 0.0, NAN, 0), ModelError);
}
