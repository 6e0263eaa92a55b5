/// Energy of modes by element against closed forms of two free discs.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/damped_modes.hpp>

#include <algorithm>

#include "tests/catch.hpp"

using namespace drev;

namespace {

double share(const ModeEnergy& energy, const Eigen::MatrixXd& shares, const std::string& element) {
  const auto found = std::find(energy.elements.begin(), energy.elements.end(), element);
  REQUIRE(found != energy.elements.end());
  return shares(found - energy.elements.begin(), 0);
}

}  // namespace

TEST_CASE("Two free discs on two shafts side by side: shares of energy", "[mode_energy]") {
  const double j_1 = 2.0, j_2 = 3.0, k_1 = 500.0, k_2 = 300.0, c_1 = 0.4, alpha = 0.3, beta = 1e-3;
  Model m("discs");
  m.add_node("a"), m.add_node("b");
  m.add<Inertia>("J_1", {"a"}, {.inertia = j_1});
  m.add<Inertia>("J_2", {"b"}, {.inertia = j_2});
  m.add<ShaftSpring>("first", {"a", "b"}, {.stiffness = k_1, .damping = c_1});
  m.add<ShaftSpring>("second", {"a", "b"}, {.stiffness = k_2});
  m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = alpha, .beta_stiffness = beta});
  const System system = m.build();
  const ModeEnergy energy = mode_energy(system, solve_damped_modes(system));
  REQUIRE(energy.kinetic.cols() == 1);
  CHECK(energy.elements.size() == 5);
  // Amplitudes as 1/J, so that the kinetic energies are as 1/J, too.
  CHECK(share(energy, energy.kinetic, "J_1") == Approx(j_2 / (j_1 + j_2)).epsilon(1e-10));
  CHECK(share(energy, energy.kinetic, "J_2") == Approx(j_1 / (j_1 + j_2)).epsilon(1e-10));
  CHECK(share(energy, energy.elastic, "first") == Approx(k_1 / (k_1 + k_2)).epsilon(1e-12));
  CHECK(share(energy, energy.elastic, "second") == Approx(k_2 / (k_1 + k_2)).epsilon(1e-12));
  // a M of the relative motion is a times the reduced inertia.
  const double rayleigh = alpha * j_1 * j_2 / (j_1 + j_2) + beta * (k_1 + k_2);
  CHECK(share(energy, energy.dissipated, "first") == Approx(c_1 / (c_1 + rayleigh)).epsilon(1e-10));
  CHECK(share(energy, energy.dissipated, "rayleigh") == Approx(rayleigh / (c_1 + rayleigh)).epsilon(1e-10));
}

TEST_CASE("An open contact has no energy, a closed one has", "[mode_energy]") {
  Model m("mesh");
  m.add_node("a"), m.add_node("b"), m.add_node("c");
  m.add<Inertia>("J_a", {"a"}, {.inertia = 0.01});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 0.04});
  m.add<Inertia>("J_c", {"c"}, {.inertia = 0.04});
  m.add<ShaftSpring>("shaft", {"b", "c"}, {.stiffness = 1e4});
  m.add<GearMesh>("mesh", {"a", "b"},
                  {.base_radius_1 = 0.05,
                   .base_radius_2 = 0.1,
                   .stiffness = 1e8,
                   .normal_backlash = 1e-4,
                   .damping = 2000.0});
  const System system = m.build();
  const ModeEnergy closed = mode_energy(system, solve_damped_modes(system));
  REQUIRE(closed.elastic.cols() == 2);
  for (Eigen::Index j = 0; j < 2; ++j) CHECK(closed.elastic.col(j).sum() == Approx(1.0));
  CHECK(share(closed, closed.dissipated, "mesh") == Approx(1.0));
  const ModeEnergy open = mode_energy(system, solve_damped_modes(system, {.contact = Contact::open}));
  CHECK(std::find(open.elements.begin(), open.elements.end(), "mesh") == open.elements.end());
  CHECK(share(open, open.elastic, "shaft") == Approx(1.0));
  CHECK(open.dissipated.isZero(0.0));
}
