// Stretches of a table one behind the other (solvers/exact/table_stretches.hpp), beside its points joined by straight lines.
#include "solvers/exact/table_stretches.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Points of one turn and slopes behind each, with the straight lines between them written out once more.
struct Points {
  std::vector<double> arguments, values, slopes;
  double period;
  Points(std::vector<double> at, std::vector<double> torques, double turn)
      : arguments(std::move(at)), values(std::move(torques)), period(turn) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const bool last = i + 1 == arguments.size();
      const double to = last ? arguments[0] + period : arguments[i + 1], value = values[last ? 0 : i + 1];
      slopes.push_back((value - values[i]) / (to - arguments[i]));
    }
  }
  LoadTable table(double phase) const {
    return {.arguments = arguments, .values = values, .slopes = slopes, .period = period, .phase = phase};
  }
  double torque(double argument) const {
    double u = std::fmod(argument - arguments[0], period);
    if (u < 0.0) u += period;
    std::size_t i = arguments.size() - 1;
    while (arguments[i] - arguments[0] > u) --i;
    return values[i] + slopes[i] * (u - (arguments[i] - arguments[0]));
  }
};

/// The torque at an angle by a stretch, whose own stands at its lower bound.
double torque_at(const LoadStretch& s, double angle) { return s.torque + s.angle_slope * (angle - s.low); }

LoadStretch stretch_at(const TableStretches& stretches, TableStretches::Place place) {
  LoadStretch stretch;
  stretches.read(place, stretch);
  return stretch;
}

}  // namespace

TEST_CASE("Stretches of a table follow each other over its turns, up and down") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.2, 1.0), torque(-100.0, 100.0);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> arguments{part(random) - 0.5}, values;
    for (int i = 0; i < 11; ++i) arguments.push_back(arguments.back() + part(random));
    for (std::size_t i = 0; i < arguments.size(); ++i) values.push_back(torque(random));
    values[4] = values[5] = values[6];  // no change of slope at point 5
    const Points points(arguments, values, arguments.back() - arguments.front() + part(random));
    const double phase = torque(random) * 0.1, start = torque(random);
    const LoadTable table = points.table(phase);
    const TableStretches stretches(table);
    CHECK(stretches.is_of(table));
    for (const bool rises : {true, false}) {
      TableStretches::Place place = stretches.find(start, phase, rises ? 1.0 : -1.0);
      CHECK(stretches.low(place) <= start);
      CHECK(stretches.high(place) >= start);
      for (int i = 0; i < 30; ++i) {
        const LoadStretch s = stretch_at(stretches, place);
        for (const double at : {0.1, 0.5, 0.9}) {
          const double angle = s.low + at * (s.high - s.low);
          CHECK(torque_at(s, angle) == Approx(points.torque(angle + phase)).margin(1e-10));
        }
        const double bound = rises ? s.high : s.low;
        stretches.step(place, rises);
        CHECK((rises ? stretches.low(place) : stretches.high(place)) == bound);  // to the last bit
        CHECK(stretch_at(stretches, place).angle_slope != s.angle_slope);
      }
    }
  }
}

TEST_CASE("A stretch over the table's end is one, and a narrow flank there is one, too") {
  // Level from 2 over the end at 4 to 1; up, and down.
  const Points over({0.0, 1.0, 1.5, 2.0}, {0.0, 0.0, 5.0, 0.0}, 4.0);
  const TableStretches stretches(over.table(0.0));
  for (const double turns : {0.0, 3.0, -2.0})
    for (const double argument : {0.0, 0.5, 2.5, 3.9}) {
      const LoadStretch s = stretch_at(stretches, stretches.find(4.0 * turns + argument, 0.0, 1.0));
      CHECK(s.angle_slope == 0.0);
      CHECK(s.high - s.low == Approx(3.0).epsilon(1e-14));
    }
  const double turn = 6.283185307179586;
  const Points saw({0.0, turn - 1e-9}, {0.0, 10.0}, turn);
  const TableStretches teeth(saw.table(0.0));
  REQUIRE(teeth.bounded());
  for (const double turns : {0.0, 7.0}) {
    auto place = teeth.find(turns * turn + 3.0, 0.0, 1.0);
    CHECK(torque_at(stretch_at(teeth, place), turns * turn + 3.0) == Approx(saw.torque(3.0)).epsilon(1e-9));
    teeth.step(place, true);
    CHECK(stretch_at(teeth, place).angle_slope < -1e9);
    teeth.step(place, true);
    CHECK(teeth.low(place) == Approx((turns + 1.0) * turn).epsilon(1e-14));
  }
}

TEST_CASE(
    "On a point of a table the stretch ahead of it is found, a table without a change of slope has no "
    "bounds") {
  const Points points({0.0, 1.0, 2.0}, {0.0, 3.0, 0.0}, 4.0);  // up, down, level
  const TableStretches stretches(points.table(0.5));
  for (const double turns : {0.0, -5.0, 1000.0}) {
    const double knot = 1.0 - 0.5 + 4.0 * turns;
    CHECK(stretch_at(stretches, stretches.find(knot, 0.5, 1.0)).angle_slope == -3.0);
    CHECK(stretch_at(stretches, stretches.find(knot, 0.5, -1.0)).angle_slope == 3.0);
    CHECK(stretch_at(stretches, stretches.find(knot + 1e-14, 0.5, -1.0)).angle_slope == 3.0);
    CHECK(stretch_at(stretches, stretches.find(knot + 1e-3, 0.5, -1.0)).angle_slope == -3.0);
  }
  const Points level({0.0, 1.0}, {7.0, 7.0}, 2.0);
  const TableStretches one(level.table(0.0));
  CHECK_FALSE(one.bounded());
  const LoadStretch s = stretch_at(one, one.find(123.0, 0.0, 1.0));
  CHECK(s.torque == 7.0);
  CHECK(std::isinf(s.low));
  CHECK(std::isinf(s.high));
}
