/// Large models against closed forms: modes and motion of a chain of 1e5 inertias, counts, gears in a loop.
// Covers solvers/linear/huge_pages.hpp with arrays that are large enough for them.
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "solvers/linear/sturm_count.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr double kStiffness = 1000.0, kInertia = 0.5;

/// Held at one end.
Model held_chain(int n) {
  Model m("chain");
  for (int i = 0; i < n; ++i) {
    const std::string name = std::to_string(i);
    const NodeId node = m.add_node("n" + name);
    m.add<Inertia>("J" + name, {node}, {.inertia = kInertia});
    if (i == 0)
      m.add<GroundSpring>("k" + name, {node}, {.stiffness = kStiffness});
    else
      m.add<ShaftSpring>("k" + name, {NodeId{i - 1}, node}, {.stiffness = kStiffness});
  }
  return m;
}

double omega_of(int n, int mode) {
  return 2.0 * std::sqrt(kStiffness / kInertia) * std::sin((2 * mode - 1) * kPi / (4.0 * n + 2.0));
}

}  // namespace

TEST_CASE("Ten modes of a chain of 1e5 inertias", "[modes][large]") {
  const int n = 100000;
  const ModeSet modes = solve_modes(held_chain(n).build());
  REQUIRE(modes.count() == 10);
  CHECK(modes.summary.method == ModesMethod::lanczos);
  CHECK(modes.summary.sturm_count == 10);
  for (int j = 1; j <= 10; ++j) {
    // eps lambda_max/(2 lambda): what K's own rounding leaves
    const double bound = 1e-16 * 4.0 * kStiffness / kInertia / std::pow(omega_of(n, j), 2);
    CHECK(modes.omega(j - 1) == Approx(omega_of(n, j)).epsilon(bound));
  }
  // Shape j: sin((2 j - 1) pi i/(2 n + 1)), i = 1 ... n; the third one at a few nodes
  const auto exact = [n](int i) { return std::sin(5.0 * kPi * i / (2.0 * n + 1.0)); };
  const double scale = modes.shapes(n / 5 - 1, 2) / exact(n / 5);
  for (const int i : {1, 1000, 40000, 70000, n})
    CHECK(modes.shapes(i - 1, 2) == Approx(scale * exact(i)).margin(1e-5 * std::abs(scale)));
}

TEST_CASE("Sturm counts of a chain of 1e5 inertias", "[InertiaCounter][large]") {
  const int n = 100000;
  const System system = held_chain(n).build();
  const Vector stiffness = system.stiffness_values(), mass = system.mass_values();
  InertiaCounter counter(system.pattern(), stiffness, mass);
  for (const int below : {1, 500, 50000, 99999}) {
    const double s = 0.5 * (std::pow(omega_of(n, below), 2) + std::pow(omega_of(n, below + 1), 2));
    const SturmCount count = counter.count_below(s);
    if (count.trusted) CHECK(count.below == below);
    CHECK((count.trusted || below > 1));
  }
}

TEST_CASE("A chain of 1e5 inertias swings in one of its modes", "[transient][large]") {
  // Started in mode j, average acceleration turns it by 2 atan(omega h/2) a step, exactly.
  const int n = 100000, mode = 20000, steps = 50;
  Model model = held_chain(n);
  const auto shape = [&](int i) { return std::sin((2 * mode - 1) * kPi * (i + 1.0) / (2.0 * n + 1.0)); };
  for (int i = 0; i < n; ++i) model.set_initial(NodeId{i}, 1e-3 * shape(i), 0.0);
  const System system = model.build();
  const double h = 0.01, angle = 2.0 * std::atan(0.5 * h * omega_of(n, mode));
  State state = State::initial(system, 0.0);
  const RunSummary run = simulate(system, {.step = h, .t_end = steps * h}, state);
  CHECK(run.ok());
  CHECK(run.steps == steps);
  double worst = 0.0;
  for (int i = 0; i < n; ++i)
    worst = std::max(worst, std::abs(state.z[i] - 1e-3 * shape(i) * std::cos(steps * angle)));
  CHECK(worst < 1e-13);  // of 1e-3
}

TEST_CASE("Every spring of a long chain of gaps closes under a steady pull", "[transient][large]") {
  // At rest all are stretched by gap/2 + F/k. The slowest mode decays by exp(-0.074 t).
  const int n = 100;
  const double gap = 1e-3, pull = 5.0;
  Model m("gaps");
  for (int i = 0; i < n; ++i) {
    const std::string name = std::to_string(i);
    const NodeId node = m.add_node("n" + name, NodeKind::translational);
    m.add<Inertia>("m" + name, {node}, {.inertia = 0.5});
    const auto spring = PolylineSpring::dead_band(kStiffness, 0.5 * gap, 300.0);
    if (i == 0)
      m.add<PolylineSpring>("s" + name, {node}, spring);
    else
      m.add<PolylineSpring>("s" + name, {NodeId{i - 1}, node}, spring);
  }
  m.add<AppliedTorque>("pull", {NodeId{n - 1}}, {.torque = [=](double) { return pull; }});
  const System system = m.build();
  State state = State::initial(system, 0.0);
  const RunSummary run = simulate(system, {.step = 0.05, .t_end = 400.0, .energy_tolerance = 10.0}, state);
  CHECK(run.status == RunStatus::success);
  CHECK_FALSE(run.newton_on_contacts);
  for (const int i : {0, 17, n - 1})
    CHECK(state.z[i] == Approx((i + 1) * (0.5 * gap + pull / kStiffness)).epsilon(1e-6));
}
