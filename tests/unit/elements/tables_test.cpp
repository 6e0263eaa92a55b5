// PeriodicTable and TimeTable.
#include <drev/elements/periodic_table.hpp>
#include <drev/elements/time_table.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;
using namespace drev::test;

namespace {

std::string faults(const PeriodicTable& table) {
  std::vector<Finding> all;
  ParameterCheck check("cam", all);
  table.check(check, "angle_table", "rad", "N m");
  return all.empty() ? "" : ModelError(all).what();
}

std::string faults(const TimeTable& table) {
  std::vector<Finding> all;
  ParameterCheck check("drive", all);
  table.check(check, "table", "N m");
  return all.empty() ? "" : ModelError(all).what();
}

}  // namespace

TEST_CASE("periodic table, uneven: values, slopes, wrap") {
  const PeriodicTable table({1.0, 2.0, 4.0}, {10.0, 30.0, 10.0}, 5.0);
  CHECK(faults(table) == "");
  CHECK(table.at(1.5).value == Approx(20.0));
  CHECK(table.at(1.5).slope == Approx(20.0));
  CHECK(table.at(3.0).value == Approx(20.0));
  CHECK(table.at(3.0).slope == Approx(-10.0));
  CHECK(table.at(2.0).value == 30.0);
  CHECK(table.at(2.0).slope == Approx(-10.0));  // to the right of a point
  CHECK(table.at(4.7).value == Approx(10.0));   // from the last point to the first
  CHECK(table.at(0.5).value == Approx(10.0));
  for (const int turns : {-3, -1, 1, 1000})
    CHECK(table.at(1.5 + 5.0 * turns).value == Approx(20.0).epsilon(1e-11));
  // Trapezia by hand: (20 * 1 + 20 * 2 + 10 * 2)/5.
  CHECK(table.mean() == Approx(16.0));
}

TEST_CASE("periodic table, even: the fast look-up agrees with interpolation by hand") {
  std::vector<double> angles, values;
  const int n = 720;
  for (int i = 0; i < n; ++i) {
    angles.push_back(kTwoPi * i / n);
    values.push_back(std::sin(3 * kTwoPi * i / n) + 0.1 * (i % 7));
  }
  const PeriodicTable table(angles, values);
  for (int i = -2000; i < 2000; ++i) {
    const double place = 0.37 + 0.7 * i;  // in points
    const double cell = std::floor(place), s = place - cell;
    const auto wrap = [n](double k) { return static_cast<std::size_t>((static_cast<long>(k) % n + n) % n); };
    const double expected = (1 - s) * values[wrap(cell)] + s * values[wrap(cell + 1)];
    REQUIRE(table.at(kTwoPi * place / n).value == Approx(expected).margin(1e-10));
  }
}

TEST_CASE("periodic table: angles written with four digits still look up exactly") {
  const PeriodicTable table({0.0, 2.0944, 4.1888}, {0.0, 1.0, -1.0});
  CHECK(table.at(2.0944).value == 1.0);
  CHECK(table.at(4.1888).value == -1.0);
  CHECK(table.at(1.0472).value == Approx(0.5));
}

TEST_CASE("periodic table: faults") {
  CHECK(contains(faults(PeriodicTable()), "needs at least 2"));
  CHECK(contains(faults(PeriodicTable({0, 1}, {1})), "as many as the arguments, 2"));
  CHECK(contains(faults(PeriodicTable({0, 1, 1}, {1, 2, 3})), "arguments[2] = 1 rad"));
  CHECK(contains(faults(PeriodicTable({0, 1, kTwoPi}, {1, 2, 1})), "leave out the point"));
  CHECK(contains(faults(PeriodicTable({0, kTwoPi}, {1, 1})), "of these two points one repeats the other"));
  CHECK(contains(faults(PeriodicTable({0, 1, kTwoPi}, {1, 2, 3})), "such a curve cannot jump"));
  CHECK(faults(PeriodicTable({0, 1, 7}, {1, 2, 1})).ends_with("less than the period, 6.283185307179586 rad"));
  CHECK(contains(faults(PeriodicTable({0, 1}, {1, NAN})), "values[1] = NaN N m, must be finite"));
  CHECK(contains(faults(PeriodicTable({0, 1}, {1, 2}, -1.0)), "period = -1 rad"));
}

TEST_CASE("time table: ramp, jump, constant outside") {
  const TimeTable table({1.0, 3.0, 3.0, 4.0}, {0.0, 10.0, 50.0, 60.0});
  CHECK(faults(table) == "");
  CHECK(table.at(-5.0).value == 0.0);
  CHECK(table.at(2.0).value == Approx(5.0));
  CHECK(table.at(2.0).slope == Approx(5.0));
  CHECK(table.at(std::nextafter(3.0, 0.0)).value == Approx(10.0));
  CHECK(table.at(3.0).value == 50.0);  // right-continuous
  CHECK(table.at(3.5).value == Approx(55.0));
  CHECK(table.at(4.0).value == 60.0);
  CHECK(table.at(9.0).slope == 0.0);
  CHECK(table.breakpoints() == std::vector<double>{1.0, 3.0, 4.0});

  CHECK(TimeTable({0.0}, {5.0}).breakpoints().empty());
  CHECK(TimeTable({0.0, 1.0, 4.0}, {5.0, 5.0, 5.0}).breakpoints().empty());
  const TimeTable step({2.0, 2.0}, {1.0, 7.0});
  CHECK(faults(step) == "");
  CHECK(step.at(1.9).value == 1.0);
  CHECK(step.at(2.0).value == 7.0);
}

TEST_CASE("time table: faults") {
  CHECK(contains(faults(TimeTable()), "needs at least 1"));
  CHECK(contains(faults(TimeTable({0, 1}, {1})), "as many as the times, 2"));
  CHECK(contains(faults(TimeTable({0, 2, 1}, {1, 2, 3})), "times[2] = 1 s"));
  CHECK(contains(faults(TimeTable({1, 1, 1}, {1, 2, 3})), "three times"));
  CHECK(contains(faults(TimeTable({0, NAN}, {1, 2})), "times[1] = NaN"));
}
