// A stepped mesh stiffness whose phase follows a node with a given motion of its own.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

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
