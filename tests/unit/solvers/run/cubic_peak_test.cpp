// The extremum of the cubic through two ends, where the function is a cubic: exact.
#include "solvers/run/cubic_peak.hpp"

#include <algorithm>
#include <random>

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

TEST_CASE("A parabola's peak is found, rates of one sign have none") {
  const auto peak = cubic_peak(0.0, 1.0, 0.0, -1.0, 2.0);  // y = t - t^2/2
  REQUIRE(peak);
  CHECK(peak->value == Approx(0.5).epsilon(1e-15));
  CHECK(peak->s == Approx(0.5).epsilon(1e-15));
  CHECK_FALSE(cubic_peak(0.0, 1.0, 1.0, 2.0, 1.0));
  CHECK_FALSE(cubic_peak(0.0, 0.0, 1.0, 0.0, 1.0));
}

TEST_CASE("The reach of a cubic holds its values, and is that of its ends where it is monotone") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int monotone = 0;
  for (int i = 0; i < 2000; ++i) {
    const double y_0 = any(random), r_0 = 3.0 * any(random), y_1 = any(random), r_1 = 3.0 * any(random),
                 h = 0.7;
    const Interval reach = cubic_reach(y_0, r_0, y_1, r_1, h);
    double low = std::min(y_0, y_1), high = std::max(y_0, y_1);
    const double rise = y_1 - y_0, d_0 = h * r_0, d_1 = h * r_1;
    for (int k = 0; k <= 1000; ++k) {
      const double s = 1e-3 * k;
      const double y = y_0 + s * (d_0 + s * (3.0 * rise - 2.0 * d_0 - d_1 + s * (d_0 + d_1 - 2.0 * rise)));
      low = std::min(low, y);
      high = std::max(high, y);
    }
    CHECK(reach.low <= low + 1e-12);
    CHECK(reach.high >= high - 1e-12);
    monotone += reach.low == std::min(y_0, y_1) && reach.high == std::max(y_0, y_1);
  }
  CHECK(monotone > 200);
}

TEST_CASE(
    "A cubic whose end rates have one sign is monotone, or dips between two extrema: told apart by its "
    "slope") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int dips = 0, monotone = 0;
  for (int i = 0; i < 4000; ++i) {
    const double h = 0.7, y_0 = 0.3, y_1 = y_0 + 0.2 * any(random), r_0 = any(random),
                 r_1 = std::copysign(any(random), r_0);
    const double rise = y_1 - y_0, d_0 = h * r_0, d_1 = h * r_1;
    const auto slope = [&](double s) {
      return d_0 + 2.0 * s * (3.0 * rise - 2.0 * d_0 - d_1) + 3.0 * s * s * (d_0 + d_1 - 2.0 * rise);
    };
    double least = 1.0;  // slope over that of an end
    for (int k = 0; k <= 1000; ++k) least = std::min(least, slope(1e-3 * k) / d_0);
    const auto dip = cubic_dip(y_0, r_0, y_1, r_1, h);
    if (std::abs(least) > 1e-4) CHECK(dip.has_value() == (least < 0.0));
    if (dip) CHECK(slope(*dip) / d_0 == Approx(least).margin(1e-4));
    const bool steady = cubic_is_monotone(y_0, r_0, y_1, r_1, h);
    if (steady) CHECK(least > -1e-12);
    dips += dip.has_value();
    monotone += steady;
  }
  CHECK(dips > 400);
  CHECK(monotone > 400);
}
