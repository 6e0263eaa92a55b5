// The extremum of the cubic through two ends, where the function is a cubic: exact.
#include "solvers/run/cubic_peak.hpp"

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("The extremum of a cubic inside a step is found to rounding") {
  // y = (t - 0.3)^2 (t + c) has its least value 0 at t = 0.3 for t + c > 0.
  for (const double c : {0.5, 1.0, 10.0}) {
    CAPTURE(c);
    const auto y = [c](double t) { return (t - 0.3) * (t - 0.3) * (t + c); };
    const auto rate = [c](double t) { return (t - 0.3) * (3 * t + 2 * c - 0.3); };
    const double t_0 = 0.1, h = 0.35;
    const auto peak = cubic_peak(y(t_0), rate(t_0), y(t_0 + h), rate(t_0 + h), h);
    REQUIRE(peak);
    CHECK(peak->value == Approx(0.0).margin(1e-15 * c));
    CHECK(t_0 + peak->s * h == Approx(0.3).epsilon(1e-12));
  }
}

TEST_CASE("A parabola's peak is found; rates of one sign have none") {
  const auto peak = cubic_peak(0.0, 1.0, 0.0, -1.0, 2.0);  // y = t - t^2/2
  REQUIRE(peak);
  CHECK(peak->value == Approx(0.5).epsilon(1e-15));
  CHECK(peak->s == Approx(0.5).epsilon(1e-15));
  CHECK_FALSE(cubic_peak(0.0, 1.0, 1.0, 2.0, 1.0));
  CHECK_FALSE(cubic_peak(0.0, 0.0, 1.0, 0.0, 1.0));
}
