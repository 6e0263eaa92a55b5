// Sweeps of geared trains whose loads share a long cycle only, so that the orders of one of them are high harmonics of it.
// Expected values: closed form of four inertias in a row with closed teeth, (K + i o w C - (o w)^2 M) z = p for each order,
// and the extremes of their sum over the cycle, by a separate program.
// Covers solvers/periodic/excited_lines.hpp through sweep_nonlinear().
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Motor and load with a gear stage of 21 and 83 teeth between them: 83/3 turns of the motor are a cycle, in which an order
/// of the load is harmonic 7 and an order of the motor 83/3 harmonics.
struct Drive {
  Harmonic motor{12.0, 40.0, 0.0};
  bool motor_feedback = false, load_feedback = false;

  System build() const {
    const double speed = rpm(4000.0), cosine = std::cos(deg(20.0));
    Model m("drive");
    for (const char* node : {"rotor", "pinion", "wheel", "load"}) m.add_node(node);
    m.add<Inertia>("J_r", {"rotor"}, {.inertia = 0.02});
    m.add<Inertia>("J_p", {"pinion"}, {.inertia = 0.0008});
    m.add<Inertia>("J_w", {"wheel"}, {.inertia = 0.03});
    m.add<Inertia>("J_l", {"load"}, {.inertia = 0.6});
    m.add<ShaftSpring>("input", {"rotor", "pinion"}, {.stiffness = 15000.0, .damping = 0.3});
    m.add<ShaftSpring>("output", {"wheel", "load"}, {.stiffness = 25000.0, .damping = 2.0});
    m.add<GearMesh>("mesh", {"pinion", "wheel"},
                    {.base_radius_1 = 0.021 * cosine,
                     .base_radius_2 = 0.083 * cosine,
                     .teeth_1 = 21,
                     .teeth_2 = 83,
                     .stiffness = 2e8,
                     .normal_backlash = 80e-6,
                     .damping = 900.0,
                     .damping_law = MeshDamping::always});
    m.add<EngineOrderTorque>("motor", {"rotor"},
                             {.harmonics = {motor}, .mean = 60.0, .twist_feedback = motor_feedback});
    m.add<EngineOrderTorque>(
        "brake", {"load"},
        {.harmonics = {{1.0, 20.0, 0.0}}, .mean = 60.0 * 83.0 / 21.0, .twist_feedback = load_feedback});
    m.set_reference("rotor", constant_speed(speed));
    return m.build();
  }
};

NonlinearSweep sweep_of(const Drive& drive, bool runs = false) {
  return sweep_nonlinear(
      drive.build(), {.speeds = {rpm(3990.0), rpm(4000.0)}, .sections = {"input.torque_Nm"}, .runs = runs});
}

/// The motion at 4000 rpm.
const SweptMotion& motion_of(const NonlinearSweep& sweep) {
  REQUIRE(sweep.branches.size() == 1);
  const auto& motions = sweep.branches[0].motions;
  const auto at = std::find_if(motions.begin(), motions.end(), [](const SweptMotion& motion) {
    return motion.asked && std::abs(motion.speed - rpm(4000.0)) < 1e-6;
  });
  REQUIRE(at != motions.end());
  return *at;
}

}  // namespace

TEST_CASE("A load order that is harmonic 332 of the cycle is in the motion, and among its orders",
          "[nonlinear_sweep][once]") {
  const NonlinearSweep sweep = sweep_of({});
  CHECK(sweep.turns == Approx(83.0 / 3.0));
  CHECK_FALSE(sweep.excess.found);
  const SweptMotion& motion = motion_of(sweep);
  CHECK(motion.stable);
  CHECK(motion.error < 1e-8);
  CHECK(motion.half_range()[0] == Approx(3.24787985).epsilon(1e-7));
  // Whole and half orders that are harmonics of the cycle, and that of the load.
  const std::vector<double> orders{21.0 / 83.0, 3.0, 6.0, 9.0, 12.0};
  REQUIRE(sweep.orders.size() == orders.size());
  const std::vector<double> amplitudes{1.864464529, 0.0, 0.0, 0.0, 1.3834374954};
  for (std::size_t k = 0; k < orders.size(); ++k) {
    CHECK(sweep.orders[k] == Approx(orders[k]));
    CHECK(std::abs(motion.amplitude(static_cast<Eigen::Index>(k), 0)) ==
          Approx(amplitudes[k]).epsilon(1e-8).margin(1e-8));
  }
}

TEST_CASE("A small load order beyond a motion's harmonics is in its error until there are enough",
          "[nonlinear_sweep]") {
  const NonlinearSweep sweep = sweep_of({.motor = {12.0, 0.2, 0.0}});
  const SweptMotion& motion = motion_of(sweep);
  // The error is the difference from half as many, which lack it.
  CHECK(motion.harmonics >= 332);
  CHECK(motion.error < 2e-4);
  CHECK(motion.half_range()[0] == Approx(1.8713619920).epsilon(1e-7));
  // With few harmonics, at a tolerance that allows it, the error is the share of order 12, 0.0069 of 61.9 N m.
  const NonlinearSweep coarse = sweep_nonlinear(
      Drive{.motor = {12.0, 0.2, 0.0}}.build(),
      {.speeds = {rpm(3990.0), rpm(4000.0)}, .sections = {"input.torque_Nm"}, .tolerance = 0.01});
  const SweptMotion& few = motion_of(coarse);
  CHECK(few.harmonics < 332);
  CHECK(few.error == Approx(0.0069171874 / 61.864).epsilon(1e-3));
}

TEST_CASE("A load that follows the twist leaves a high order in the motion", "[nonlinear_sweep][once]") {
  const NonlinearSweep sweep = sweep_of({.motor = {6.0, 4.0, 0.0}, .motor_feedback = true});
  // What the twist of 1e-3 rad changes of the load is a few thousandths of it.
  CHECK(motion_of(sweep).half_range()[0] == Approx(8.3088405223).epsilon(5e-3));
}

TEST_CASE("Where the loads' highest harmonic takes too many rows, no curve is stated, and a run tells it",
          "[nonlinear_sweep][once]") {
  const Drive drive{.motor = {24.0, 200.0, 0.0}, .motor_feedback = true, .load_feedback = true};
  const NonlinearSweep sweep = sweep_of(drive, true);
  CHECK(sweep.branches.empty());
  CHECK(sweep.excess.found);
  CHECK(sweep.excess.needed == 664);
  CHECK(sweep.excess.most < 664);
  // Order 24 has 1.1694 N m of the input shaft beside 1.8645 N m, and 153.0 N of the mesh beside 98.2 N.
  CHECK(sweep.excess.left_out == Approx(153.0425 / std::hypot(153.0425, 98.2047)).epsilon(1e-3));
  REQUIRE(sweep.runs.size() == 2);
  const SweptRun& run = sweep.runs[1];
  REQUIRE(run.reason.empty());
  CHECK(0.5 * (run.highest[0] - run.lowest[0]) == Approx(3.0338582253).epsilon(5e-3));
  CHECK(worst_motions(sweep).by_runs.size() == 2);
}

TEST_CASE("A cycle that is given and in which a load does not repeat gives no curve", "[nonlinear_sweep]") {
  const NonlinearSweep sweep = sweep_nonlinear(
      Drive{}.build(),
      {.speeds = {rpm(3990.0), rpm(4000.0)}, .sections = {"input.torque_Nm"}, .turns = 1.0, .runs = false});
  CHECK(sweep.branches.empty());
  CHECK(sweep.excess.found);
  CHECK(sweep.excess.needed == 0);
}
