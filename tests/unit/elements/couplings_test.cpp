// ElasticCoupling, TorsionalDamper, AbsoluteDamper: terms, signs, data-sheet values, bad input.
#include <drev/core/element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/couplings/absolute_damper.hpp>
#include <drev/elements/couplings/elastic_coupling.hpp>
#include <drev/elements/couplings/torsional_damper.hpp>

#include <cmath>

#include "core/dense/factorization.hpp"
#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

TEST_CASE("A coupling without loss is a shaft, with loss it brings its chain") {
  const ElasticCoupling plain({.material = {.stiffness = 2e5}, .damping = 3.0});
  CHECK(check_element(plain, 2).ok());
  const Terms terms = test::described(plain, 2);
  CHECK(terms.stiffness(0, 1) == -2e5);
  CHECK(terms.damping(1, 1) == 3.0);
  CHECK(terms.frequency_stiffnesses.empty());
  // Positive twist: positive torque.
  CHECK(terms.outputs[0].stiffness[1] == 2e5);

  const ElasticCoupling lossy(
      {.material = {.stiffness = 2e5, .loss_factor = 0.1, .lowest_frequency = 10, .highest_frequency = 30}});
  CHECK(check_element(lossy, 2).failures == std::vector<std::string>{});
  CHECK(lossy.internal_nodes().size() == lossy.spring().branches().size());
  CHECK(!lossy.internal_nodes().empty());
  // The matrices, condensed to the twist, are the chain.
  const Terms all = test::described(lossy, 2);
  const double w = kTwoPi * 20.0;
  const Eigen::MatrixXcd dynamic = all.stiffness.cast<std::complex<double>>() +
                                   std::complex<double>(0.0, w) * all.damping - w * w * all.mass;
  const Eigen::Index n = dynamic.rows() - 2;
  const Eigen::MatrixXcd inner = dynamic.bottomRightCorner(n, n);
  const std::complex<double> condensed =
      dynamic(1, 1) - (dynamic.block(1, 2, 1, n) * lu_solve(inner, dynamic.block(2, 1, n, 1)))(0, 0);
  CHECK(std::abs(condensed - lossy.spring().chain(w)) < 1e-9 * std::abs(condensed));
  const std::complex<double> whole =
      condensed + all.frequency_stiffnesses[0].stiffness->beyond_matrices(w, {});
  CHECK(std::abs(whole - std::complex<double>(2e5, 2e4)) < 1e-9 * std::abs(whole));
  const auto beside = all.frequency_stiffnesses[0].stiffness->beyond_held(w, {});
  REQUIRE(beside.has_value());
  CHECK(std::abs(dynamic(1, 1) + *beside - std::complex<double>(2e5, 2e4)) < 1e-9 * std::abs(whole));
  // Passive: it never gives power, at any frequency.
  for (double f = 0.1; f < 1e5; f *= 1.7) CHECK(lossy.spring().chain(kTwoPi * f).imag() > 0.0);
}

TEST_CASE("The chain's error over a band: wide bands are refused with the figure") {
  ViscoelasticStiffness::Params p{.stiffness = 1.0, .loss_factor = 0.1, .lowest_frequency = 10};
  double before = 0.0;
  for (const double high : {15.0, 30.0, 100.0}) {
    p.highest_frequency = high;
    const double error = ViscoelasticStiffness(p).fit_error();
    CHECK(error > before);
    before = error;
  }
  CHECK(before > 0.04);  // a decade: k grows by 0.147 k; the error is in both parts
  CHECK(before < 0.10);
  p.permitted_error = 0.03;
  CHECK(test::contains(test::findings(ElasticCoupling({.material = p})), "is off by"));
  const std::string text = test::findings(ElasticCoupling(
      {.material = {.stiffness = -1.0, .loss_factor = 3.0, .branches = 40, .permitted_error = 0.0},
       .damping = -2.0}));
  for (const char* part :
       {"stiffness", "loss_factor", "branches", "permitted_error", "lowest_frequency", "damping"})
    CHECK(test::contains(text, part));
}

TEST_CASE("Torsional damper: data-sheet values") {
  const TorsionalDamper tuned({.ring_inertia = 0.2, .natural_frequency = 100.0, .damping_ratio = 0.1});
  CHECK(tuned.stiffness() == Approx(0.2 * std::pow(kTwoPi * 100.0, 2)));
  CHECK(tuned.damping() == Approx(2.0 * 0.1 * 0.2 * kTwoPi * 100.0));
  CHECK(check_element(tuned, 1).ok());
  // Thin ring, outer film alone: shear mu R w/h on 2 pi R w at R: c = 2 pi mu R^3 w/h.
  const FluidFilm film{
      .viscosity = 10.0, .outer_radius = 0.15, .inner_radius = 0.1, .width = 0.03, .outer_gap = 5e-4};
  CHECK(film.damping() == Approx(kTwoPi * 10.0 * std::pow(0.15, 3) * 0.03 / 5e-4));
  // Both sides: integral of mu r^2 2 pi r dr/h, twice.
  FluidFilm sides = film;
  sides.outer_gap = 0.0;
  sides.side_gap = 4e-4;
  CHECK(sides.damping() ==
        Approx(2.0 *
               test::integral([](double r) { return 10.0 * kTwoPi * r * r * r / 4e-4; }, 0.1, 0.15, 20000)));
  const TorsionalDamper viscous({.hub_inertia = 0.1, .ring_inertia = 0.2, .film = film});
  CHECK(check_element(viscous, 1).ok());
  const Terms terms = test::described(viscous, 1);
  CHECK(terms.mass(0, 0) == 0.1);
  CHECK(terms.mass(1, 1) == 0.2);
  CHECK(terms.damping(1, 1) == Approx(film.damping()));
  CHECK(terms.outputs[0].damping[1] > 0.0);  // a ring ahead pulls the hub forward

  const std::string text =
      test::findings(TorsionalDamper({.hub_inertia = -1.0, .damping = 2.0, .damping_ratio = 0.1}));
  for (const char* part : {"hub_inertia", "ring_inertia", "give one of damping", "damping_ratio"})
    CHECK(test::contains(text, part));
  CHECK(test::contains(test::findings(TorsionalDamper({.ring_inertia = 1.0})),
                       "nothing else would turn the ring"));
}

TEST_CASE("An absolute damper acts on the deviation alone") {
  const AbsoluteDamper damper({.damping = 4.0});
  CHECK(check_element(damper, 1).ok());
  const Terms terms = test::described(damper, 1);
  CHECK(terms.damping(0, 0) == 0.0);
  CHECK(terms.deviation_damping(0, 0) == 4.0);
  CHECK(test::contains(test::findings(AbsoluteDamper({})), "damping"));
}
