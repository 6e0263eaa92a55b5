// DeadBandCoupling: its law, and the Modelica Standard Library's Backlash example (ElastoBacklash).
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

TEST_CASE("Dead-band coupling: play, and a damper between nothing and the spring's force") {
  const DeadBandCoupling coupling({.stiffness = 1e4, .gap = 0.02, .damping = 50.0});
  CHECK(check_element(coupling, 2).failures == std::vector<std::string>{});
  const auto torque = [&](double x, double rate) { return coupling.evaluate({.x = x, .x_dot = rate}).y; };
  CHECK(torque(0.0099, 3.0) == 0.0);
  CHECK(torque(0.015, 0.0) == Approx(50.0));
  CHECK(torque(0.015, 0.4) == Approx(70.0));
  CHECK(torque(0.015, 9.0) == Approx(100.0));  // at most twice the spring's
  CHECK(torque(0.015, -9.0) == 0.0);           // never pulls
  CHECK(torque(-0.015, -0.4) == Approx(-70.0));
  for (const MeshDamping law : {MeshDamping::proportional, MeshDamping::contact_only, MeshDamping::always})
    CHECK(check_element(
              DeadBandCoupling({.stiffness = 1e4, .gap = 0.02, .damping = 50.0, .damping_law = law}), 1)
              .failures == std::vector<std::string>{});
  const std::string text =
      test::findings(DeadBandCoupling({.gap = -1.0, .damping = -2.0, .reference_penetration = 0.0}));
  for (const char* part : {"stiffness", "gap", "damping", "reference_penetration"})
    CHECK(test::contains(text, part));
}

TEST_CASE("Dead-band coupling: a disc between two stops (Modelica Standard Library, Backlash)") {
  Model m("backlash");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = 5.0});
  m.add<DeadBandCoupling>("stop", {"disc"},
                          {.stiffness = 2e4, .gap = std::acos(-1.0) / 4.0, .damping = 50.0});
  m.set_initial("disc", std::acos(-1.0) / 2.0, 0.0);
  const System system = m.build();
  for (const auto& [t, angle, speed] : {std::tuple{0.1, 0.2498358550, 52.8937186},
                                        {0.25, 0.5808155699, 30.0804578},
                                        {0.5, -0.3099580355, -17.2284257},
                                        {1.0, -0.1555814136, -7.0229373}}) {
    State state = State::initial(system);
    CHECK(propagate(system, {.tolerance = 1e-12, .t_end = t, .energy_tolerance = 1e-9}, state).ok());
    CHECK(state.z[0] == Approx(angle).epsilon(2e-9));
    CHECK(state.v[0] == Approx(speed).epsilon(5e-9));
  }
}

TEST_CASE("Dead-band coupling between two shafts: exact propagation and steps agree, by every law") {
  for (const MeshDamping law : {MeshDamping::proportional, MeshDamping::limited, MeshDamping::always}) {
    Model m("spline");
    m.add_node("a"), m.add_node("b");
    m.add<Inertia>("J_a", {"a"}, {.inertia = 0.2});
    m.add<Inertia>("J_b", {"b"}, {.inertia = 0.5});
    m.add<DeadBandCoupling>("spline", {"a", "b"},
                            {.stiffness = 3e4, .gap = 0.01, .damping = 4.0, .damping_law = law});
    m.add<AppliedTorque>("swing", {"a"}, {.harmonics = {{7.0, 40.0, 0.3}}});
    m.set_initial("a", 0.0, 1.0);
    m.set_reference("a", constant_speed(100.0));
    const System system = m.build();
    CHECK(system.ratio(system.node("b")) == Approx(1.0));
    State exact = State::initial(system), stepped = exact;
    const RunSummary run = propagate(system, {.tolerance = 1e-11, .t_end = 0.15}, exact);
    CHECK(run.ok());
    CHECK(run.contact_changes > 2);
    CHECK(run_method(system, {.step = 2e-7}, {.t_end = 0.15}, stepped).ok());
    for (const Eigen::Index i : {0, 1}) CHECK(exact.v[i] == Approx(stepped.v[i]).epsilon(1e-4));
  }
}
