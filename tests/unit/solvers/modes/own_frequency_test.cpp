/// Modes of trains with a complex stiffness against closed forms and plain springs; solvers/modes/own_frequency.hpp,
/// solvers/modes/damped_pairs.hpp and solvers/linear/complex_stiffnesses.hpp through solve_modes() and solve_damped_modes().
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>
#include <string>

#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr double kMotor = 1.0, kLoad = 3.0, kReduced = kMotor * kLoad / (kMotor + kLoad);

ViscoelasticStiffness::Params rubber(double stiffness, double loss_factor, double highest_frequency) {
  return {.stiffness = stiffness,
          .loss_factor = loss_factor,
          .lowest_frequency = 40,
          .highest_frequency = highest_frequency,
          .permitted_error = 2.0};
}

Model two_inertias(const ViscoelasticStiffness::Params& material) {
  Model m("genset");
  m.add_node("motor"), m.add_node("load");
  m.add<Inertia>("J_motor", {"motor"}, {.inertia = kMotor});
  m.add<Inertia>("J_load", {"load"}, {.inertia = kLoad});
  m.add<ElasticCoupling>("coupling", {"motor", "load"}, {.material = material});
  return m;
}

/// A chain with a coupling in its middle, or a spring of the same stiffness.
System long_chain(int n, bool coupled) {
  Model m("chain");
  for (int i = 0; i < n; ++i) {
    const std::string before = "n" + std::to_string(i - 1), node = "n" + std::to_string(i);
    m.add_node(node);
    m.add<Inertia>("J" + node, {node}, {.inertia = 0.5 + 0.1 * (i % 3)});
    if (i == n / 2 && coupled)
      m.add<ElasticCoupling>("coupling", {before, node}, {.material = rubber(3e4, 0.1, 80)});
    else if (i > 0)
      m.add<ShaftSpring>("k" + node, {before, node}, {.stiffness = i == n / 2 ? 3e4 : 1e6});
  }
  return m.build();
}

}  // namespace

TEST_CASE("A coupling with a loss factor: one mode, whatever the chain in time", "[own_frequency]") {
  // Over a decade the chain of a loss factor of 0.5 has no static stiffness at all.
  for (const auto& [eta, highest] : {std::pair{0.1, 80.0}, {0.5, 400.0}, {2.0, 400.0}}) {
    const System system = two_inertias(rubber(1e5, eta, highest)).build();
    const double w = std::sqrt(1e5 / kReduced);
    CHECK(elastic_mode_count(system, Contact::closed) == 1);
    const ModeSet modes = solve_modes(system);
    REQUIRE(modes.count() == 1);
    CHECK(modes.omega(0) == Approx(w).epsilon(1e-13));
    CHECK(modes.shapes(system.node("load"), 0) / modes.shapes(system.node("motor"), 0) ==
          Approx(-kMotor / kLoad).epsilon(1e-12));
    CHECK(modes.vectors.rows() == system.size());
    // lambda^2 = -w^2 (1 + i eta).
    const DampedModeSet damped = solve_damped_modes(system);
    REQUIRE(damped.modes.size() == 1);
    const std::complex<double> i(0.0, 1.0), lambda = i * w * std::sqrt(1.0 + i * eta);
    CHECK(std::abs(damped.modes[0].lambda - lambda) < 1e-11 * w);
    REQUIRE(damped.real_lambda.size() == 1);
    CHECK(std::abs(damped.real_lambda[0]) < 1e-12 * w);
  }
  // In time the chain's internal nodes have modes, or rates, of their own.
  const System octave = two_inertias(rubber(1e5, 0.1, 80)).build();
  CHECK(solve_damped_modes(octave, {.in_time = true}).real_lambda.size() > 1);
}

TEST_CASE("Stiffness that follows the frequency: that of each mode's own", "[own_frequency]") {
  ViscoelasticStiffness::Params material = rubber(kNotGiven, 0.0, 80);
  material.frequencies = {0.0, 100.0}, material.stiffnesses = {8e4, 1.6e5},
  material.loss_factors = {0.1, 0.2};
  const System system = two_inertias(material).build();
  // J w^2 = a + b w, and with loss J lambda^2 = -k*(Im lambda).
  const double a = 8e4, b = 8e4 / hz(100.0);
  const double w = (b + std::sqrt(b * b + 4.0 * kReduced * a)) / (2.0 * kReduced);
  CHECK(solve_modes(system).omega(0) == Approx(w).epsilon(1e-12));
  const std::complex<double> lambda = solve_damped_modes(system).modes.at(0).lambda;
  const double k = a + b * lambda.imag(), eta = 0.1 + 0.1 * lambda.imag() / hz(100.0);
  CHECK(std::abs(kReduced * lambda * lambda + k * std::complex<double>(1.0, eta)) < 1e-10 * k);
}

TEST_CASE("Two couplings side by side and a damper's ring: shares of energy and heat", "[own_frequency]") {
  Model m = two_inertias(rubber(1e5, 0.1, 80));
  m.add<ElasticCoupling>("beside", {"motor", "load"}, {.material = rubber(5e4, 0.3, 80)});
  const System system = m.build();
  const DampedModeSet modes = solve_damped_modes(system);
  const ModeEnergy energy = mode_energy(system, modes);
  REQUIRE(energy.elements == std::vector<std::string>{"J_motor", "J_load", "coupling", "beside"});
  CHECK(energy.elastic(2, 0) == Approx(2.0 / 3.0).epsilon(1e-12));
  CHECK(energy.dissipated(2, 0) == Approx(1e4 / (1e4 + 1.5e4)).epsilon(1e-12));
  CHECK(energy.kinetic(0, 0) == Approx(kLoad / (kMotor + kLoad)).epsilon(1e-10));

  Model ring("ring");
  ring.add_node("hub"), ring.hold("hub");
  ring.add<TorsionalDamper>("damper", {"hub"}, {.ring_inertia = 0.2, .spring = rubber(0.2 * 1e6, 0.2, 400)});
  const System held = ring.build();
  const ModeSet one = solve_modes(held);
  REQUIRE(one.count() == 1);
  CHECK(one.omega(0) == Approx(1000.0).epsilon(1e-12));
  CHECK(solve_damped_modes(held).modes.at(0).natural_frequency_Hz ==
        Approx(to_hz(1000.0) * std::pow(1.04, 0.25)).epsilon(1e-11));
}

TEST_CASE("A coupling in a chain, small and large: the modes with a spring in its place", "[own_frequency]") {
  for (const int n : {12, 600}) {
    const System with_coupling = long_chain(n, true), with_spring = long_chain(n, false);
    const ModeSet coupled = solve_modes(with_coupling, {.count = 8}),
                  plain = solve_modes(with_spring, {.count = 8});
    for (int m = 0; m < 8; ++m) CHECK(coupled.omega(m) == Approx(plain.omega(m)).epsilon(1e-11));
    for (const std::string& node : with_spring.node_names())
      CHECK((coupled.shapes.row(with_coupling.node(node)).cwiseAbs() -
             plain.shapes.row(with_spring.node(node)).cwiseAbs())
                .cwiseAbs()
                .maxCoeff() < 1e-7);
  }
}
