// A law whose stored energy follows the time: what moves it puts work into the train.
#include <drev/core/law_element.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// y = k (1 + 0.3 sin(50 t)) x + c x'.
struct Pulsing {
  static constexpr bool varies = true;
  double k = 1e3, c = 0.0;
  ScalarResponse operator()(const ScalarInput& in) const {
    const double now = k * (1.0 + 0.3 * std::sin(50.0 * in.t));
    return {.y = now * in.x + c * in.x_dot,
            .dy_dx = now,
            .dy_dx_dot = c,
            .stored_energy = 0.5 * now * in.x * in.x,
            .dissipated_power = c * in.x_dot * in.x_dot};
  }
};

System swinging(double damping) {
  Model m("pulsing");
  m.add_node("x");
  m.add<Inertia>("J", {"x"}, {.inertia = 1.0});
  m.add<LawElement<Pulsing>>("spring", {"x"}, {.c = damping});
  m.set_initial("x", 0.05, 0.0);
  return m.build();
}

}  // namespace

TEST_CASE("A law that follows the time: work is change of stored energy and dissipation, in every method") {
  for (const double damping : {0.0, 4.0}) {
    const System system = swinging(damping);
    State exact = State::initial(system), stepped = exact;
    const RunSummary by_series = propagate(system, {.tolerance = 1e-11, .t_end = 1.0}, exact);
    const RunSummary by_steps = simulate(
        system, {.scheme = step_scheme("dormand_prince"), .tolerance = 1e-10, .t_end = 1.0}, stepped);
    for (const RunSummary* run : {&by_series, &by_steps}) {
      CHECK(run->status == RunStatus::success);
      const EnergyBalance& b = run->energy;
      CHECK(b.start == Approx(1.25));
      CHECK(b.input == Approx(b.kinetic + b.stored - b.start + b.dissipated).epsilon(1e-6));
      CHECK(std::abs(b.input) > 0.05);
    }
    if (damping == 0.0) CHECK(exact.z[0] == Approx(0.046172102).epsilon(1e-7));  // scipy, DOP853, 1e-12
    CHECK(stepped.z[0] == Approx(exact.z[0]).epsilon(1e-6));
    CHECK(by_steps.energy.input == Approx(by_series.energy.input).epsilon(1e-6));
    CHECK(by_steps.energy.dissipated == Approx(by_series.energy.dissipated).epsilon(1e-6));
  }
}
