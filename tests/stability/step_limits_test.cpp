// Limits of the conditionally stable methods, with and without damping. A step above the limit is
// refused with the limit named, or grows without bound.
#include <drev/elements/ground_spring.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/shaft_spring.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <Eigen/Dense>

#include "tests/catch.hpp"
#include "tests/stability/amplification.hpp"

using namespace drev;
using namespace drev::problems;

namespace {

/// True if a step of omega h neither is refused nor amplifies.
bool stable(const std::string& method, double omega_h, double xi) {
  try {
    // Away from its limit every method here has a radius below 1 - 1e-9 or exactly 1.
    return spectral_radius(amplification(method, omega_h, xi)) < 1.0 + 1e-9;
  } catch (const ModelError&) {
    return false;
  }
}

double limit(const std::string& method, double xi) {
  double low = 1.0, high = 10.0;
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (stable(method, middle, xi) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// n discs J in a row, springs k, the first tied to ground by another spring.
System chain(int n, double inertia, double stiffness) {
  Model m("chain");
  for (int i = 0; i < n; ++i) {
    const std::string node = "n" + std::to_string(i), before = "n" + std::to_string(i - 1);
    m.add_node(node);
    m.add<Inertia>("J" + node, {node}, {.inertia = inertia});
    if (i == 0)
      m.add<GroundSpring>("ground", {node}, {.stiffness = stiffness});
    else
      m.add<ShaftSpring>("k" + node, {before, node}, {.stiffness = stiffness});
  }
  m.set_initial("n" + std::to_string(n - 1), 1.0, 0.0);
  return m.build();
}

}  // namespace

TEST_CASE("Stability limits of Newmark's methods: the closed form, with and without damping") {
  // omega h = [xi (g - 1/2) + sqrt(g/2 - b + xi^2 (g - 1/2)^2)]/(g/2 - b). Hughes 2000, 9.1. Where damping
  // moves the limit, steps between it and the undamped one may be refused.
  struct Row {
    const char* method;
    double xi, limit, undamped = limit;
  };
  for (const Row& row : {Row{"central_difference", 0.0, 2.0},
                         {"central_difference", 0.05, 2.0},
                         {"central_difference", 0.5, 2.0},
                         {"newmark:0.08333333333333333,0.5", 0.0, 2.449489742783178},
                         {"linear_acceleration", 0.0, 3.464101615137755},
                         {"linear_acceleration", 0.1, 3.464101615137755},
                         {"newmark:0.2,0.5", 0.0, 4.472135954999579},
                         {"newmark:0,0.6", 0.0, 1.825741858350554},
                         {"newmark:0,0.6", 0.05, 1.842484596009872, 1.825741858350554}}) {
    INFO(row.method << ", xi = " << row.xi);
    const double found = limit(row.method, row.xi);
    CHECK(found < row.limit * (1.0 + 1e-7));
    CHECK(found > row.undamped * (1.0 - 1e-7));
  }
}

TEST_CASE("Unconditional methods have no limit") {
  for (const char* method : {"average_acceleration", "newmark:0.3025,0.6", "hht:0.05", "hht:0.3",
                             "generalized_alpha:1", "generalized_alpha:0.8", "generalized_alpha:0", "bathe:0",
                             "bathe:0.8", "bathe:1", "tr_bdf2", "sdirk4"})
    for (const double xi : {0.0, 0.05, 0.9})
      for (double omega_h = 0.1; omega_h < 5e3; omega_h *= 3.0) {
        INFO(method << ", xi = " << xi << ", omega h = " << omega_h);
        CHECK(spectral_radius(amplification(method, omega_h, xi)) < 1.0 + 1e-9);
      }
}

TEST_CASE("Central difference on a chain of ten discs: stable to 2/omega_max, not beyond") {
  // omega_max = 2 sqrt(k/J) cos(pi/21), h = 2/omega_max = 0.010112953333155; a single element's bound,
  // 2/sqrt(4 k/J) = 0.01, is on the safe side by 1.1 %.
  const System system = chain(10, 0.1, 1000.0);
  const ModeSet modes = solve_modes(system, {.count = 10});
  CHECK(modes.omega(9) == Approx(197.7661652450257).epsilon(1e-12));
  const double critical = 0.010112953333155;
  const auto run = [&](double h) {
    State state = State::initial(system);
    const RunSummary summary = simulate(
        system,
        {.scheme = step_scheme("central_difference"), .step = h, .t_end = 5000 * h, .energy_tolerance = 1e9},
        state);
    return std::pair{summary, state.z.lpNorm<Eigen::Infinity>()};
  };
  const auto [below, largest] = run(0.9999 * critical);
  CHECK(below.ok());
  CHECK(largest < 100.0);  // bounded: near the limit the energy is not positive definite by much
  try {
    const RunSummary above = run(1.0001 * critical).first;
    CHECK(above.status == RunStatus::unstable);
    CHECK(above.t_end < 5000 * critical);
  } catch (const ModelError& refused) {
    CHECK(std::string(refused.what()).find("0.0101129") != std::string::npos);
  }
}
