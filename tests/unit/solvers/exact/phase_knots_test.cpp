// A stepped mesh stiffness whose phase follows a node with a given motion of its own.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Exact propagation ends its steps at knots of a phase that a given motion moves") {
  // The pinion turns at 20 rad/s and is given 0.2 rad/s on top: without it in the phase, each knot would be
  // sought 1 % late, and the jump of the stiffness there would cost some thirty short steps each.
  Model m("given phase");
  for (const char* node : {"pinion", "wheel"}) m.add_node(node);
  m.set_reference("pinion", constant_speed(20.0));
  m.given_motion("pinion", {.at =
                                [](double t) {
                                  return MotionPoint{0.2 * t, 0.2, 0.0};
                                },
                            .piecewise_quadratic = true});
  m.add<Inertia>("J", {"wheel"}, {.inertia = 1.0});
  m.add<GearMesh>("mesh", {"pinion", "wheel"},
                  {.base_radius_1 = 1.0,
                   .base_radius_2 = 1.0,
                   .teeth_1 = 20,
                   .teeth_2 = 20,
                   .stiffness = MeshStiffness::step(80.0, 120.0, 1.6)});
  m.add<AppliedTorque>("load", {"wheel"}, {.table = TimeTable({0.0}, {3.0})});
  const System system = m.build();
  const RunSummary run = propagate(system, {.tolerance = 1e-10, .t_end = 1.0});
  INFO(run.brief_report());
  CHECK(run.ok());
  const double knots = 2.0 * 20.0 * 20.2 / kTwoPi;
  CHECK(static_cast<double>(run.steps) < 1.5 * knots);
}

TEST_CASE("The peak of a mesh force beside a jump of its stiffness is found where it is") {
  // One inertia on a mesh of 120 N/m for 0.6 of the tooth's period, then 80 N/m: the deflection falls at the end of the
  // period, where the stiffness jumps to 120 N/m again, so that the largest force stands right behind that jump, or
  // right before the first.
  // Rounding puts the step's end on either side of the jump: several periods see both.
  const double torque = 3.0, stiff = 120.0, soft = 80.0;
  for (double period = 0.42; period < 0.44; period += 0.0007) {
    INFO("period " << period << " s");
    const double change = 0.6 * period;
    Model m("jump of stiffness");
    for (const char* node : {"pinion", "wheel"}) m.add_node(node);
    m.set_reference("pinion", constant_speed(kTwoPi / 20.0 / period));
    m.given_motion("pinion", {.at = [](double) { return MotionPoint{}; }, .piecewise_quadratic = true});
    m.add<Inertia>("J", {"wheel"}, {.inertia = 1.0});
    m.add<GearMesh>("mesh", {"pinion", "wheel"},
                    {.base_radius_1 = 1.0,
                     .base_radius_2 = 1.0,
                     .teeth_1 = 20,
                     .teeth_2 = 20,
                     .stiffness = MeshStiffness::step(soft, stiff, 1.6)});
    m.add<AppliedTorque>("load", {"wheel"}, {.table = TimeTable({0.0}, {torque})});
    const System system = m.build();

    const double w_1 = std::sqrt(stiff), w_2 = std::sqrt(soft), rest = period - change;
    const double x = torque / stiff * (1.0 - std::cos(w_1 * change)),
                 v = torque / w_1 * std::sin(w_1 * change);
    const double there =
        torque / soft + (x - torque / soft) * std::cos(w_2 * rest) + v / w_2 * std::sin(w_2 * rest);
    Peaks peaks(find_channels(system, {"mesh.force_N"}));
    REQUIRE(propagate(system, {.tolerance = 1e-13, .t_end = 1.03 * period}, {&peaks}).ok());
    CHECK(peaks.peaks()[0].amplitude() == Approx(stiff * std::max(x, there)).epsilon(1e-12));
    CHECK(peaks.peaks()[0].time() == Approx(there > x ? period : change).epsilon(1e-12));
  }
}
