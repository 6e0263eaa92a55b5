// Steps controlled by their estimated error: the estimate against the true local error, the tolerance
// against the true error, outputs between steps, stops, energy.
// Covers solvers/stepping/step_control.hpp through simulate().
#include <drev/core/law_element.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <functional>

#include "solvers/stepping/stability_limit.hpp"
#include "solvers/stepping/stepper.hpp"
#include "tests/catch.hpp"
#include "tests/problems/unit_oscillator.hpp"
#include "tests/published/read_csv.hpp"

using namespace drev;

namespace {

/// 10 x, as a law of Python that states no energy: all of its power counts as dissipated.
struct LawWithoutEnergy {
  static constexpr bool varies = true;
  ScalarResponse operator()(const ScalarInput& in) const {
    return {.y = 10.0 * in.x, .dy_dx = 10.0, .dissipated_power = 10.0 * in.x * in.x_dot};
  }
};

}  // namespace

TEST_CASE("The estimate is the true local error on smooth steps") {
  // u = cos 2 pi t from t = 0.1: one step against the closed form. Methods with an embedded formula of lower
  // order estimate that formula's error; there the estimate must be no smaller than the method's own.
  const System system = unit_oscillator().build();
  struct Expected {
    const char* method;
    double h;
    bool own;  // estimates the method's own error
  };
  for (const Expected& e : {Expected{"average_acceleration", 0.008, true}, Expected{"bathe:0.8", 0.008, true},
                            Expected{"tr_bdf2", 0.008, true}, Expected{"rk4", 0.01, true},
                            Expected{"sdirk4", 0.02, false}, Expected{"dormand_prince", 0.03, false}}) {
    INFO(e.method);
    const auto stepper = make_stepper(system, step_scheme(e.method), {});
    EvaluatedState from, to;
    from.state = State::initial(system, 0.1);
    from.state.z[0] = std::cos(kTwoPi * 0.1);
    from.state.v[0] = -kTwoPi * std::sin(kTwoPi * 0.1);
    stepper->start(from);
    const double t = 0.1 + e.h;
    REQUIRE(stepper->step(from, e.h, t, t, to).status == NewtonStatus::converged);
    Vector e_z, e_v;
    stepper->estimate(from, to, e.h, e_z, e_v);
    const double true_z = to.state.z[0] - std::cos(kTwoPi * t);
    const double true_v = to.state.v[0] + kTwoPi * std::sin(kTwoPi * t);
    if (e.own) {
      CHECK(e_z[0] / true_z == Approx(1.0).margin(0.07));
      CHECK(e_v[0] / true_v == Approx(1.0).margin(0.07));
    } else {
      CHECK(std::abs(e_z[0]) > std::abs(true_z));
      CHECK(std::abs(e_v[0]) > std::abs(true_v));
    }
  }
}

TEST_CASE("Controlled steps: the error of case B at 2 s stays below the tolerance and falls with it") {
  // Exact curve in extended precision (published/data); two contact changes up to 2 s.
  Parameters s("two_mass_backlash", two_mass_backlash_entry().parameters);
  s.set("k_1_N_per_m", "2000");
  s.set("k_2_N_per_m", "1000");
  s.set("half_gap_1_m", "0.05");
  s.set("half_gap_2_m", "0.03");
  const System system = two_mass_backlash_entry().build(s).model.build();
  Vector exact(2);
  for (const auto& row : read_csv("case_B_100N.csv"))
    if (std::stod(row[0]) == 2.0) exact << std::stod(row[1]), std::stod(row[2]);
  for (const char* method : {"average_acceleration", "hht:0.1", "generalized_alpha:0.8", "bathe:0.8",
                             "tr_bdf2", "sdirk4", "rk4", "dormand_prince", "central_difference"}) {
    double last = 0.0;
    for (const double tolerance : {1e-3, 1e-4}) {
      State state = State::initial(system);
      const RunSummary run =
          simulate(system, {.scheme = step_scheme(method), .tolerance = tolerance, .t_end = 2.0}, state);
      const double error = (state.z - exact).lpNorm<Eigen::Infinity>() / exact.lpNorm<Eigen::Infinity>();
      INFO(method << ", tolerance " << tolerance << ": " << error << ", " << run.brief_report());
      CHECK(run.ok());
      CHECK(run.located == 2);
      CHECK(run.fallbacks == 0);
      CHECK(error < tolerance);
      CHECK(run.rejected < 20 + run.steps / 50);
      if (last > 0.0) CHECK(error < 0.3 * last);
      last = error;
    }
  }
}

TEST_CASE("Controlled steps: outputs between them have the method's order, stops are hit") {
  Model m = unit_oscillator();
  m.set_initial("m", 1.0, 0.0);
  m.add<AppliedTorque>("none", {"m"}, {.torque = [](double) { return 0.0; }, .breakpoints = {0.3}});
  const System system = m.build();
  for (const char* method : {"generalized_alpha:0.8", "tr_bdf2", "sdirk4", "dormand_prince"}) {
    Recorder r(system, {"m.position_m", "m.velocity_m_per_s"}, 0.0333);
    const RunSummary run =
        simulate(system, {.scheme = step_scheme(method), .tolerance = 1e-5, .t_end = 2.0}, {&r});
    INFO(method << ": " << run.brief_report());
    CHECK(run.ok());
    REQUIRE(r.times().size() == 61);
    for (std::size_t i = 0; i < r.times().size(); ++i) {
      CHECK(r.times()[i] == static_cast<double>(i) * 0.0333);
      CHECK(r.samples(0)[i] == Approx(std::cos(kTwoPi * r.times()[i])).margin(2e-5));
      CHECK(r.samples(1)[i] == Approx(-kTwoPi * std::sin(kTwoPi * r.times()[i])).margin(2e-4));
    }
  }
}

TEST_CASE("Controlled steps: a part 10^4 times as fast that hardly moves does not fix the steps of sdirk4") {
  // A light mass on a stiff spring rides on an oscillator of 1 Hz. Explicit steps would be bounded by it.
  Model m = unit_oscillator();
  m.add_node("light", NodeKind::translational);
  m.add<Inertia>("light mass", {"light"}, {.inertia = 1e-4});
  m.add<ShaftSpring>("stiff", {"m", "light"}, {.stiffness = 4e5, .damping = 0.4});
  m.set_initial("m", 1.0, 0.0);
  m.set_initial("light", 1.0, 0.0);
  const System system = m.build();
  State state = State::initial(system);
  const RunSummary run =
      simulate(system, {.scheme = step_scheme("sdirk4"), .tolerance = 1e-3, .t_end = 2.0}, state);
  INFO(run.brief_report());
  CHECK(run.ok());
  CHECK(state.z[0] == Approx(1.0).margin(3e-3));  // period raised by the light mass, 1 + 5e-5
  CHECK(static_cast<double>(run.steps) < 0.1 * 2.0 / stability_limit(system, step_scheme("rk4")));
}

TEST_CASE("A force that jumps at an unknown time is passed, and said") {
  // A load that jumps without a breakpoint: no step over it is short enough for its share of the tolerance.
  Model m = unit_oscillator();
  m.add<AppliedTorque>("load", {"m"}, {.torque = [](double t) { return t < 0.37 ? 0.0 : 1.0; }});
  const System system = m.build();
  for (const char* method : {"average_acceleration", "tr_bdf2", "rk4", "dormand_prince"}) {
    State state = State::initial(system);
    const RunSummary run =
        simulate(system, {.scheme = step_scheme(method), .tolerance = 1e-4, .t_end = 1.0}, state);
    INFO(method << ": " << run.brief_report());
    CHECK(run.ok());
    CHECK(run.forced >= 1);
    CHECK(run.forced < 20);
    const double static_z = 1.0 / (kTwoPi * kTwoPi);
    CHECK(state.z[0] == Approx(static_z * (1 - std::cos(kTwoPi * 0.63))).margin(1e-3 * static_z));
  }
}

TEST_CASE("A tolerance whose share of a step is below rounding does not end the run") {
  // Average acceleration asks for h = (12 tolerance/(T w^3))^(1/2) = 7e-8 s: a share of 7e-21 of the rate.
  const System system = unit_oscillator().build();
  State state = State::initial(system);
  state.v[0] = 1.0;
  const RunSummary run = simulate(
      system,
      {.tolerance = 1e-11, .t_end = 100.0, .progress = [calls = 0](double) mutable { return ++calls < 20; }},
      state);
  INFO(run.brief_report());
  CHECK(run.status == RunStatus::interrupted);
  CHECK(state.v[0] == Approx(std::cos(kTwoPi * state.t)).epsilon(1e-11));
}

TEST_CASE("Controlled steps: rounding of a stiff spring on a light disc does not hold the steps short") {
  // A torque of 1e-16 of the angle times 2e7 N m/rad turns 1e-6 kg m^2: at steps of 1e-9 s the estimate is rounding. To 1e-5
  // the train is the one without the disc, its two springs in series.
  const auto train = [](bool with_disc) {
    Model m("light disc");
    for (const auto& [node, inertia] : {std::pair("a", 0.5), {"b", 1e-6}, {"c", 0.3}, {"d", 2.0}}) {
      if (!with_disc && *node == 'b') continue;
      m.add_node(node);
      m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = inertia});
    }
    m.set_reference("a", constant_speed(50.0 * kPi));
    if (with_disc) {
      m.add<ShaftSpring>("s1", {"a", "b"}, {.stiffness = 2e7});
      m.add<ShaftSpring>("s2", {"b", "c"}, {.stiffness = 3e4, .damping = 2.0});
    } else {
      m.add<ShaftSpring>("s", {"a", "c"}, {.stiffness = 1.0 / (1.0 / 2e7 + 1.0 / 3e4), .damping = 2.0});
    }
    m.add<ShaftSpring>("s3", {"c", "d"}, {.stiffness = 1e4, .damping = 3.0});
    m.add<EngineOrderTorque>("engine", {"a"}, {.harmonics = {{2.0, 100.0}, {4.0, 40.0}}, .mean = 50.0});
    m.add<TorqueFunction>("fan", {"d"},
                          {.torque = [](const TorqueVariables& v) { return -0.0021 * v.speed * v.speed; }});
    return m.build();
  };
  const System stiff = train(true), series = train(false);
  State right = State::initial(series);
  propagate(series, {.t_end = 0.5}, right);
  for (const double tolerance : {1e-5, 1e-6}) {
    State state = State::initial(stiff);
    const RunSummary run = simulate(stiff,
                                    {.scheme = step_scheme("sdirk4"),
                                     .tolerance = tolerance,
                                     .t_end = 0.5,
                                     .progress = [asked = 0](double) mutable { return ++asked < 2000; }},
                                    state);
    INFO(run.brief_report());
    CHECK(run.ok());
    CHECK(std::abs(run.energy.relative_error()) < 1e-6);
    for (const char* node : {"a", "c", "d"}) {
      const NodeMap &in_stiff = stiff.node_map(stiff.node(node)),
                    &in_series = series.node_map(series.node(node));
      CHECK(state.z[in_stiff.unknown] == Approx(right.z[in_series.unknown]).epsilon(1e-4));
      CHECK(state.v[in_stiff.unknown] == Approx(right.v[in_series.unknown]).epsilon(1e-4));
    }
  }
}

TEST_CASE("Controlled steps keep their tolerance where a train turns as one body") {
  // J z'' = q sin(w t): z' = q (1 - cos w t)/(J w).
  Model m("one disc");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = 2.0});
  m.set_reference("disc", constant_speed(kTwoPi));
  m.add<EngineOrderTorque>("drive", {"disc"},
                           {.harmonics = {{3.0, 5.0, -0.5 * kPi}}, .twist_feedback = false});
  const System system = m.build();
  const double w = 3.0 * kTwoPi, t_end = 0.7;
  for (const char* name : {"dormand_prince", "sdirk4"}) {
    State state = State::initial(system);
    const RunSummary run = run_method(system, {.name = name, .tolerance = 1e-8}, {.t_end = t_end}, state);
    INFO(name << ": " << run.brief_report());
    CHECK(run.ok());
    CHECK(state.v[0] == Approx(2.5 * (1.0 - std::cos(w * t_end)) / w).epsilon(1e-7));
    CHECK(state.z[0] == Approx(2.5 * (t_end - std::sin(w * t_end) / w) / w).epsilon(1e-7));
  }
}

TEST_CASE("A mass that hardly moves out of the edge of a gap runs by every method, to the closed form") {
  // From d beyond the edge at rest: a quarter of a period on the spring, then free at the speed d w.
  constexpr double kEnd = 0.7, kOmega = 10.0;
  for (const double d : {0.0, 1e-12, 1e-9, 1e-6}) {
    Model m("edge");
    m.add_node("m", NodeKind::translational);
    m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
    m.add<PolylineSpring>("gap", {"m"}, PolylineSpring::dead_band(kOmega * kOmega, 0.1));
    m.set_initial("m", 0.1 + d, 0.0);
    const System system = m.build();
    for (const char* name : {"exact", "dormand_prince", "sdirk4"}) {
      State state = State::initial(system);
      const RunSummary run = run_method(system, {.name = name, .tolerance = 1e-8}, {.t_end = kEnd}, state);
      INFO(name << " from " << d << " beyond the edge: " << run.brief_report());
      CHECK(run.ok());
      CHECK(run.steps < 1000);
      const double moved = -d * (kOmega * kEnd - 0.5 * kPi);
      CHECK(std::abs(state.z[0] - (0.1 + moved)) < 1e-6 * d + 1e-15);  // 0.1 + d is rounded
    }
  }
}

TEST_CASE("The scales of a run far longer than its periods are found in steps that keep the inertia") {
  // At 155 Hz a 200th of the run, 5e5 s, leaves nothing of M beside K h^2 in rounding, and the pair turns freely.
  Model m("pair");
  for (const char* name : {"motor", "load"}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 0.02});
  }
  m.add<ShaftSpring>("shaft", {"motor", "load"}, {.stiffness = 9500.0, .damping = 0.5});
  m.add<AppliedTorque>("drive", {"motor"}, {.torque = [](double t) { return std::sin(t); }});
  const System system = m.build();
  State state = State::initial(system);
  int asked = 0;
  const RunSummary run = simulate(system,
                                  {.scheme = step_scheme("sdirk4"),
                                   .tolerance = 1e-4,
                                   .t_end = 1e8,
                                   .progress = [&](double) { return ++asked < 20; }},
                                  state);
  CHECK(run.status == RunStatus::interrupted);
  CHECK(run.steps > 100);
}

TEST_CASE("Controlled steps: a short circuit far shorter than the steps of the run is not passed over",
          "[once]") {
  // J w' = -A exp(-t/T) sin(Omega t) from its start on: w = -A Omega/(J (Omega^2 + 1/T^2)) at the end.
  const double torque = 1000.0, decay = 0.01, omega = kTwoPi * 50.0;
  const double expected = -torque * omega / (omega * omega + 1.0 / (decay * decay));
  for (const double start : {0.0, 0.5}) {
    Model m("short circuit");
    m.add_node("rotor");
    m.add<Inertia>("J", {"rotor"}, {.inertia = 1.0});
    m.add<Generator>("generator", {"rotor"},
                     {.fault_time = start, .fault_torque = torque, .fault_decay = decay});
    const System s = m.build();
    for (const char* name : {"average_acceleration", "hht", "generalized_alpha", "bathe", "tr_bdf2",
                             "central_difference", "sdirk4", "rk4", "dormand_prince"}) {
      INFO(name << ", fault at " << start << " s");
      State state = State::initial(s);
      REQUIRE(simulate(s, {.scheme = step_scheme(name), .tolerance = 1e-5, .t_end = 10.0}, state, {}).ok());
      CHECK(state.v[0] == Approx(expected).epsilon(1e-4));
    }
  }
}

TEST_CASE(
    "A function of time that jumps or kinks keeps the tolerance, wherever the steps of sdirk4 meet it") {
  for (const double at : {0.33, 0.55, 0.8125}) {
    const auto angle_after = [&](const std::function<double(double)>& torque, double tolerance) {
      Model m("disc");
      m.add_node("a");
      m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
      m.add<AppliedTorque>("T", {"a"}, {.torque = torque});
      const System system = m.build();
      State state = State::initial(system);
      const RunSummary run =
          simulate(system, {.scheme = step_scheme("sdirk4"), .tolerance = tolerance, .t_end = 2.0}, state);
      CHECK(run.ok());
      CHECK(run.steps < 5000);
      return state.z[0];
    };
    const double left = 2.0 - at;
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      INFO("at " << at << " s, tolerance " << tolerance);
      // 1 from there on, where one step of the least length may add as much; t up to there: z(2 s).
      CHECK(angle_after([=](double t) { return t > at ? 1.0 : 0.0; }, tolerance) ==
            Approx(0.5 * left * left).epsilon(std::max(tolerance, 3e-8)));
      CHECK(angle_after([=](double t) { return std::min(t, at); }, tolerance) ==
            Approx(at * at * at / 6.0 + 0.5 * at * at * left + 0.5 * at * left * left).epsilon(tolerance));
    }
  }
}

TEST_CASE("The torque of a shaft far stiffer than the train turns, inside the steps behind a jump, too") {
  // Half of 1 N m goes through the shaft between two equal discs, which turn by 95 rad; its twist is 5e-10 rad.
  for (const double stiffness : {1e9, 1e10}) {
    Model m("pair");
    for (const char* name : {"a", "b"}) {
      m.add_node(name);
      m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
    }
    m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = stiffness, .damping = 1e-4 * stiffness});
    m.add<AppliedTorque>("T", {"a"}, {.table = TimeTable({0.0, 0.5, 0.5, 100.0}, {0.0, 0.0, 1.0, 1.0})});
    const System system = m.build();
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      State state = State::initial(system);
      Recorder recorder(system, {"shaft.torque_Nm"}, 0.01);
      const RunSummary run =
          simulate(system, {.scheme = step_scheme("sdirk4"), .tolerance = tolerance, .t_end = 20.0}, state,
                   {&recorder});
      INFO(stiffness << " N m/rad, tolerance " << tolerance << ": " << run.brief_report());
      CHECK(run.ok());
      // One unit in the last place of 95 rad is 1.4e-14 rad.
      const double margin = 0.05 + 3e-13 * stiffness;
      for (std::size_t i = 0; i < recorder.times().size(); ++i) {
        const double torque = std::abs(recorder.samples(0)[i]);
        CHECK(torque < 0.5 + margin);
        if (recorder.times()[i] > 0.505) CHECK(torque > 0.5 - margin);
      }
      CHECK(state.z[0] == Approx(0.25 * 19.5 * 19.5).epsilon(1e-4));
    }
  }
}

TEST_CASE("A law that states no energy drives a train beside a weak load: what it gives was put in") {
  Model m("three discs");
  for (const char* name : {"a", "b", "c"}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
  }
  m.set_initial("a", -0.1, 0.0);
  m.add<LawElement<LawWithoutEnergy>>("law", {"a", "b"}, LawWithoutEnergy{});
  m.add<ShaftSpring>("shaft", {"b", "c"}, {.stiffness = 1000.0});
  m.add<Propeller>("load", {"c"}, {.rated_torque = 0.1, .rated_speed = 1.0});
  const System system = m.build();
  for (const char* name : {"rk4", "dormand_prince", "sdirk4"}) {
    State state = State::initial(system);
    const RunSummary run =
        simulate(system, {.scheme = step_scheme(name), .tolerance = 1e-8, .t_end = 2.0}, state);
    INFO(name << ": " << run.brief_report());
    CHECK(run.ok());
    CHECK(state.z[0] == Approx(-0.040967238970).epsilon(1e-6));  // by DOP853 and Radau of scipy
  }
}
