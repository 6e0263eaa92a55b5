// The four damping laws of a gear mesh compared (docs/catalogue.md): one gear pair, hammered by a cyclic
// torque.
//   build/release/bin/bench_mesh_laws
#include <drev/core/assembler.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <cstdio>

#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr double kRadius = 0.25, kInertia = 6.5, kStiffness = 8e8, kGap = 0.15e-3;  // SI

/// Gear 1 at constant speed; gear 2 with a cyclic torque that makes it knock. xi: with the flanks closed.
System gear_pair(MeshDamping law, double xi) {
  const double mass = kInertia / (kRadius * kRadius);
  Model m("gear pair");
  m.add_node("driver");
  m.add_node("gear");
  m.add<Inertia>("J_driver", {"driver"}, {.inertia = 1.0});
  m.add<Inertia>("J_gear", {"gear"}, {.inertia = kInertia});
  m.add<GearMesh>("mesh", {"driver", "gear"},
                  {.base_radius_1 = kRadius,
                   .base_radius_2 = kRadius,
                   .stiffness = kStiffness,
                   .normal_backlash = kGap,
                   .damping = 2.0 * xi * std::sqrt(kStiffness * mass),
                   .damping_law = law});
  m.add<EngineOrderTorque>("load", {"gear"}, {.harmonics = {{9, 6000, 0}}, .mean = -2000});
  m.constant_speed("driver", rpm(375));
  return m.build();
}

/// Largest force that pulls, largest force in the gap, largest jump of the force from one step to the next.
class Faults final : public Observer {
 public:
  void start(const Assembler&, const EvaluatedState&) override {}
  void step(const Assembler&, const EvaluatedState& from, const EvaluatedState& to) override {
    const double x = to.inputs[0].x, y = to.responses[0].y, half = 0.5 * kGap;
    if (std::abs(x) > half) pull = std::max(pull, -y * (x > 0 ? 1 : -1));
    if (std::abs(x) < half) in_gap = std::max(in_gap, std::abs(y));
    jump = std::max(jump, std::abs(y - from.responses[0].y));
  }
  double pull = 0.0, in_gap = 0.0, jump = 0.0;
};

struct Outcome {
  double angle = 0.0;
  RunSummary run;
  Faults faults;
};

Outcome run(MeshDamping law, double xi, double step, double t_end) {
  Outcome out;
  const System system = gear_pair(law, xi);
  Recorder r(system, {"gear.angle_rad"}, t_end);
  out.run = simulate(system, {.step = step, .t_end = t_end}, {&r, &out.faults});
  out.angle = r.samples(0).back();
  return out;
}

}  // namespace

TEST_CASE("Damping laws of a gear mesh") {
  const double t_end = 0.05;
  for (const double xi : {0.05, 0.3}) {
    std::printf(
        "xi = %g\n| law | halved steps | pulls [N] | in the gap [N] | jump in a step [N] | "
        "error at 8 us [rad] | 4 us | 2 us | 1 us | energy error at 2 us |\n",
        xi);
    for (const auto& [name, law] : {std::pair{"proportional", MeshDamping::proportional},
                                    {"limited", MeshDamping::limited},
                                    {"contact_only", MeshDamping::contact_only},
                                    {"always", MeshDamping::always}}) {
      const double exact = run(law, xi, 2e-8, t_end).angle;
      const Outcome o = run(law, xi, 2e-6, t_end);
      std::printf("| %s | %ld | %.3g | %.3g | %.3g |", name, o.run.halved, o.faults.pull, o.faults.in_gap,
                  o.faults.jump);
      for (const double h : {8e-6, 4e-6, 2e-6, 1e-6})
        std::printf(" %.1e |", std::abs(run(law, xi, h, t_end).angle - exact));
      std::printf(" %.1e |\n", o.run.energy.relative_error());
    }
  }
}
