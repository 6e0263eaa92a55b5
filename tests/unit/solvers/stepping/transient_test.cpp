// Integration in time: exact stops, restarts, energy, paths that must agree, refusals.
// Covers solvers/run/energy_monitor.hpp, energy_balance.hpp, run_summary.hpp, run_verdict.hpp and
// run_checks.hpp, and solvers/stepping/step_options.hpp, through simulate().
#include <drev/core/assembler.hpp>
#include <drev/core/law_element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;

namespace {

double position_at(const System& system, double t, double step, const StepScheme& scheme) {
  Recorder r(system, {"m.position_m"}, t);
  simulate(system, {.scheme = scheme, .step = step, .t_end = t, .energy_tolerance = 10}, {&r});
  return r.samples(0).back();
}

}  // namespace

TEST_CASE("Sudden release of a static load: second order with the acceleration evaluated again") {
  // Load k held to t = 1/sqrt 2 + 0.8 from equilibrium; u(2.25) = cos(2 pi (2.25 - release)).
  const double release = 1 / std::sqrt(2.0) + 0.8;
  Model m = unit_oscillator();
  const double k = 4 * kPi * kPi;
  m.add<AppliedTorque>("load", {"m"},
                       {.torque = [=](double t) { return t < release ? k : 0.0; }, .breakpoints = {release}});
  m.set_initial("m", 1.0, 0.0);
  const System system = m.build();
  const double exact = std::cos(kTwoPi * (2.25 - release));
  CHECK(exact == Approx(-0.04463838552478572).epsilon(1e-12));
  double last = 0.0;
  for (const double h : {0.0125, 0.00625, 0.003125}) {
    const double error = std::abs(position_at(system, 2.25, h, average_acceleration()) - exact);
    if (last > 0.0) CHECK(std::log2(last / error) == Approx(2.0).margin(0.1));
    last = error;
  }
  CHECK(last < 1e-3);
}

TEST_CASE("Step load: consistent initial acceleration gives second order from the first step") {
  // u = 1 - cos w t scaled by 1/w^2; average acceleration, values of a separate program at t = 10.25.
  Model m = unit_oscillator();
  m.add<AppliedTorque>("load", {"m"}, {.torque = [](double) { return 4 * kPi * kPi; }});
  const System system = m.build();
  const double exact = 1 - std::cos(kTwoPi * 10.25);
  const double printed[] = {-0.4986, -0.1316, -0.03307, -0.008274, -0.002069};
  double h = 0.05;
  for (const double error : printed) {
    const double u = position_at(system, 10.25, h, average_acceleration());
    CHECK(u - exact == Approx(error).epsilon(2e-3));
    h /= 2;
  }
}

TEST_CASE("Linear limits of the schemes: period elongation and amplitude decay of the closed forms") {
  // Undamped, h/T = 0.1 over 10 periods: PE and AD per period from the methods' stability functions.
  struct Expected {
    const char* method;
    double elongation, decay;
  };
  for (const Expected& e :
       {Expected{"average_acceleration", 0.032074911, 0.0}, Expected{"hht:0.05", 0.036110956, 0.0074101406},
        Expected{"hht:0.3", 0.046566671, 0.023300186},
        Expected{"generalized_alpha:0.8", 0.033828406, 9.8767819e-4}}) {
    Model m = unit_oscillator();
    m.set_initial("m", 1.0, 0.0);
    const System system = m.build();
    Recorder r(system, {"m.position_m"}, 0.1);
    simulate(system, {.scheme = step_scheme(e.method), .step = 0.1, .t_end = 12.0, .energy_tolerance = 10},
             {&r});
    // Fit u_n = rho^n cos(n phi + c): three successive samples give rho and phi. The spurious root of the
    // three-step forms has died out by then.
    const auto& u = r.samples(0);
    const std::size_t n = 60;
    const double d = u[n] * u[n - 2] - u[n - 1] * u[n - 1];
    const double rho2 = (u[n + 1] * u[n - 1] - u[n] * u[n]) / d;
    const double cosine = (u[n + 1] + rho2 * u[n - 1]) / (2 * std::sqrt(rho2) * u[n]);
    const double phi = std::acos(cosine);
    INFO(e.method);
    CHECK(kTwoPi / (phi * 10) - 1 == Approx(e.elongation).epsilon(1e-5));
    CHECK(1 - std::pow(std::sqrt(rho2), kTwoPi / phi) == Approx(e.decay).epsilon(1e-4).margin(1e-9));
  }
}

TEST_CASE("Central difference near its limit omega h = 2: the closed-form value") {
  // u_100 at omega h/2 = 0.999 and 1: cos 100 theta.
  for (const auto& [half, value] : {std::pair{0.999, -0.88710548097887}, {1.0, 1.0}}) {
    Model m = unit_oscillator();
    m.set_initial("m", 1.0, 0.0);
    const System system = m.build();
    const double h = half * 2 / kTwoPi;
    Recorder r(system, {"m.position_m"}, 100 * h);
    simulate(system,
             {.scheme = step_scheme("central_difference"),
              .step = h,
              .t_end = 100 * h,
              .energy_tolerance = 1e9,
              .energy_growth_limit = 1e30},
             {&r});
    CHECK(r.samples(0).back() == Approx(value).epsilon(1e-6));
  }
}

TEST_CASE("Average acceleration balances the energy of a linear system to rounding") {
  Model m("two");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("Ja", {"a"}, {.inertia = 0.012});
  m.add<Inertia>("Jb", {"b"}, {.inertia = 0.035});
  m.add<ShaftSpring>("s", {"a", "b"}, {.stiffness = 8.5e3, .damping = 0.5});
  m.add<RayleighDamping>("r", {}, {.alpha_mass = 3.0, .beta_stiffness = 1e-6});
  m.add<AppliedTorque>("t", {"a"}, {.torque = [](double t) { return 20 * std::sin(300 * t); }});
  const RunSummary run = simulate(m.build(), {.step = 1e-4, .t_end = 1.0});
  CHECK(run.ok());
  CHECK(run.energy.dissipated > 0.1);
  CHECK(std::abs(run.energy.relative_error()) < 1e-11);
}

TEST_CASE("Varying mesh stiffness and transmission error: the balance counts what they put in") {
  for (const bool fourier : {false, true}) {
    Model m("pair");
    m.add_node("pinion");
    m.add_node("wheel");
    m.add<Inertia>("J1", {"pinion"}, {.inertia = 0.002});
    m.add<Inertia>("J2", {"wheel"}, {.inertia = 0.03});
    m.add<GearMesh>(
        "mesh", {"pinion", "wheel"},
        {.base_radius_1 = 0.03,
         .base_radius_2 = 0.075,
         .teeth_1 = 20,
         .teeth_2 = 50,
         .stiffness = fourier ? MeshStiffness::fourier_of_step(1.5e8, 2.5e8, 1.6, 5) : MeshStiffness(2e8),
         .damping = 500.0,
         .transmission_error = std::vector<Harmonic>{{1.0, 5e-6, 0.3}}});
    m.add<AppliedTorque>("brake", {"wheel"}, {.torque = [](double) { return -100.0; }});
    m.constant_speed("pinion", rpm(900));
    const System system = m.build();
    double last = 0.0;
    for (const double h : {4e-6, 2e-6}) {
      const RunSummary run = simulate(system, {.step = h, .t_end = 0.05});
      CHECK(run.ok());
      const double error = std::abs(run.energy.relative_error());
      CHECK(error < 1e-3);
      // Second order: halving the step divides the error by about four.
      if (last > 0.0) CHECK(error < 0.35 * last);
      last = error;
    }
  }
}

TEST_CASE("Given motion: reaction and response of the closed form") {
  // Base moves as u = U sin w t; k (u - q) = J q''. Steady amplitude from rest is not needed: compare with
  // the exact solution q = A (w_n sin w t - w sin w_n t), A = U w_n / (w_n^2 - w^2).
  const double stiffness = 400.0, w = 7.0, w_n = 20.0, amplitude = 0.01;
  Model m("base");
  m.add_node("base");
  m.add_node("disc");
  m.add<Inertia>("Jb", {"base"}, {.inertia = 0.5});
  m.add<Inertia>("Jd", {"disc"}, {.inertia = 1.0});
  m.add<ShaftSpring>("s", {"base", "disc"}, {.stiffness = stiffness});
  m.given_motion("base", {[=](double t) {
                            return MotionPoint{amplitude * std::sin(w * t), amplitude * w * std::cos(w * t),
                                               -amplitude * w * w * std::sin(w * t)};
                          },
                          {}});
  const System system = m.build();
  Recorder r(system, {"disc.angle_rad", "base.angle_rad", "base.reaction_Nm"}, 0.25);
  const RunSummary run = simulate(system, {.step = 1e-4, .t_end = 2.0}, {&r});
  CHECK(run.ok());
  const double a = amplitude * w_n / (w_n * w_n - w * w);
  for (std::size_t i = 0; i < r.times().size(); ++i) {
    const double t = r.times()[i];
    const double q = a * (w_n * std::sin(w * t) - w * std::sin(w_n * t));
    const double u = amplitude * std::sin(w * t);
    CHECK(r.samples(0)[i] == Approx(q).margin(1e-5 * amplitude));
    CHECK(r.samples(1)[i] == Approx(u).margin(1e-15));
    CHECK(r.samples(2)[i] ==
          Approx(-0.5 * w * w * u + stiffness * (u - q)).margin(1e-5 * stiffness * amplitude));
  }
}

TEST_CASE("Few contacts or the sparse tangent: the same run") {
  Model m("rattle");
  m.add_node("a");
  m.add_node("b");
  m.add_node("c");
  m.add<Inertia>("Ja", {"a"}, {.inertia = 0.01});
  m.add<Inertia>("Jb", {"b"}, {.inertia = 0.02});
  m.add<Inertia>("Jc", {"c"}, {.inertia = 0.015});
  m.add<GearMesh>("mesh", {"a", "b"},
                  {.base_radius_1 = 0.03,
                   .base_radius_2 = 0.06,
                   .stiffness = 1e8,
                   .normal_backlash = 1e-4,
                   .damping = 200.0});
  m.add<ShaftSpring>("s", {"b", "c"}, {.stiffness = 5e3});
  m.add<EngineOrderTorque>("load", {"c"}, {.harmonics = {{2.0, 30.0, 0.0}}, .mean = -5.0});
  m.constant_speed("a", 100.0);
  const System system = m.build();
  State dense = State::initial(system), sparse = dense;
  const TransientOptions options{.step = 1e-5, .t_end = 0.02};
  TransientOptions all_sparse = options;
  all_sparse.newton.max_dense_contacts = -1;
  const RunSummary run_dense = simulate(system, options, dense);
  const RunSummary run_sparse = simulate(system, all_sparse, sparse);
  CHECK(run_dense.ok());
  CHECK(run_sparse.ok());
  CHECK(run_dense.newton_on_contacts);
  CHECK_FALSE(run_sparse.newton_on_contacts);
  CHECK((dense.z - sparse.z).lpNorm<Eigen::Infinity>() < 1e-7 * dense.z.lpNorm<Eigen::Infinity>());
}

TEST_CASE("Output at exactly the times asked for, whatever the step") {
  Model m = unit_oscillator();
  m.set_initial("m", 1.0, 0.0);
  m.add<AppliedTorque>("none", {"m"}, {.torque = [](double) { return 0.0; }, .breakpoints = {0.0, 0.3, 0.7}});
  const System system = m.build();
  Recorder r(system, {"m.position_m"}, 0.1);
  Recorder odd(system, {"m.position_m"}, 0.0333);
  const RunSummary run = simulate(system, {.step = 7e-4, .t_end = 1.0}, {&r, &odd});
  CHECK(run.ok());
  REQUIRE(r.times().size() == 11);
  for (std::size_t i = 0; i < r.times().size(); ++i) {
    CHECK(r.times()[i] == Approx(0.1 * static_cast<double>(i)).margin(1e-15));
    CHECK(r.samples(0)[i] == Approx(std::cos(kTwoPi * r.times()[i])).margin(1e-4));
  }
  REQUIRE(odd.times().size() == 31);
  CHECK(odd.times()[30] == 30 * 0.0333);
}

TEST_CASE("Peaks at the ends of steps, or inside them to fourth order") {
  // Points of the exact motion sin(2 pi t): the peak 1 at t = 1/4 lies inside a step.
  const System system = [] { return unit_oscillator().build(); }();
  const Assembler assembler(system);
  const auto point = [](double t) {
    EvaluatedState p;
    p.state.t = t;
    p.state.z = Vector::Constant(1, std::sin(kTwoPi * t));
    p.state.v = Vector::Constant(1, kTwoPi * std::cos(kTwoPi * t));
    p.state.a = Vector::Constant(1, -kTwoPi * kTwoPi * std::sin(kTwoPi * t));
    return p;
  };
  double last = 0.0;
  for (const double h : {0.06, 0.03}) {
    Peaks ends({find_channel(system, "m.position_m")}, false), inside(ends.channels(), true);
    EvaluatedState from = point(0.25 - 3.4 * h);
    ends.start(assembler, from);
    inside.start(assembler, from);
    for (int i = 1; i <= 6; ++i) {
      const EvaluatedState to = point(0.25 - 3.4 * h + i * h);
      ends.step(assembler, from, to);
      inside.step(assembler, from, to);
      from = to;
    }
    CHECK(ends.peaks()[0].max == Approx(std::cos(kTwoPi * 0.4 * h)).epsilon(1e-12));
    const double error = std::abs(inside.peaks()[0].max - 1.0);
    CHECK(error < 1e-4);
    CHECK(inside.peaks()[0].max_time == Approx(0.25).margin(1e-3));
    if (last > 0.0) CHECK(std::log2(last / error) == Approx(4.0).margin(0.3));
    last = error;
  }
}

TEST_CASE("A run that is stopped says so and leaves what it had") {
  Model m = unit_oscillator();
  m.set_initial("m", 1.0, 0.0);
  const System system = m.build();
  State state = State::initial(system);
  const RunSummary run = simulate(
      system, {.step = 1e-4, .t_end = 10.0, .progress = [](double done) { return done < 0.5; }}, state);
  CHECK(run.status == RunStatus::interrupted);
  CHECK(run.t_end >= 5.0);
  CHECK(run.t_end < 5.2);
  CHECK(state.t == run.t_end);
}

TEST_CASE("A load that becomes NaN stops the run with the time") {
  Model m = unit_oscillator();
  m.add<AppliedTorque>("bad", {"m"}, {.torque = [](double t) { return t > 0.5 ? NAN : 1.0; }});
  const RunSummary run = simulate(m.build(), {.step = 1e-3, .t_end = 1.0});
  CHECK(run.status == RunStatus::not_finite);
  CHECK(run.t_end == Approx(0.5).margin(2e-3));
  CHECK(run.reason.find("t = 0.5") != std::string::npos);
}

TEST_CASE("Bad options are refused together") {
  const System system = [] {
    Model m = unit_oscillator();
    return m.build();
  }();
  try {
    simulate(system, {.step = 0.0, .t_end = -1.0, .max_halvings = 99, .energy_tolerance = NAN});
    FAIL("four faults");
  } catch (const ModelError& e) {
    CHECK(e.findings().size() == 4);
  }
  CHECK_THROWS_AS(Recorder(system, {"m.position_m"}, 0.0), ModelError);
  CHECK_THROWS_AS(Recorder(system, {"m.angle_rad", "n.position_m"}, 0.1), ModelError);
  for (const char* bad : {"hht:0.5", "newmark:-1,0.5", "newmark:0.25", "generalized_alpha:1.5",
                          "averageacceleration", "hht:x", "hht:", "newmark:0.25,0.5,", ""})
    CHECK_THROWS_AS(step_scheme(bad), ModelError);
}

TEST_CASE("Explicit steps from rest: a load that sets in is no energy from nothing, one run and in lockstep",
          "[verdict]") {
  // The first step moves nothing (no load yet at its start), so that the load's work in it is nothing too.
  for (const double sets_in : {0.0, 0.1}) {
    Model m("two inertias");
    for (const char* node : {"motor", "load"}) m.add_node(node);
    m.add<Inertia>("J_motor", {"motor"}, {.inertia = 0.012});
    m.add<Inertia>("J_load", {"load"}, {.inertia = 0.035});
    m.add<ShaftSpring>("shaft", {"motor", "load"}, {.stiffness = 8500.0, .damping = 0.5});
    m.add<AppliedTorque>(
        "drive", {"motor"},
        {.torque = [=](double t) { return t < sets_in ? 0.0 : 20.0 * std::sin(250.0 * (t - sets_in)); },
         .breakpoints = {sets_in}});
    const System system = m.build();
    for (const StepScheme& scheme :
         {step_scheme("central_difference"), newmark(0.0, 0.5), average_acceleration()}) {
      const TransientOptions options{.scheme = scheme, .step = 1e-5, .t_end = 0.3};
      State state = State::initial(system);
      const RunSummary run = simulate(system, options, state);
      INFO(scheme.name << ": " << run.reason);
      CHECK(run.ok());
      const ManyResult many = simulate_many(1, [&](std::size_t) { return system; }, options, {.threads = 1});
      CHECK(many.variants[0].summary.ok());
      CHECK(many.variants[0].state.z[0] == Approx(state.z[0]).epsilon(1e-9));
    }
  }
}

namespace {

/// Far stiffer at large deflections than the stability limit, which looks at small ones, knows.
struct Hardening {
  ScalarResponse operator()(const ScalarInput& in) const {
    const double x2 = in.x * in.x;
    return {.y = (1.0 + 1e4 * x2) * in.x, .dy_dx = 1.0 + 3e4 * x2, .stored_energy = (0.5 + 2.5e3 * x2) * x2};
  }
};

}  // namespace

TEST_CASE("Explicit steps that are too long for a law that hardens end as unstable, not as success",
          "[verdict]") {
  Model m = unit_oscillator();
  m.add<LawElement<Hardening>>("stop", {"m"}, {});
  m.set_initial("m", 0.0, 10.0);
  const System system = m.build();
  for (const double step : {0.02, 0.05, 0.1}) {
    const TransientOptions options{.scheme = newmark(0.0, 0.5), .step = step, .t_end = 10.0};
    State state = State::initial(system);
    const RunSummary run = simulate(system, options, state);
    CHECK((run.status == RunStatus::unstable || run.status == RunStatus::not_finite ||
           run.status == RunStatus::no_convergence || run.status == RunStatus::energy_error));
    const ManyResult many = simulate_many(1, [&](std::size_t) { return system; }, options, {.threads = 1});
    CHECK(many.variants[0].summary.status == run.status);
  }
}
