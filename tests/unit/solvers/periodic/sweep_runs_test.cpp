// Runs in time of a sweep: when their motion repeats, what their figures are, and the curves that start from them.
// Expected values: maps with known multipliers, balances of mean torque, runs by propagate() that are not stopped.
// Covers solvers/cycle_decay.hpp, cycle_run.hpp, speed_hold.hpp and, through sweep_nonlinear(), sweeper.hpp.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <cmath>
#include <complex>

#include "solvers/at_speed.hpp"
#include "solvers/cycle_decay.hpp"
#include "solvers/cycle_run.hpp"
#include "solvers/speed_hold.hpp"
#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"

using namespace drev;

namespace {

/// x'' + c x' + dz(x) = mean + error w^2 cos w t, half gap 1, x = wheel - error cos w t.
System rattling_pair(double damping, double mean, double error) {
  return problems::DrivenGear{.half_gap = 1.0,
                              .damping = damping,
                              .mean = mean,
                              .transmission_error = std::vector<Harmonic>{{1.0, error, 0.0}}}
      .build();
}

/// Cycles of x_n = multiplier^n about a motion of size 1, until they are said to repeat, at most `most`.
struct Decayed {
  int seen = 0;
  std::optional<CycleDecay::Repetition> found;
  double away = 0.0;  ///< of the last from where they lead to
};
Decayed decay_of(std::complex<double> multiplier, int most, double start = 0.3) {
  CycleDecay decay;
  Decayed result;
  std::complex<double> x = start;
  while (result.seen < most && !result.found) {
    ++result.seen;
    x *= multiplier;
    decay.add(Vector::Constant(1, 1.0 + x.real()), Vector::Constant(1, -1.0 + x.imag()));
    result.found = decay.repeats();
  }
  result.away = std::max(std::abs(x.real()), std::abs(x.imag()));
  return result;
}

/// 20 N m on a wheel whose pinion is held at its speed [rad/s], stiffness in steps.
System step_pair(double speed) {
  Model m("step pair");
  m.add_node("pinion");
  m.add_node("wheel");
  m.add<Inertia>("J", {"wheel"}, {.inertia = 0.01});
  m.add<GearMesh>("mesh", {"pinion", "wheel"},
                  {.base_radius_1 = 0.05,
                   .base_radius_2 = 0.05,
                   .teeth_1 = 30,
                   .teeth_2 = 30,
                   .stiffness = MeshStiffness::step(1.5e8, 2.5e8, 1.5),
                   .normal_backlash = 1e-4,
                   .damping = 100.0,
                   .damping_law = MeshDamping::always,
                   .transmission_error = std::vector<Harmonic>{{1.0, 2.5e-6, 0.0}}});
  m.add<EngineOrderTorque>("load", {"wheel"}, {.mean = 20.0});
  m.constant_speed("pinion", speed);
  m.set_initial("wheel", 2e-5, 0.0);
  return m.build();
}

}  // namespace

TEST_CASE("Cycles repeat when what the decay leaves to come is small, not when they change little",
          "[cycle_run]") {
  using Complex = std::complex<double>;
  for (const Complex multiplier :
       {Complex(0.0), Complex(0.05), Complex(0.5), Complex(0.95), Complex(0.999), Complex(-0.5),
        Complex(-0.99), std::polar(0.9, 1.0), std::polar(0.99, 2.5)}) {
    INFO(multiplier);
    const Decayed decayed = decay_of(multiplier, 20000);
    REQUIRE(decayed.found);
    CHECK(decayed.found->cycles == 1);
    CHECK(decayed.found->rest <= CycleDecay::kRepeats);
    // The rest, and the change of the last cycle that the window saw, bound the true distance.
    CHECK(decayed.away <= 2.0 * CycleDecay::kRepeats);
    if (std::abs(multiplier) > 0.4) CHECK(decayed.found->ratio == Approx(std::abs(multiplier)).epsilon(0.15));
  }
  // Within 20 cycles a multiplier of 1/2 is through; one of .999 is not within 5,000, where it is 2e-3 away.
  CHECK(decay_of(0.5, 100).seen < 40);
  CHECK_FALSE(decay_of(0.999, 5000).found);
  CHECK_FALSE(decay_of(0.999999, 5000, 0.9).found);  // 1e-6 a cycle: 0.9 to go
  CHECK_FALSE(decay_of(1.001, 500, 1e-6).found);
}

TEST_CASE("Cycles repeat in the fewest, and those of chaos do not", "[cycle_run]") {
  CycleDecay three, chaos;
  double x = 0.3;
  for (int n = 0; n < 60; ++n) {
    three.add(Vector::Constant(1, 1.0 + 0.4 * (n % 3) + std::pow(0.5, n)), Vector::Constant(1, 2.0));
    x = 4.0 * x * (1.0 - x);  // the logistic map
    chaos.add(Vector::Constant(1, x), Vector::Constant(1, 0.0));
  }
  REQUIRE(three.repeats());
  CHECK(three.repeats()->cycles == 3);
  CHECK_FALSE(chaos.repeats());
  CHECK(CycleDecay::Repetition{2, 0.9, 0.0}.left(0.19) == Approx(1.0));
}

TEST_CASE("A run that repeats has figures of whole cycles, as a long run has them", "[cycle_run]") {
  const System system = rattling_pair(0.1, 0.05, 0.5);
  const double speed = 0.5, period = kTwoPi / speed;
  const System here = at_speed(system, speed);
  const CycleRunResult found = run_cycles(here, State::initial(here),
                                          {.period = period,
                                           .cycles = 400,
                                           .tolerance = 1e-8,
                                           .channels = {"mesh.force_N", "wheel.angle_rad"},
                                           .samples = 100});
  const SweptRun& run = found.run;
  CHECK(run.reason.empty());
  CHECK(run.repeats == 1);
  CHECK(run.cycles == 1);
  CHECK(found.motion.size() == 100);
  CHECK(run.error <= 1e-8);
  // Over a cycle that repeats the mesh carries the load's mean, but for what the damper's mean rate of zero leaves.
  CHECK(std::abs(std::abs(run.mean[0]) - 0.05) <= 1e-8 + run.mean_error[0]);
  // A run of 400 cycles, and the extremes of one more.
  State state = State::initial(here);
  REQUIRE(propagate(here, {.tolerance = 1e-12, .t_end = 400 * period}, state).ok());
  Peaks peaks(find_channels(here, {"mesh.force_N", "wheel.angle_rad"}));
  REQUIRE(
      propagate(here, {.tolerance = 1e-12, .t_start = state.t, .t_end = 401 * period}, state, {&peaks}).ok());
  for (std::size_t c = 0; c < 2; ++c) {
    const auto at = static_cast<Eigen::Index>(c);
    const double size = peaks.peaks()[c].amplitude();
    CHECK(run.highest[at] == Approx(peaks.peaks()[c].max).margin(1e-6 * size));
    CHECK(run.lowest[at] == Approx(peaks.peaks()[c].min).margin(1e-6 * size));
  }
  // Ended from outside there is nothing.
  int asked = 0;
  CHECK(run_cycles(here, State::initial(here),
                   {.period = period, .cycles = 400, .tolerance = 1e-8, .go_on = [&] { return ++asked < 3; }})
            .ended);
}

TEST_CASE("A free train in a run keeps its mean speed, and its teeth carry what the balance of means gives",
          "[cycle_run]") {
  // Two gears that rattle, 20 N m on one and 5 N m against it on the other: 15 N m are left over.
  Model m("free pair");
  m.add_node("motor");
  m.add_node("wheel");
  m.set_reference("motor", constant_speed(100.0));
  m.add<Inertia>("J_1", {"motor"}, {.inertia = 0.5});
  m.add<Inertia>("J_2", {"wheel"}, {.inertia = 1.0});
  m.add<GearMesh>("mesh", {"motor", "wheel"},
                  {.base_radius_1 = 0.1,
                   .base_radius_2 = 0.1,
                   .teeth_1 = 1,
                   .teeth_2 = 1,
                   .stiffness = 1e6,
                   .normal_backlash = 1e-4,
                   .damping = 100.0,
                   .damping_law = MeshDamping::always,
                   .transmission_error = std::vector<Harmonic>{{1.0, 1e-3, 0.0}}});
  m.add<EngineOrderTorque>("drive", {"motor"}, {.harmonics = {{0.5, 10.0, 0.0}}, .mean = 20.0});
  m.add<EngineOrderTorque>("load", {"wheel"}, {.mean = 5.0});
  const System system = at_speed(m.build(), 100.0);
  const Vector rigid{{1.0, -1.0}};
  for (const bool balanced : {false, true}) {
    INFO(balanced);
    FloatingPart part{rigid, {}};
    if (balanced) part.balance = {{1, 1.0}};
    const SweptRun run = run_cycles(system, State::initial(system),
                                    {.period = 2.0 * kTwoPi / 100.0,
                                     .cycles = 200,
                                     .tolerance = 1e-6,
                                     .channels = {"mesh.force_N", "motor.speed_rad_per_s"},
                                     .floating = {part}})
                             .run;
    REQUIRE(run.reason.empty());
    REQUIRE(run.lowest[0] * run.highest[0] <= 0.0);  // the teeth part
    // Motor: 20 N m less J_1 15/(J_1 + J_2), or 20 N m.
    const double force = (balanced ? 20.0 : 20.0 - 0.5 * 15.0 / 1.5) / 0.1;
    INFO(run.mean[0] << " +- " << run.mean_error[0]);
    CHECK(std::abs(std::abs(run.mean[0]) - force) <= 2.0 * run.mean_error[0] + 1e-3 * force);
    CHECK(run.mean_error[0] < 0.05 * force);
    CHECK(std::abs(run.mean[1]) < 1e-3);  // of 100 rad/s
    REQUIRE(run.left_over.size() == 1);
    CHECK(run.left_over[0] == Approx(15.0).epsilon(1e-3));
  }
}

TEST_CASE("Means of a stiffness that jumps do not depend on where the steps fall", "[cycle_run]") {
  // 20 N m on a wheel whose pinion is held at its speed: 400 N, whatever the teeth do. From this start the steps keep time
  // with the teeth: Gauss's two points in each give 413.8 N +- 2.2.
  const double speed = rpm(1200.0);
  const System system = step_pair(speed);
  const SweptRun run =
      run_cycles(
          system, State::initial(system),
          {.period = kTwoPi / speed / 30.0, .cycles = 400, .tolerance = 1e-6, .channels = {"mesh.force_N"}})
          .run;
  REQUIRE(run.reason.empty());
  REQUIRE(run.repeats == 0);
  INFO(run.mean[0] << " +- " << run.mean_error[0]);
  CHECK(std::abs(std::abs(run.mean[0]) - 400.0) <= std::max(1.0, 2.0 * run.mean_error[0]));
  CHECK(run.mean_error[0] < 40.0);
}

TEST_CASE("Closed contacts are tried where a curve passes without being stable", "[nonlinear_sweep][once]") {
  // The curve from 900 and 4,500 rpm passes 1,200 rpm unstable; another is stable there.
  const double speed = rpm(1200.0);
  const NonlinearSweep sweep =
      sweep_nonlinear(step_pair(speed), {.speeds = {rpm(900.0), speed, rpm(4500.0)}, .tolerance = 1e-3});
  CHECK(sweep.runs.empty());
  bool found = false;
  for (const SweptBranch& branch : sweep.branches)
    for (const SweptMotion& motion : branch.motions) {
      if (!motion.asked || !motion.stable || std::abs(motion.speed - speed) > 1e-9 * speed) continue;
      found = true;
      CHECK(branch.run_speed == 0.0);  // no run led to it
      const System here = step_pair(speed);
      State state = State::initial(here);
      state.z = motion.z;
      state.v = motion.v;
      REQUIRE(propagate(here, {.tolerance = 1e-11, .t_end = branch.turns * kTwoPi / speed}, state).ok());
      CHECK(state.z[0] == Approx(motion.z[0]).epsilon(1e-2));
    }
  CHECK(found);
}

TEST_CASE("Where closed contacts lead to no curve the harmonics of a run do", "[nonlinear_sweep]") {
  const System system = rattling_pair(0.1, 0.05, 0.5);
  const NonlinearSweep sweep = sweep_nonlinear(system, {.speeds = {0.5, 0.505}, .tolerance = 1e-3});
  REQUIRE(sweep.branches.size() == 1);
  CHECK(sweep.branches[0].run_speed == 0.5);
  CHECK(sweep.branches[0].turns == 1.0);
  CHECK(sweep.runs.empty());
  CHECK(sweep.unsolved.empty());
  for (const SweptMotion& motion : sweep.branches[0].motions) {
    if (!motion.asked) continue;
    INFO(motion.speed);
    CHECK(motion.stable);
    CHECK(motion.separates);
    CHECK(motion.error < 1e-3);
    // From its state a run comes back to it.
    const System here = at_speed(system, motion.speed);
    State state = State::initial(here);
    state.z = motion.z;
    state.v = motion.v;
    REQUIRE(propagate(here, {.tolerance = 1e-11, .t_end = kTwoPi / motion.speed}, state).ok());
    CHECK(state.z[0] == Approx(motion.z[0]).margin(5e-3));
    CHECK(state.v[0] == Approx(motion.v[0]).margin(5e-3));
  }
}

TEST_CASE("The result of a sweep's runs does not depend on the number of threads", "[nonlinear_sweep]") {
  const System system = rattling_pair(0.1, 0.2, 0.5);  // chaos at all of these speeds
  std::vector<NonlinearSweep> sweeps;
  for (const int threads : {1, 4})
    sweeps.push_back(sweep_nonlinear(
        system,
        {.speeds = {0.80, 0.81, 0.82, 0.83, 1.2}, .tolerance = 1e-3, .run_cycles = 60, .threads = threads}));
  REQUIRE(sweeps[0].runs.size() >= 3);
  REQUIRE(sweeps[0].runs.size() == sweeps[1].runs.size());
  REQUIRE(sweeps[0].branches.size() == sweeps[1].branches.size());
  for (std::size_t i = 0; i < sweeps[0].runs.size(); ++i) {
    const SweptRun &a = sweeps[0].runs[i], &b = sweeps[1].runs[i];
    CHECK(a.speed == b.speed);
    CHECK(a.repeats == b.repeats);
    CHECK(a.mean == b.mean);
    CHECK(a.mean_error == b.mean_error);
    CHECK(a.lowest == b.lowest);
    CHECK(a.highest == b.highest);
  }
  // Whoever asks for progress may end it, and then there are no runs.
  int asked = 0;
  const NonlinearSweep ended =
      sweep_nonlinear(system, {.speeds = {0.80, 0.81}, .tolerance = 1e-3, .progress = [&](double part) {
                                 ++asked;
                                 return part < 0.5;
                               }});
  CHECK(ended.runs.empty());
  CHECK(asked < 10);
  CHECK_THROWS_AS(sweep_nonlinear(system, {.speeds = {0.8, 0.9}, .threads = -1}), ModelError);
}
