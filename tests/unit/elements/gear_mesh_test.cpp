// Gear mesh, its varying stiffness, its transmission error, involute geometry.
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/element.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;
using namespace drev::test;

namespace {

GearMesh::Params plain() {
  return {.base_radius_1 = 0.030, .base_radius_2 = 0.075, .stiffness = 2e8, .normal_backlash = 80e-6};
}

}  // namespace

TEST_CASE("involute contact ratio, published case 11") {
  CHECK(involute_contact_ratio(2e-3, 62, 62, deg(20)) == Approx(1.7897798668).epsilon(1e-10));
  // 328/23 teeth, base radii 0.5086/0.03567 m, 22.5 deg: each gear with its own module as addendum.
  const double rb1 = 0.5086, rb2 = 0.03567, c = std::cos(deg(22.5));
  CHECK(involute_contact_ratio({.base_radius_1 = rb1,
                                .tip_radius_1 = rb1 / c * (1 + 2.0 / 328),
                                .base_radius_2 = rb2,
                                .tip_radius_2 = rb2 / c * (1 + 2.0 / 23),
                                .centre_distance = (rb1 + rb2) / c,
                                .teeth_1 = 328}) == Approx(1.6377334309511222).epsilon(1e-12));
  CHECK_THROWS_AS(involute_contact_ratio({.base_radius_1 = rb1}), ModelError);
}

TEST_CASE("base radii: 8 * 68 * cos(20 deg)/2 = 511.193/2 mm, as the source's table has it") {
  CHECK(2 * involute_base_radius(mm(8), 68, deg(20)) == Approx(0.511193).epsilon(1e-6));
  const GearMesh mesh(
      {.module = mm(8), .teeth_1 = 59, .teeth_2 = 68, .pressure_angle = deg(20), .stiffness = 1e9});
  CHECK(findings(mesh) == "");
  CHECK(2 * mesh.base_radius_2() == Approx(0.511193).epsilon(1e-6));
  CHECK(mesh.base_radius_2() / mesh.base_radius_1() == Approx(68.0 / 59.0).epsilon(1e-14));
}

TEST_CASE("gear meshes are sound at random states") {
  const GearMesh::Params teeth{.module = mm(8),
                               .teeth_1 = 59,
                               .teeth_2 = 68,
                               .pressure_angle = deg(20),
                               .stiffness = 1e9,
                               .normal_backlash = 1.5e-4,
                               .damping = 4e3};
  CHECK(check_element(GearMesh(plain()), 2).text() == "");
  CHECK(check_element(GearMesh(teeth), 2).text() == "");
  for (const MeshStiffness& k : {MeshStiffness::step(6.582e8, 1.102e9, 1.5),
                                 MeshStiffness::fourier(8e8, {{1, 1e8, 0.3}, {2, 5e7, -1.0}}),
                                 MeshStiffness::fourier_of_step(6.582e8, 1.102e9, 1.6, 10),
                                 MeshStiffness::table({0.0, 0.3, 0.35, 0.9}, {1e9, 1e9, 7e8, 7e8})})
    for (const auto kind : {MeshDamping::proportional, MeshDamping::contact_only, MeshDamping::always}) {
      auto p = teeth;
      p.stiffness = k;
      p.damping_law = kind;
      p.transmission_error = std::vector<Harmonic>{{1, 5e-6, 0.0}, {2, 1e-6, 1.0}};
      CHECK(check_element(GearMesh(p), 2).text() == "");
      p.stiffening = {{0.0, 8e-6, 3e-5}, {0.95, 1.0, 1.05}};
      CHECK(check_element(GearMesh(p), 2).text() == "");
      p.normal_backlash = 0.0;
      p.transmission_error = TransmissionError::table({0.0, 0.2, 0.6}, {0.0, 4e-6, -3e-6});
      CHECK(check_element(GearMesh(p), 2).text() == "");
    }
}

TEST_CASE("gear mesh signs by hand") {
  const GearMesh mesh(plain());  // owns the law that its terms point to
  const Terms t = described(mesh, 2);
  REQUIRE(t.scalars.size() == 1);
  const ScalarSpec& s = t.scalars[0];
  CHECK(s.along_line_of_action);
  CHECK(s.phase_node == -1);
  // Gear 1 forward by 2 mrad: x = 60 um, 20 um past the gap's edge: 4000 N, 120 and 300 N m.
  const Eigen::Vector2d q(2e-3, 0.0);
  const double x = s.b.dot(q);
  CHECK(x == Approx(60e-6));
  const Eigen::VectorXd f = s.b * s.force->evaluate({.x = x}).y;
  CHECK(f[0] == Approx(120.0));  // on the left side: brakes gear 1
  CHECK(f[1] == Approx(300.0));  // and turns gear 2 backwards: an external pair
  REQUIRE(t.speed_ratio_constraints.size() == 1);
  CHECK(t.speed_ratio_constraints[0].only_in_contact);
  CHECK(t.speed_ratio_constraints[0].b.dot(Eigen::Vector2d(1.0, -0.4)) == Approx(0.0).margin(1e-15));

  auto ring = plain();
  ring.internal = true;
  ring.normal_backlash = 0.0;
  const Terms r = described(GearMesh(ring), 2);
  CHECK(r.scalars[0].b[1] == -0.075);
  CHECK_FALSE(r.speed_ratio_constraints[0].only_in_contact);
  CHECK_FALSE(GearMesh(ring).gap());
}

TEST_CASE("a mesh without backlash is a spring and a damper in the matrices") {
  auto p = plain();
  p.normal_backlash = 0.0;
  p.damping = 300.0;
  const auto pair = [](const GearMesh::Params& mesh) {
    Model m("pair");
    m.add_node("a");
    m.add_node("b");
    m.add<Inertia>("J_a", {"a"}, {.inertia = 2e-3});
    m.add<Inertia>("J_b", {"b"}, {.inertia = 5e-2});
    m.add<GearMesh>("mesh", {"a", "b"}, mesh);
    return m.build();
  };
  const System system = pair(p);
  CHECK(system.scalars().empty());
  const double flexibility = 0.030 * 0.030 / 2e-3 + 0.075 * 0.075 / 5e-2;
  CHECK(solve_modes(system, {}).frequency_Hz.back() ==
        Approx(to_hz(std::sqrt(2e8 * flexibility))).epsilon(1e-9));
  State state = State::initial(system);
  state.z << 1e-3, -2e-4;
  state.v << 0.5, 0.1;
  const Assembler assembler(system);
  const double x = 0.030 * 1e-3 - 0.075 * 2e-4, rate = 0.030 * 0.5 + 0.075 * 0.1;
  CHECK(find_channel(system, "mesh.deflection_m").evaluate(assembler, state) == Approx(x).epsilon(1e-12));
  CHECK(find_channel(system, "mesh.force_N").evaluate(assembler, state) ==
        Approx(2e8 * x + 300.0 * rate).epsilon(1e-12));
  // One that varies is no straight line.
  p.teeth_1 = 20;
  p.stiffness = MeshStiffness::step(1e8, 3e8, 1.25);
  CHECK(pair(p).scalars().size() == 1);
}

TEST_CASE("mesh phase: one tooth on is the same, half a tooth on the other contact") {
  auto p = plain();
  p.teeth_1 = 20;
  p.normal_backlash = 0.0;
  p.stiffness = MeshStiffness::step(1e8, 3e8, 1.25);  // two pairs for a quarter of the period
  p.mesh_phase = 0.1;
  const GearMesh mesh(p);
  const auto force = [&](double angle) { return mesh.evaluate({.x = 1e-6, .angle = angle}).y; };
  const double tooth = kTwoPi / 20;
  CHECK(force(0.0) == Approx(300.0));
  CHECK(force(0.14 * tooth) == Approx(300.0));
  CHECK(force(0.16 * tooth) == Approx(100.0));
  CHECK(force(0.89 * tooth) == Approx(100.0));
  CHECK(force(0.91 * tooth) == Approx(300.0));
  CHECK(force(-0.2 * tooth) == Approx(100.0));
  CHECK(force(37.05 * tooth) == Approx(300.0));
  CHECK(mesh.closed_stiffness() == Approx(1.5e8));
  CHECK(mesh.varies());
  CHECK(described(mesh, 2).scalars[0].phase_node == 0);
}

TEST_CASE("transmission error: value and slope against gear 1's angle") {
  auto p = plain();
  p.teeth_1 = 20;
  p.transmission_error = std::vector<Harmonic>{{1, 5e-6, -kPi / 2}};  // 5 um sin(20 theta)
  const GearMesh mesh(p);
  CHECK(mesh.offset(0.0).e == Approx(0.0).margin(1e-20));
  CHECK(mesh.offset(0.0).de_dangle == Approx(1e-4));
  CHECK(mesh.offset(kPi / 40).e == Approx(5e-6));
  CHECK_FALSE(mesh.varies());
  CHECK(described(mesh, 2).scalars[0].phase_node == 0);
  const TransmissionError table = TransmissionError::table({0.0, 0.5}, {0.0, 2e-6});
  CHECK(table.at(0.25).value == Approx(1e-6));
  CHECK(table.at(0.75).slope == Approx(-4e-6));
}

TEST_CASE("Fourier series of the rectangular wave against quadrature of its definition") {
  const double single = 6.582e8, both = 1.102e9, ratio = 1.6;
  const auto wave = [&](double s) { return s < ratio - 1.0 ? both : single; };
  const int n = 7, steps = 300000;  // steps a multiple of 10: the jump falls between midpoints
  const MeshStiffness series = MeshStiffness::fourier_of_step(single, both, ratio, n);
  for (const double s : {0.0, 0.1, 0.33, 0.6, 0.77, 0.99}) {
    double expected = integral(wave, 0, 1, steps);
    for (int k = 1; k <= n; ++k) {
      const double w = kTwoPi * k;
      const double a = 2 * integral([&](double u) { return wave(u) * std::cos(w * u); }, 0, 1, steps);
      const double b = 2 * integral([&](double u) { return wave(u) * std::sin(w * u); }, 0, 1, steps);
      expected += a * std::cos(w * s) + b * std::sin(w * s);
    }
    CHECK(series.at(s).value == Approx(expected).epsilon(1e-8));
  }
  // The gear mesh turns from order to order; after 400 turns an angle itself is known to 1e-13 periods.
  GearMesh::Params p = plain();
  p.teeth_1 = 20;
  p.mesh_phase = 0.3;
  p.normal_backlash = 0.0;
  p.stiffness = series;
  const GearMesh mesh(p);
  for (const double angle : {0.0, 0.07, -1.3, 2500.0}) {
    const CurvePoint k = series.at(20.0 * angle / kTwoPi + 0.3);
    CHECK(mesh.evaluate({.x = 1e-6, .angle = angle}).y == Approx(1e-6 * k.value).epsilon(1e-11));
    CHECK(mesh.pieces_scale(angle) == Approx(k.value / series.mean()).epsilon(1e-11));
    CHECK(mesh.evaluate({.x = 1e-6, .angle = angle}).dy_dangle ==
          Approx(1e-6 * k.slope * 20.0 / kTwoPi).epsilon(1e-9));
  }
  CHECK(series.mean() == Approx(single + 0.6 * (both - single)));
  CHECK(MeshStiffness::step(single, both, ratio).mean() == Approx(series.mean()));
  // In the middle of either contact a long series has come to the wave.
  const MeshStiffness fine = MeshStiffness::fourier_of_step(single, both, ratio, 2000);
  CHECK(fine.at(0.3).value == Approx(both).epsilon(1e-3));
  CHECK(fine.at(0.8).value == Approx(single).epsilon(1e-3));
}

TEST_CASE("gear mesh: faults") {
  auto p = plain();
  CHECK(findings(GearMesh(p)) == "");
  CHECK(contains(findings(GearMesh({})), "base_radius_1 = NaN m, must be given"));
  CHECK(contains(findings(GearMesh({})), "stiffness = NaN N/m, must be > 0"));
  p.base_radius_2 = kNotGiven;
  CHECK(contains(findings(GearMesh(p)), "base_radius_2 = NaN m"));
  p = plain();
  p.stiffness = MeshStiffness::step(1e8, 2e8, 1.5);
  CHECK(contains(findings(GearMesh(p)), "teeth_1 = 0, must be given where"));
  p.teeth_1 = 20;
  CHECK(findings(GearMesh(p)) == "");
  p.teeth_2 = 50;
  CHECK(findings(GearMesh(p)) == "");
  p.teeth_2 = 51;
  CHECK(contains(findings(GearMesh(p)), "contradicts base_radius_1 and the teeth"));
  p.stiffness = MeshStiffness::step(1e8, 2e8, 2.0);
  CHECK(contains(findings(GearMesh(p)), "contact_ratio = 2, must be greater than 1"));
  p.stiffness = MeshStiffness::fourier(1e8, {{1, 2e8, 0.0}});
  CHECK(contains(findings(GearMesh(p)), "must stay > 0"));
  // However narrow: 4096 samples over the period would all see the crests of the second one.
  p.stiffness = MeshStiffness::fourier(1e8, {{4096, 1.5e8, 0.0}});
  CHECK(contains(findings(GearMesh(p)), "it must stay > 0"));
  p.stiffness = MeshStiffness::fourier(1e8, {{4000, 0.6e8, 0.3}, {4096, 0.5e8, 0.0}});
  CHECK(contains(findings(GearMesh(p)), "it must stay > 0"));
  // cos x + cos(2 x)/2 is -0.75 at the least.
  p.stiffness = MeshStiffness::fourier(0.7501e8, {{512, 1e8, 0.1}, {1024, 0.5e8, 0.2}});
  CHECK(findings(GearMesh(p)).find("stay > 0") == std::string::npos);
  p.stiffness = MeshStiffness::fourier(0.7499e8, {{512, 1e8, 0.1}, {1024, 0.5e8, 0.2}});
  CHECK(contains(findings(GearMesh(p)), "it must stay > 0"));
  p.stiffness = MeshStiffness::fourier_of_step(6.582e8, 1.102e9, 1.6, 2000);
  CHECK(findings(GearMesh(p)).find("stay > 0") == std::string::npos);
  p.stiffness = MeshStiffness::fourier(1e8, {{10001, 1e7, 0.0}});
  CHECK(contains(findings(GearMesh(p)), "harmonics[0].order = 10001, must be at most 10000"));
  p.stiffness = MeshStiffness::fourier(1e8, {{1.5, 2e7, 0.0}});
  CHECK(contains(findings(GearMesh(p)), "harmonics[0].order = 1.5, must be a whole number"));
  p.stiffness = MeshStiffness::table({0, 1}, {1e8, 1e8});
  CHECK(contains(findings(GearMesh(p)), "less than the period, 1"));
  p.stiffness = MeshStiffness::table({0, 0.5}, {1e8, 0.0});
  CHECK(contains(findings(GearMesh(p)), "stiffness.values = 0 N/m"));

  // The source's misprint: 64 teeth against a base diameter of 511.193 mm.
  GearMesh::Params idler{.base_radius_1 = 0.443535 / 2,
                         .base_radius_2 = 0.511193 / 2,
                         .module = mm(8),
                         .teeth_1 = 59,
                         .teeth_2 = 64,
                         .pressure_angle = deg(20),
                         .stiffness = 1e9};
  CHECK(contains(findings(GearMesh(idler)), "base_radius_2 = 0.2555965 m, contradicts module"));
  idler.teeth_2 = 68;
  CHECK(findings(GearMesh(idler)) == "");
  idler.internal = true;
  idler.base_radius_1 = 0.3;
  CHECK(contains(findings(GearMesh(idler)), "must exceed base_radius_1"));
  idler.pressure_angle = deg(120);
  CHECK(contains(findings(GearMesh(idler)), "pressure_angle"));
}

TEST_CASE("a mesh in a model ties nominal speeds and lets go in its gap") {
  Model model("pair");
  model.add_node("pinion");
  model.add_node("wheel");
  model.add<Inertia>("J1", {"pinion"}, {.inertia = 0.01});
  model.add<Inertia>("J2", {"wheel"}, {.inertia = 0.1});
  model.add<GearMesh>("mesh", {"pinion", "wheel"}, plain());
  model.set_reference("pinion", constant_speed(100.0));
  const System system = model.build();
  CHECK(system.ratio(1) == Approx(-0.4));
  CHECK(system.rigid_mode_count(Contact::closed) == 1);
  CHECK(system.rigid_mode_count(Contact::open) == 2);
}
