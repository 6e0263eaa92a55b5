// Springs given by points: dead bands, stops, one-sided contacts.
#include <drev/elements/polyline_spring.hpp>

#include <cmath>
#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;
using namespace drev::test;

namespace {

/// Energy between two deflections from the spring's force, by quadrature.
double work(const PolylineSpring& s, double from, double to) {
  return integral([&](double x) { return s.evaluate({.x = x}).y; }, from, to, 100000);
}

}  // namespace

TEST_CASE("polyline springs are sound at random states") {
  for (const auto& p :
       {PolylineSpring::dead_band(1e5, 1e-3, 2.0), PolylineSpring::dead_band(1e5, 0),
        PolylineSpring::with_stops(100, 0.2, 5000, 1.0), PolylineSpring::Params{{-1, 0, 1}, {0, 0, 4}},
        PolylineSpring::Params{{1, 2, 3, 5}, {5, 6, 9, 9}},
        PolylineSpring::Params{{-3, -2, -1}, {-9, -6, -5}}})
    for (const int nodes : {1, 2})
      CHECK(check_element(PolylineSpring(p), nodes, {.samples = 1000}).text() == "");
}

TEST_CASE("dead band by hand") {
  const PolylineSpring s(PolylineSpring::dead_band(100, 0.5));
  CHECK(s.evaluate({.x = 0.4}).y == 0.0);
  CHECK(s.evaluate({.x = 0.7}).y == Approx(20.0));
  CHECK(s.evaluate({.x = -0.7}).y == Approx(-20.0));
  CHECK(s.evaluate({.x = 3.5}).y == Approx(300.0));  // the outer segment goes on
  CHECK(s.evaluate({.x = 3.5}).stored_energy == Approx(450.0));
  REQUIRE(s.gap());
  CHECK(s.gap()->low == -0.5);
  CHECK(s.gap()->high == 0.5);
  CHECK(s.closed_stiffness() == Approx(100.0));
  CHECK(s.kinks().size() == 2);
  CHECK(described(s, 2).speed_ratio_constraints[0].only_in_contact);
  CHECK(described(s, 2).scalars[0].b[0] == -1.0);
  CHECK(described(s, 1).scalars[0].b[0] == 1.0);
}

TEST_CASE("stops by hand: 100 N m/rad to 0.2 rad, 5000 beyond") {
  const PolylineSpring s(PolylineSpring::with_stops(100, 0.2, 5000, 3.0));
  CHECK(s.evaluate({.x = 0.1}).y == Approx(10.0));
  CHECK(s.evaluate({.x = 0.3}).y == Approx(20.0 + 500.0));
  CHECK(s.evaluate({.x = -0.3}).dy_dx == Approx(5000.0));
  CHECK(s.evaluate({.x = 0.1, .x_dot = 2.0}).y == Approx(16.0));
  CHECK(s.evaluate({.x = 0.1, .x_dot = 2.0}).dissipated_power == Approx(12.0));
  CHECK_FALSE(s.gap());
  CHECK(s.closed_stiffness() == Approx(100.0));
}

TEST_CASE("energy is the integral of the force from where the force is zero") {
  const PolylineSpring stops(PolylineSpring::with_stops(100, 0.2, 5000));
  for (const double x : {-0.7, -0.15, 0.1, 0.25, 2.0})
    CHECK(stops.evaluate({.x = x}).stored_energy == Approx(work(stops, 0, x)).epsilon(1e-6));
  const PolylineSpring offset({.x = {1, 2, 3, 5}, .y = {5, 6, 9, 9}});  // zero at x = -4, outside
  for (const double x : {-6.0, -4.0, 1.5, 2.5, 9.0})
    CHECK(offset.evaluate({.x = x}).stored_energy == Approx(work(offset, -4, x)).epsilon(1e-6).margin(1e-9));
  const PolylineSpring crossing({.x = {-2, 0, 2}, .y = {-3, -1, 7}});  // zero at 0.25
  for (const double x : {-5.0, 0.0, 0.25, 1.0, 4.0})
    CHECK(crossing.evaluate({.x = x}).stored_energy ==
          Approx(work(crossing, 0.25, x)).epsilon(1e-6).margin(1e-9));
}

TEST_CASE("one-sided stop: the gap reaches to infinity") {
  const PolylineSpring s({.x = {-1, 0, 1}, .y = {0, 0, 4}});
  REQUIRE(s.gap());
  CHECK(s.gap()->low == -std::numeric_limits<double>::infinity());
  CHECK(s.gap()->high == 0.0);
  CHECK(s.closed_stiffness() == 4.0);
  CHECK(s.evaluate({.x = -50}).y == 0.0);
}

TEST_CASE("polyline spring: faults") {
  CHECK(contains(findings(PolylineSpring({})), "x = 0 points, must be at least 2"));
  CHECK(contains(findings(PolylineSpring({{0, 1}, {0}})), "must be as many as x has, 2"));
  CHECK(contains(findings(PolylineSpring({{0, 0}, {0, 1}})), "x[1] = 0 rad"));
  CHECK(contains(findings(PolylineSpring({{0, 1, 2}, {0, 2, 1}})),
                 "y[2] = 1 N m, must not be less than the value before it, 2"));
  CHECK(contains(findings(PolylineSpring({{0, 1, 2}, {3, 3, 4}})), "must pass through zero"));
  CHECK(contains(findings(PolylineSpring({{0, 1}, {0, 1}, -1})), "damping = -1"));
  CHECK(findings(PolylineSpring({{0, 1}, {3, 4}})) == "");  // continued, zero at -3
}
