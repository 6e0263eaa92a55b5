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
#include "tests/problems/driven_gear.hpp"

using namespace drev;

TEST_CASE("Ends of a tongue with a multiplier of +1 are branchings, where the closed form has them",
          "[nonlinear_sweep][once]") {
  // x'' + c x' + k(wt) x = 1, k = 0.7 and 1.3 for half of the cycle each: the speeds near 1 at which the trace of the product
  // of both matrix exponentials allows a multiplier of 1, by a separate program.
  struct Row {
    double damping, low, high;
  };
  for (const Row& row :
       {Row{0.0, 0.9660320982012, 1.0108820016950}, {0.02, 0.9682793372932, 1.0085317969758}}) {
    const problems::DrivenGear gear{
        .stiffness = MeshStiffness::step(0.7, 1.3, 1.5), .damping = row.damping, .mean = 1.0};
    const NonlinearSweep sweep = sweep_nonlinear(
        gear.build(), {.speeds = {0.89, 0.95, 0.98, 1.0, 1.05, 1.1}, .tolerance = 1e-3, .runs = false});
    std::vector<double> ends;
    for (const SweptChange& change : sweep.changes) {
      CHECK(change.kind == BranchChange::branching);
      ends.push_back(change.speed);
    }
    std::sort(ends.begin(), ends.end());
    REQUIRE(ends.size() == 2);
    CHECK(ends[0] == Approx(row.low).margin(1e-9));
    CHECK(ends[1] == Approx(row.high).margin(1e-9));
  }
}

TEST_CASE("Period doublings lie within their stated errors, whatever the harmonics of the curve",
          "[nonlinear_sweep][once]") {
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
