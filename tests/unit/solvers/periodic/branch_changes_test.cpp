// Speeds at which curves of a train with a bent spring fold or double their period, and their stated errors, against a
// separate program: shooting over the closed form of each straight piece, for fixed points with 1 + tr P + det P = 0 (a
// multiplier of -1) or 1 - tr P + det P = 0 (+1) of the period map's derivative P, to 1e-6 rpm.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/elements/polyline_spring.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Period doublings lie within their stated errors, whatever the harmonics of the curve",
          "[nonlinear_sweep]") {
  Model m("clutch");
  m.add_node("flywheel");
  m.add_node("hub");
  m.constant_speed("flywheel", rpm(1000));
  m.add<Inertia>("J", {"hub"}, {.inertia = 0.1});
  m.add<PolylineSpring>("clutch", {"flywheel", "hub"},
                        {.x = {deg(-8), deg(-3), 0.0, deg(2), deg(10)},
                         .y = {-420.0, -20.0, 0.0, 10.0, 490.0},
                         .damping = 1.0});
  m.add<EngineOrderTorque>("torque", {"hub"},
                           {.harmonics = {{.order = 2.0, .amplitude = 60.0, .phase = deg(30)}},
                            .mean = 5.0,
                            .twist_feedback = false});
  NonlinearSweepOptions options{.threads = 1};
  for (int n = 200; n <= 1000; n += 20) options.speeds.push_back(rpm(n));
  const NonlinearSweep sweep = sweep_nonlinear(m.build(), options);
  struct Right {
    BranchChange kind;
    double rpm;
  };
  for (const auto& [kind, right] :
       {Right{BranchChange::period_doubling, 245.120587}, Right{BranchChange::period_doubling, 268.522465},
        Right{BranchChange::period_doubling, 300.030254}, Right{BranchChange::period_doubling, 639.512196},
        Right{BranchChange::period_doubling, 897.504973}, Right{BranchChange::fold, 330.0896490},
        Right{BranchChange::fold, 210.9112984}}) {
    CAPTURE(right, to_text(kind));
    const SweptChange* nearest = nullptr;
    for (const SweptChange& change : sweep.changes)
      if (change.kind == kind &&
          (!nearest || std::abs(to_rpm(change.speed) - right) < std::abs(to_rpm(nearest->speed) - right)))
        nearest = &change;
    REQUIRE(nearest);
    CHECK(to_rpm(nearest->error) < 2e-4);
    CHECK(std::abs(to_rpm(nearest->speed) - right) <= to_rpm(nearest->error) + 1e-6);
  }
}
