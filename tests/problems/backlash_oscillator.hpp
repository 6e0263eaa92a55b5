#pragma once
/// Published cases 7 and 8: a disc of 5 kg m^2 on a stop of 2e4 N m/rad with a gap, let go at pi/2.
#include <drev/core/assembler.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>

#include <vector>

#include "tests/problems/twist_backlash.hpp"

/// damping [N m s/rad], limited to the spring's force; gap: total [rad].
inline drev::System backlash_oscillator(double damping, double gap) {
  drev::Model m("oscillator");
  m.add_node("disc");
  m.add<drev::Inertia>("J", {"disc"}, {.inertia = 5.0});
  m.add<drev::LawElement<TwistBacklash>>(
      "stop", {"disc"},
      TwistBacklash{
          drev::BacklashLaw(
              {.normal_backlash = gap, .damping = damping, .damping_law = drev::MeshDamping::limited}),
          2e4});
  m.set_initial("disc", drev::kPi / 2, 0.0);
  return m.build();
}

/// Case 7, damping 50, gap pi/4 (Modelica Standard Library): t [s], angle [rad], speed [rad/s].
inline constexpr double kCase7[4][3] = {{0.1, 0.2498358550, 52.8937186},
                                        {0.25, 0.5808155699, 30.0804578},
                                        {0.5, -0.3099580355, -17.2284257},
                                        {1.0, -0.1555814136, -7.0229373}};

/// Times at which the speed of the first unknown changes sign, placed linearly in the step.
class Reversals final : public drev::Observer {
 public:
  void start(const drev::Assembler&, const drev::EvaluatedState&) override {}
  void step(const drev::Assembler&, const drev::EvaluatedState& from,
            const drev::EvaluatedState& to) override {
    const double v0 = from.state.v[0], v1 = to.state.v[0];
    if (v0 * v1 < 0.0) times.push_back(from.state.t + (to.state.t - from.state.t) * v0 / (v0 - v1));
  }
  std::vector<double> times;
};
