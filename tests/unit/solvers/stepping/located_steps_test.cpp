// Contact changes located by stepping methods: order, forces that jump, several changes in a step, grazing.
// Covers solvers/stepping/contact_locator.hpp and located_step.hpp through simulate().
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"
#include "tests/problems/twist_backlash.hpp"
#include "tests/published/read_csv.hpp"

using namespace drev;

namespace {

System case_b() {
  Parameters s("two_mass_backlash", two_mass_backlash_entry().parameters);
  s.set("k_1_N_per_m", "2000");
  s.set("k_2_N_per_m", "1000");
  s.set("half_gap_1_m", "0.05");
  s.set("half_gap_2_m", "0.03");
  return two_mass_backlash_entry().build(s).model.build();
}

/// A mass of 1 kg between stops of stiffness k behind gaps of +-half_gap.
Model between_stops(double k, double half_gap, double damping, MeshDamping law) {
  Model m("stops");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<LawElement<TwistBacklash>>(
      "stop", {"m"},
      TwistBacklash{BacklashLaw({.normal_backlash = 2 * half_gap, .damping = damping, .damping_law = law}),
                    k});
  return m;
}

}  // namespace

TEST_CASE("Located contact changes give every method its order, case B to 5 s with 32 changes") {
  // Exact curve: piecewise matrix exponentials in extended precision (published/data).
  const System system = case_b();
  Vector exact(2);
  for (const auto& row : read_csv("case_B_100N.csv"))
    if (std::stod(row[0]) == 5.0) exact << std::stod(row[1]), std::stod(row[2]);
  long changes = 0;
  for (const auto& row : read_csv("case_B_100N_events.csv")) changes += std::stod(row[0]) < 5.0;
  const auto error = [&](const char* method, double h, bool locate) {
    State s = State::initial(system);
    const RunSummary run = simulate(
        system, {.scheme = step_scheme(method), .step = h, .locate_contacts = locate, .t_end = 5.0}, s);
    CHECK(run.ok());
    CHECK(run.located == (locate ? changes : 0));
    return (s.z - exact).lpNorm<Eigen::Infinity>();
  };
  struct Expected {
    const char* method;
    double order, margin;
  };
  for (const Expected& e :
       {Expected{"average_acceleration", 2, 0.05}, Expected{"generalized_alpha:0.8", 2, 0.05},
        Expected{"bathe:0.8", 2, 0.05}, Expected{"tr_bdf2", 2, 0.05}, Expected{"sdirk4", 4, 0.05},
        Expected{"rk4", 4, 0.1}, Expected{"dormand_prince", 5, 0.3}}) {
    const double coarse = error(e.method, 4e-3, true), fine = error(e.method, 2e-3, true);
    INFO(e.method << ": " << coarse << ", " << fine);
    CHECK(std::log2(coarse / fine) == Approx(e.order).margin(e.margin));
    // Without, the methods of high order lose more than two digits; those of second order nothing.
    const double without = error(e.method, 2e-3, false);
    if (e.order > 2)
      CHECK(without > 100 * fine);
    else
      CHECK(without < 1.5 * fine);
  }
}

TEST_CASE("A contact damper that jumps: located changes take the error from order 1 to the method's") {
  // Against a stop of k = 1e4, c = 20 at x = 0.01, at 1 m/s. In contact p = e^(-d t)/w sin w t, d = 10,
  // w^2 = 9900, until the damper would pull, k p + c p' = 0; from there constant speed.
  Model m = between_stops(1e4, 0.01, 20.0, MeshDamping::contact_only);
  m.set_initial("m", 0.0, 1.0);
  const System system = m.build();
  const double w = std::sqrt(9900.0), d = 10.0;
  const double t_1 = (kPi - std::atan(20.0 * w / (1e4 - 20.0 * d))) / w;
  const double exit_speed = std::exp(-d * t_1) * (std::cos(w * t_1) - d / w * std::sin(w * t_1));
  const auto error = [&](const char* method, double h, bool locate) {
    State s = State::initial(system);
    const RunSummary run = simulate(system,
                                    {.scheme = step_scheme(method),
                                     .step = h,
                                     .locate_contacts = locate,
                                     .t_end = 0.045,
                                     .energy_tolerance = 1},
                                    s);
    CHECK(run.ok());
    if (locate) {
      CHECK(run.located == 3);
      CHECK(run.fallbacks == 0);
    }
    return std::abs(s.v[0] - exit_speed);
  };
  for (const auto& [method, order] : {std::pair("average_acceleration", 2), std::pair("tr_bdf2", 2),
                                      std::pair("sdirk4", 4), std::pair("rk4", 4)}) {
    // Within the step the place varies, without location: the envelope over a few. Jump c v = 20 N over half
    // a step: 10 h.
    double without = 0.0;
    for (const double h : {2.9e-4, 2.3e-4, 2e-4, 1.3e-4})
      without = std::max(without, error(method, h, false) / h);
    CHECK(without > 2.0);
    const double coarse = error(method, 8e-4, true), fine = error(method, 4e-4, true);
    INFO(method << ": " << coarse << ", " << fine);
    CHECK(std::log2(coarse / fine) == Approx(order).margin(0.2));
  }
}

TEST_CASE("Where a contact damper is limited or lets go, located steps keep their order") {
  // Rebounds between two flanks; the truth is exact propagation, verified against closed forms of its own.
  for (const MeshDamping law : {MeshDamping::limited, MeshDamping::contact_only, MeshDamping::proportional}) {
    Model m("rebounds");
    m.add_node("gear");
    m.add_node("held");
    m.add<Inertia>("J", {"gear"}, {.inertia = 1.0});
    m.add<GearMesh>("mesh", {"gear", "held"},
                    {.base_radius_1 = 1.0,
                     .base_radius_2 = 1.0,
                     .stiffness = 1e4,
                     .normal_backlash = 0.02,
                     .damping = 60.0,
                     .damping_law = law,
                     .reference_penetration = 2e-3});
    m.constant_speed("held", 0.0);
    m.set_initial("gear", 0.0, 1.0);
    const System system = m.build();
    State exact = State::initial(system);
    const RunSummary truth = propagate(system, {.tolerance = 1e-13, .t_end = 0.2}, exact);
    CHECK(truth.ok());
    const auto error = [&](const char* method, double h) {
      State s = State::initial(system);
      const RunSummary run = simulate(
          system, {.scheme = step_scheme(method), .step = h, .locate_contacts = true, .t_end = 0.2}, s);
      CHECK(run.ok());
      if (law != MeshDamping::proportional) CHECK(run.located == truth.contact_changes);
      return (s.v - exact.v).lpNorm<Eigen::Infinity>();
    };
    for (const auto& [method, order] : {std::pair("sdirk4", 3.8), std::pair("dormand_prince", 4.7)}) {
      const double coarse = error(method, 5e-4), fine = error(method, 2.5e-4);
      INFO(method << ", law " << static_cast<int>(law) << ": " << coarse << ", " << fine);
      CHECK(std::log2(coarse / fine) > order);
    }
  }
}

TEST_CASE("A step that a jump leaves without a solution is taken inside the jump, and said") {
  // The edge lies 1e-11 m before the end of a step: down to h/16 no force satisfies the step.
  const double h = 4e-4;
  Model m = between_stops(1e4, 0.01, 20.0, MeshDamping::contact_only);
  m.set_initial("m", 0.01 - 10 * h + 1e-11, 1.0);
  const System system = m.build();
  const TransientOptions options{
      .scheme = step_scheme("tr_bdf2"), .step = h, .t_end = 0.04, .max_halvings = 4};
  const RunSummary run = simulate(system, options);
  CHECK(run.ok());
  CHECK(run.fallbacks == 1);
  CHECK(run.halved == 4);
  CHECK(run.brief_report().find("1 steps with a force inside its jump") != std::string::npos);
  TransientOptions located = options;
  located.locate_contacts = true;
  CHECK(simulate(system, located).fallbacks == 0);
}

TEST_CASE("Two changes inside one step are both located") {
  Model m = between_stops(4e4, 0.01, 0.0, MeshDamping::limited);
  m.add<GroundSpring>("spring", {"m"}, {.stiffness = 1e4});
  m.set_initial("m", 0.0, 1.0001);
  const System system = m.build();
  // x = 0.010001 sin 100 t without the stop; past its edge for 2.8e-4 s of a step of 1.25e-3 s, and at
  // neither end of one.
  for (const char* method : {"sdirk4", "average_acceleration"}) {
    ContactStatistics contacts(system);
    const RunSummary run = simulate(system,
                                    {.scheme = step_scheme(method),
                                     .step = 1.25e-3,
                                     .locate_contacts = true,
                                     .t_end = 0.03,
                                     .energy_tolerance = 1},
                                    {&contacts});
    INFO(method);
    CHECK(run.located == 2);
    CHECK(contacts.records()[0].front_impacts == 1);
  }
}

TEST_CASE("Grazing and resting on an edge end the run in time") {
  // Reaches the edge with speed 0; and lies on it, pressed by a load.
  for (const bool pressed : {false, true}) {
    Model m = between_stops(1e4, 0.01, pressed ? 20.0 : 0.0,
                            pressed ? MeshDamping::contact_only : MeshDamping::limited);
    if (!pressed) m.add<GroundSpring>("spring", {"m"}, {.stiffness = 1e4});
    m.add<AppliedTorque>("load", {"m"}, {.torque = [=](double) { return pressed ? 1.0 : 0.0; }});
    m.set_initial("m", pressed ? 0.01 : 0.0, pressed ? 0.0 : 1.0);
    const System system = m.build();
    for (const char* method : {"average_acceleration", "sdirk4", "rk4"}) {
      for (const double tolerance : {0.0, 1e-4}) {
        INFO(method << ", tolerance " << tolerance << ", pressed " << pressed);
        const RunSummary run = simulate(system, {.scheme = step_scheme(method),
                                                 .step = 1e-3,
                                                 .tolerance = tolerance,
                                                 .locate_contacts = true,
                                                 .t_end = 0.5,
                                                 .energy_tolerance = 0.05});
        CHECK(run.ok());
        CHECK(run.steps < 20000);
      }
    }
  }
}

TEST_CASE("A mesh stiffness that steps with the angle: controlled steps end at its jumps") {
  // x'' + k(t) x = 1 at w = 1: k = 1.2 for the first 0.6 of each turn, then 0.8. Over the parts x is
  // 1/k + A cos + B sin, matched at the jumps.
  problems::DrivenGear gear;
  gear.stiffness = MeshStiffness::step(0.8, 1.2, 1.6);
  gear.mean = 1.0;
  const System system = gear.build();
  const int turns = 20;
  double x = 0.0, v = 0.0;
  for (int i = 0; i < turns; ++i)
    for (const auto& [k, part] : {std::pair(1.2, 0.6), std::pair(0.8, 0.4)}) {
      const double w = std::sqrt(k), t = part * kTwoPi, a = x - 1.0 / k, b = v / w;
      x = 1.0 / k + a * std::cos(w * t) + b * std::sin(w * t);
      v = w * (b * std::cos(w * t) - a * std::sin(w * t));
    }
  for (const char* method : {"dormand_prince", "sdirk4"}) {
    INFO(method);
    State s = State::initial(system);
    const RunSummary run =
        simulate(system, {.scheme = step_scheme(method), .tolerance = 1e-7, .t_end = turns * kTwoPi}, s);
    INFO(run.brief_report());
    CHECK(run.ok());
    CHECK(run.located >= 2 * turns - 1);
    CHECK(run.located <= 2 * turns);
    CHECK(run.forced <= 1);  // the last jump is at the end itself
    CHECK(std::abs(s.z[0] - x) < 1e-5 * std::max(1.0, std::abs(x)));
  }
}

TEST_CASE("A start at rest on a jump of the mesh stiffness is led to the side it leaves to") {
  // Two gears of 1 kg m^2, pressed by 1 m: x'' = -2 k x. The phase turns back from the knot at 0 to -0.16 and
  // has k = 0.8 there, x = cos w t with w^2 = 1.6; at the knot itself k is 1.2.
  Model m("pressed gears");
  for (const char* gear : {"pinion", "wheel"}) {
    m.add_node(gear);
    m.add<Inertia>(std::string("J ") + gear, {gear}, {.inertia = 1.0});
  }
  m.add<GearMesh>("mesh", {"pinion", "wheel"},
                  {.base_radius_1 = 1.0,
                   .base_radius_2 = 1.0,
                   .teeth_1 = 1,
                   .teeth_2 = 1,
                   .stiffness = MeshStiffness::step(0.8, 1.2, 1.6)});
  m.set_initial("wheel", 1.0, 0.0);
  const System system = m.build();
  for (const char* method : {"average_acceleration", "generalized_alpha:0.8", "sdirk4", "dormand_prince"}) {
    State s = State::initial(system);
    const RunSummary run =
        simulate(system, {.scheme = step_scheme(method), .tolerance = 1e-5, .t_end = 4.0}, s);
    INFO(run.brief_report());
    CHECK(run.ok());
    CHECK(run.located == 1);
    CHECK(run.forced == 0);
    CHECK(std::abs(s.z.sum() - std::cos(std::sqrt(1.6) * 4.0)) < 1e-5);
  }
}
