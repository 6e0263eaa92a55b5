// What exact propagation asks of laws and loads: pieces, stretches and series are the law and load.
#include <drev/elements/catalogue.hpp>
#include <drev/elements/mesh_stiffness.hpp>

#include <cmath>
#include <random>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Every random (x, x_dot) lies on exactly one piece, whose line is the law; what is not elastic
/// dissipates.
template <class Law>
void check_pieces(std::span<const LawPiece> pieces, double x_range, double v_range, Law law) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  REQUIRE(!pieces.empty());
  for (int i = 0; i < 5000; ++i) {
    const double x = x_range * uniform(random), v = v_range * uniform(random);
    const ScalarResponse r = law(x, v);
    int inside = 0;
    for (const LawPiece& p : pieces) {
      bool holds = true;
      for (const LawBound& b : p.bounds) holds = holds && b.a + b.b_x * x + b.b_v * v >= 0.0;
      if (!holds) continue;
      ++inside;
      const double y = p.y_0 + p.k * x + p.c * v + p.product * x * v, elastic = p.elastic_0 + p.elastic_k * x;
      CHECK(y == Approx(r.y).margin(1e-9));
      CHECK((y - elastic) * v == Approx(r.dissipated_power).margin(1e-9));
      const double dx = 1e-6;
      CHECK(elastic ==
            Approx((law(x + dx, v).stored_energy - law(x - dx, v).stored_energy) / (2 * dx)).margin(1e-3));
    }
    CHECK(inside == 1);
  }
}

}  // namespace

TEST_CASE("Backlash law: its pieces are the law") {
  const double k = 2000.0;
  for (const MeshDamping damping : {MeshDamping::always, MeshDamping::contact_only, MeshDamping::limited})
    for (const double gap : {0.1, 0.0})
      for (const double c : {30.0, 0.0}) {
        const BacklashLaw law({.normal_backlash = gap, .damping = c, .damping_law = damping});
        check_pieces(law.pieces(k), 0.2, 10.0, [&](double x, double v) {
          return law.evaluate(x, v, {k, 0.0});
        });
      }
}

TEST_CASE("Backlash law: pieces of a flank that gets stiffer with its load are the law") {
  const double k = 2000.0;
  for (const MeshDamping damping :
       {MeshDamping::always, MeshDamping::contact_only, MeshDamping::limited, MeshDamping::proportional})
    for (const double gap : {0.1, 0.0})
      for (const double c : {30.0, 0.0}) {
        const BacklashLaw law({.normal_backlash = gap,
                               .damping = c,
                               .damping_law = damping,
                               .reference_penetration = 0.02,
                               .stiffening = {{0.0, 0.03, 0.07}, {0.8, 1.0, 1.7}}});
        check_pieces(law.pieces(k), 0.2, 10.0, [&](double x, double v) {
          return law.evaluate(x, v, {k, 0.0});
        });
      }
}

TEST_CASE("Backlash law: proportional damping has linear pieces only without a gap or a damper") {
  const auto pieces = [](double gap, double c) {
    return BacklashLaw({.normal_backlash = gap, .damping = c}).pieces(1.0);
  };
  CHECK_FALSE(is_linear(pieces(0.1, 5.0)));
  CHECK(is_linear(pieces(0.1, 0.0)));
  CHECK(is_linear(pieces(0.0, 5.0)));
  CHECK(pieces(0.1, 5.0).size() == 9);
  CHECK(pieces(0.1, 0.0).size() == 3);
  CHECK(pieces(0.0, 5.0).size() == 1);
}

TEST_CASE("Backlash law: with products of deflection and rate, its pieces are the law for any damping") {
  const double k = 2000.0;
  const BacklashLaw law({.normal_backlash = 0.1, .damping = 300.0, .reference_penetration = 0.04});
  check_pieces(law.pieces(k), 0.2, 10.0, [&](double x, double v) { return law.evaluate(x, v, {k, 0.0}); });
}

TEST_CASE("Polyline spring: its pieces are the spring") {
  for (const auto& params :
       {PolylineSpring::dead_band(500.0, 0.03, 2.0), PolylineSpring::with_stops(100.0, 0.1, 5000.0),
        PolylineSpring::Params{.x = {-0.1, 0.02, 0.05}, .y = {-9.0, 0.5, 8.0}}}) {
    const PolylineSpring spring(params);
    check_pieces(spring.pieces(), 0.2, 10.0,
                 [&](double x, double v) { return spring.evaluate({.x = x, .x_dot = v}); });
  }
}

TEST_CASE("Periodic table: the stretch about an argument is the table up to its ends") {
  const PeriodicTable table({0.1, 0.5, 1.0, 1.2, 2.9}, {0.0, 2.0, 4.5, 4.5, 4.5}, 3.0);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-20.0, 20.0), part(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double u = uniform(random);
    const TableStretch s = table.stretch(u, i % 2 ? 1.0 : -1.0);
    CHECK(s.low <= u);
    CHECK(s.high >= u);
    const double other = s.low + part(random) * (s.high - s.low);
    CHECK(s.value + s.slope * (other - u) == Approx(table.at(other).value).margin(1e-12));
  }
  // On a knot the stretch ahead; the flat part from 1 to 2.9 is one stretch.
  CHECK(table.stretch(0.5, 1.0).slope == Approx(5.0));
  CHECK(table.stretch(0.5, -1.0).slope == Approx(5.0));
  CHECK(table.stretch(0.1 + 3.0, 1.0).slope == Approx(5.0));
  CHECK(table.stretch(0.1 + 3.0, -1.0).slope == Approx(-22.5));
  CHECK(table.stretch(1.5, 1.0).low == Approx(1.0));
  CHECK(table.stretch(1.5, 1.0).high == Approx(2.9));
  CHECK(std::isinf(PeriodicTable({0.0, 1.0}, {7.0, 7.0}).stretch(0.3, 1.0).high));
}

TEST_CASE("Mesh stiffness: the next knot of the phase") {
  const MeshStiffness step = MeshStiffness::step(1e8, 2e8, 1.6);
  CHECK(*step.next_knot(3.2, 1.0) == Approx(3.6));
  CHECK(*step.next_knot(3.6, 1.0) == Approx(4.0));
  CHECK(*step.next_knot(3.7, 1.0) == Approx(4.0));
  CHECK(*step.next_knot(3.7, -1.0) == Approx(3.6));
  CHECK(*step.next_knot(3.6, -1.0) == Approx(3.0));
  CHECK(*step.next_knot(-0.2, 1.0) == Approx(0.0).margin(1e-15));
  const MeshStiffness table = MeshStiffness::table({0.0, 0.25, 0.5}, {1e8, 2e8, 1e8});
  CHECK(*table.next_knot(7.3, 1.0) == Approx(7.5));
  CHECK(*table.next_knot(7.3, -1.0) == Approx(7.25));
  CHECK(*table.next_knot(7.5, 1.0) == Approx(8.0));
  CHECK_FALSE(MeshStiffness(1e8).next_knot(0.3, 1.0));
  CHECK_FALSE(MeshStiffness::fourier(1e8, {{1.0, 1e7, 0.0}}).next_knot(0.3, 1.0));
}
