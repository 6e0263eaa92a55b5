// Known motions: continuity, derivatives, breakpoints, refused parameters.
#include <drev/core/error.hpp>
#include <drev/core/motion.hpp>
#include <drev/core/units.hpp>

#include <cmath>
#include <limits>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Rate and acceleration against central differences; both are exact except for rounding where the motion
/// is a parabola on either side.
void check_derivatives(const Motion& motion, double t) {
  const double h = 1e-4;
  const MotionPoint p = motion.at(t), low = motion.at(t - h), high = motion.at(t + h);
  INFO("t = " << t);
  CHECK((high.value - low.value) / (2 * h) == Approx(p.rate).margin(1e-8));
  CHECK((high.rate - low.rate) / (2 * h) == Approx(p.acceleration).margin(1e-7));
}

}  // namespace

TEST_CASE("Constant speed") {
  const Motion m = constant_speed(3.0, 0.5);
  CHECK(m.at(2.0).value == Approx(6.5));
  CHECK(m.at(-1.0).value == Approx(-2.5));
  CHECK(m.at(7.0).rate == 3.0);
  CHECK(m.at(7.0).acceleration == 0.0);
  CHECK(m.breakpoints.empty());
  CHECK(constant_speed(0.0).at(1e9).value == 0.0);
}

TEST_CASE("Run-up: speeds, angle by hand, continuity and derivatives") {
  // 2 rad/s until 1 s, then 3 rad/s^2 for 2 s, then 8 rad/s. Angle at 3 s: 2 + (2 + 8)/2 * 2 = 12.
  const Motion m = run_up(2.0, 8.0, 1.0, 3.0);
  CHECK(m.at(0.0).value == 0.0);
  CHECK(m.at(1.0).value == Approx(2.0));
  CHECK(m.at(2.0).value == Approx(2.0 + 2.0 + 1.5));
  CHECK(m.at(2.0).rate == Approx(5.0));
  CHECK(m.at(2.0).acceleration == Approx(3.0));
  CHECK(m.at(3.0).value == Approx(12.0));
  CHECK(m.at(5.0).value == Approx(28.0));
  for (const double t : {0.5, 1.7, 2.9, 3.5, 100.0}) check_derivatives(m, t);
  CHECK(m.breakpoints == std::vector<double>{1.0, 3.0});
  for (const double t : m.breakpoints) {
    const double below = std::nextafter(t, -1.0);
    CHECK(m.at(below).value == Approx(m.at(t).value).epsilon(1e-14));
    CHECK(m.at(below).rate == Approx(m.at(t).rate).epsilon(1e-14));
  }
  // The acceleration jumps; at the breakpoint it is the one after it.
  CHECK(m.at(std::nextafter(1.0, 0.0)).acceleration == 0.0);
  CHECK(m.at(1.0).acceleration == Approx(3.0));
  CHECK(m.at(std::nextafter(3.0, 0.0)).acceleration == Approx(3.0));
  CHECK(m.at(3.0).acceleration == 0.0);
}

TEST_CASE("Run-down through zero, and a start before t = 0") {
  const Motion m = run_up(4.0, -4.0, -1.0, 1.0);
  CHECK(m.at(0.0).rate == Approx(0.0).margin(1e-15));
  CHECK(m.at(0.0).acceleration == Approx(-4.0));
  for (const double t : {-2.0, -0.5, 0.3, 2.0}) check_derivatives(m, t);
  // Same distance forward and back.
  CHECK(m.at(1.0).value == Approx(m.at(-1.0).value));
}

TEST_CASE("Known motions refuse what is not a motion") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  REQUIRE_THROWS_AS(constant_speed(nan), ModelError);
  REQUIRE_THROWS_AS(constant_speed(1.0, infinity), ModelError);
  REQUIRE_THROWS_AS(run_up(0.0, 1.0, 1.0, 1.0), ModelError);
  REQUIRE_THROWS_AS(run_up(0.0, 1.0, 2.0, 1.0), ModelError);
  REQUIRE_THROWS_AS(run_up(0.0, 1.0, 0.0, infinity), ModelError);
  REQUIRE_THROWS_AS(run_up(0.0, 1.0, 0.0, nan), ModelError);
  REQUIRE_THROWS_AS(run_up(nan, infinity, 0.0, 1.0), ModelError);
  try {
    (void)run_up(nan, infinity, 0.0, -1.0);
  } catch (const ModelError& error) {
    CHECK(error.findings().size() == 3);
  }
}

TEST_CASE("Units") {
  CHECK(deg(180.0) == Approx(3.14159265358979323846));
  CHECK(to_deg(deg(33.0)) == Approx(33.0));
  CHECK(rpm(60.0) == Approx(2 * 3.14159265358979323846));
  CHECK(to_hz(hz(12.5)) == Approx(12.5));
  CHECK(mm(0.15) == Approx(0.00015));
}
