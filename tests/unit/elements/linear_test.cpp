// Inertias, shafts, dashpots, ground springs, ideal gears, Rayleigh damping.
#include <drev/core/element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;
using namespace drev::test;

TEST_CASE("linear elements are sound") {
  CHECK(check_element(Inertia({.inertia = 0.012}), 1).text() == "");
  CHECK(check_element(ShaftSpring({.stiffness = 8.5e3, .damping = 0.5}), 2).text() == "");
  CHECK(check_element(Dashpot({.damping = 3.0}), 1).text() == "");
  CHECK(check_element(Dashpot({.damping = 3.0}), 2).text() == "");
  CHECK(check_element(GroundSpring({.stiffness = 2e4, .damping = 1.0}), 1).text() == "");
  CHECK(check_element(IdealGear({.ratio = -0.4}), 2).text() == "");
  CHECK(check_element(RayleighDamping({.alpha_mass = 2.0, .beta_stiffness = 1e-5}), 0).text() == "");
  CHECK(check_element(DistributedShaft({.shear_modulus = 8e10,
                                        .density = 7850,
                                        .outer_diameter = 0.1,
                                        .inner_diameter = 0.05,
                                        .length = 2.0,
                                        .segments = 5}),
                      2)
            .text() == "");
}

TEST_CASE("forgotten parameters are reported by name") {
  CHECK(findings(Inertia({})) == "place: inertia = NaN kg m^2, must be > 0 and finite");
  CHECK(contains(findings(ShaftSpring({})), "stiffness = NaN N m/rad"));
  CHECK(contains(findings(ShaftSpring({.stiffness = 1, .damping = -1})),
                 "damping = -1 N m s/rad, must be >= 0"));
  CHECK(contains(findings(Dashpot({})), "damping = NaN"));
  CHECK(contains(findings(GroundSpring({.stiffness = 0})), "stiffness = 0 N m/rad, must be > 0"));
  CHECK(contains(findings(IdealGear({})), "ratio = NaN"));
  CHECK(contains(findings(IdealGear({.ratio = 0})), "must not be 0"));
  CHECK(contains(findings(RayleighDamping({.alpha_mass = -1})), "alpha_mass = -1 1/s"));
}

TEST_CASE("shaft: a forward end b pulls a forward") {
  // k = 100, twist = 0.03 - 0.01 = 0.02 rad: 2 N m; rate 4 - 1 = 3 rad/s at c = 0.5: 1.5 N m.
  const Terms t = described(ShaftSpring({.stiffness = 100, .damping = 0.5}), 2);
  const Eigen::Vector2d q(0.01, 0.03), v(1, 4);
  const Eigen::Vector2d f = t.stiffness * q + t.damping * v;  // on the left side: f = -(torque on it)
  CHECK(f[0] == Approx(-3.5));
  CHECK(f[1] == Approx(3.5));
  REQUIRE(t.outputs.size() == 1);
  CHECK(t.outputs[0].stiffness.dot(q) + t.outputs[0].damping.dot(v) == Approx(3.5));
  CHECK(t.rayleigh);
}

TEST_CASE("dashpot and ground spring act against the node's own motion") {
  const Terms d = described(Dashpot({.damping = 3}), 1);
  CHECK(d.damping(0, 0) == 3.0);
  CHECK(d.speed_ratio_constraints.empty());
  const Terms pair = described(Dashpot({.damping = 3}), 2);
  CHECK(pair.damping(0, 1) == -3.0);
  CHECK(pair.outputs[0].damping[1] == 3.0);
  const Terms g = described(GroundSpring({.stiffness = 7, .damping = 2}), 1);
  CHECK(g.stiffness(0, 0) == 7.0);
  CHECK(g.damping(0, 0) == 2.0);
  REQUIRE(g.speed_ratio_constraints.size() == 1);
  CHECK(g.speed_ratio_constraints[0].b.size() == 1);
}

TEST_CASE("ideal gear: an external pair 20/50 turns back at 0.4") {
  const Terms t = described(IdealGear({.ratio = -0.4}), 2);
  REQUIRE(t.constraints.size() == 1);
  CHECK(t.constraints[0].dot(Eigen::Vector2d(1.0, -0.4)) == Approx(0.0).margin(1e-15));
}

TEST_CASE("distributed shaft") {
  // D = 0.2, d = 0, L = 2.5, G = 68e9: I_p = pi 0.2^4/32 = 1.5707963e-4, k = 4.27257e6 N m/rad.
  const DistributedShaft::Params massless{
      .shear_modulus = 68e9, .density = 0, .outer_diameter = 0.2, .length = 2.5};
  CHECK(DistributedShaft(massless).segment_stiffness() == Approx(4.27256601e6).epsilon(1e-8));
  CHECK(check_element(DistributedShaft(massless), 2).text() == "");

  SECTION("stiffness in series and total inertia do not depend on the segments") {
    auto p = massless;
    p.density = 7850;
    p.inner_diameter = 0.1;
    p.segments = 4;
    const DistributedShaft shaft(p);
    CHECK(shaft.internal_nodes() == std::vector(3, NodeKind::rotational));
    const Terms t = described(shaft, 2);
    // I_p = pi (0.2^4 - 0.1^4)/32 = 1.47262156e-4 m^4; J = 7850 * 2.5 * I_p.
    CHECK(t.mass.sum() == Approx(7850 * 2.5 * 1.472621556e-4).epsilon(1e-9));
    CHECK(t.outputs.size() == 4);
    CHECK(t.outputs[0].suffix == "1");
    // Uniform twist a..b of 0.4 rad: nodes a, b, internal at 0, 0.4, 0.1, 0.2, 0.3.
    Eigen::VectorXd q(5);
    q << 0.0, 0.4, 0.1, 0.2, 0.3;
    const Eigen::VectorXd f = t.stiffness * q;
    const double torque = 68e9 * 1.472621556e-4 / 2.5 * 0.4;
    CHECK(f[1] == Approx(torque).epsilon(1e-9));
    CHECK(f[0] == Approx(-torque).epsilon(1e-9));
    CHECK(f.tail(3).cwiseAbs().maxCoeff() < 1e-9 * torque);
    for (const OutputSpec& o : t.outputs) CHECK(o.stiffness.dot(q) == Approx(torque).epsilon(1e-9));
  }
  SECTION("part by part it is what it is as a whole") {
    auto p = massless;
    p.density = 7850;
    for (const SegmentMass mass : {SegmentMass::lumped, SegmentMass::consistent, SegmentMass::averaged})
      for (const int n : {1, 2, 5}) {
        p.mass = mass, p.segments = n;
        const DistributedShaft shaft(p);
        const Terms whole = described(shaft, 2);
        Terms sum(n + 1);
        REQUIRE(shaft.part_count() == n);
        for (int part = 0; part < n; ++part) {
          const std::vector<int> nodes = shaft.part_nodes(part);
          Terms own(2);
          shaft.describe_part(part, own);
          sum.mass(nodes, nodes) += own.mass;
          sum.stiffness(nodes, nodes) += own.stiffness;
          REQUIRE(own.outputs.size() == 1);
          CHECK(own.outputs[0].suffix == whole.outputs[idx(part)].suffix);
          CHECK(whole.outputs[idx(part)].stiffness(nodes) == own.outputs[0].stiffness);
          CHECK(own.rayleigh);
        }
        CHECK(sum.mass == whole.mass);
        CHECK(sum.stiffness == whole.stiffness);
        CHECK(check_element(shaft, 2).text() == "");
      }
  }
  SECTION("faults") {
    auto p = massless;
    p.segments = 3;
    CHECK(contains(findings(DistributedShaft(p)), "must be 1 where density is 0"));
    p.segments = 0;
    CHECK(contains(findings(DistributedShaft(p)), "segments = 0, must be between 1 and"));
    CHECK(DistributedShaft(p).internal_nodes().empty());
    p = massless;
    p.inner_diameter = 0.2;
    CHECK(contains(findings(DistributedShaft(p)), "must be less than outer_diameter, 0.2"));
    const std::string all = findings(DistributedShaft({}));
    for (const char* name : {"shear_modulus", "density", "outer_diameter", "length"})
      CHECK(contains(all, std::string(name) + " = NaN"));
  }
}

TEST_CASE("Rayleigh damping from two modes gives back their ratios") {
  const double w1 = hz(120.0), w2 = hz(284.0);
  const auto p = RayleighDamping::from_two_modes(w1, 0.01, w2, 0.02);
  CHECK(p.alpha_mass / (2 * w1) + p.beta_stiffness * w1 / 2 == Approx(0.01).epsilon(1e-12));
  CHECK(p.alpha_mass / (2 * w2) + p.beta_stiffness * w2 / 2 == Approx(0.02).epsilon(1e-12));
  // By hand: w = 1, 2, xi = 0.3, 0.3: a = 4 * 0.3/3 = 0.4, b = 2 * 0.3/3 = 0.2.
  const auto q = RayleighDamping::from_two_modes(1, 0.3, 2, 0.3);
  CHECK(q.alpha_mass == Approx(0.4));
  CHECK(q.beta_stiffness == Approx(0.2));
  CHECK(RayleighDamping::mass_proportional(50, 0.01).alpha_mass == Approx(1.0));
  CHECK(RayleighDamping::stiffness_proportional(50, 0.01).beta_stiffness == Approx(4e-4));
}

TEST_CASE("Rayleigh damping refuses what would gain energy") {
  CHECK_THROWS_AS(RayleighDamping::from_two_modes(1, 0.01, 2, 0.03), ModelError);  // a < 0
  CHECK_THROWS_AS(RayleighDamping::from_two_modes(1, 0.03, 2, 0.01), ModelError);  // b < 0
  CHECK_THROWS_AS(RayleighDamping::from_two_modes(1, 0.01, 1, 0.01), ModelError);
  CHECK_THROWS_AS(RayleighDamping::from_two_modes(0, 0.01, 1, 0.01), ModelError);
  CHECK_THROWS_AS(RayleighDamping::mass_proportional(1, -0.01), ModelError);
  CHECK_THROWS_AS(RayleighDamping::stiffness_proportional(0, 0.01), ModelError);
  try {
    RayleighDamping::from_two_modes(1, 0.01, 2, 0.03);
  } catch (const ModelError& e) {
    CHECK(contains(e.what(), "alpha_mass = -"));
    CHECK(contains(e.what(), "must be >= 0"));
  }
}
