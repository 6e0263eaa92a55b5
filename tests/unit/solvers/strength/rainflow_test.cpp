// Covers solvers/strength/rainflow.hpp: counts of ASTM E1049 and Miner's sum.
#include <drev/core/error.hpp>
#include <drev/core/model.hpp>
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/strength/rainflow.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "tests/catch.hpp"

using namespace drev;

namespace {

std::map<double, double> counts_of(const std::vector<double>& signal) {
  std::map<double, double> counts;
  for (const RainflowCycle& cycle : count_rainflow(signal)) counts[cycle.range] += cycle.count;
  return counts;
}

}  // namespace

// The example of ASTM E1049-85, 5.4.4, figure 6.
TEST_CASE("Rainflow counts of the standard's example", "[strength]") {
  const std::vector<double> signal{-2, 1, -3, 5, -1, 3, -4, 4, -2};
  const std::map<double, double> expected{{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1.0}, {9, 0.5}};
  CHECK(counts_of(signal) == expected);
  std::map<std::pair<double, double>, double> means;
  for (const RainflowCycle& c : count_rainflow(signal)) means[{c.range, c.mean}] += c.count;
  const std::map<std::pair<double, double>, double> expected_means{
      {{3, -0.5}, 0.5}, {{4, -1}, 0.5}, {{4, 1}, 1.0},  {{6, 1}, 0.5},
      {{8, 1}, 0.5},    {{8, 0}, 0.5},  {{9, 0.5}, 0.5}};
  CHECK(means == expected_means);
  // Points between turning points change nothing, nor do repeated ones.
  CHECK(counts_of({-2, -1, 0, 1, 1, -3, 0, 5, 4, -1, 3, 0, -4, 4, -2, -2}) == expected);
  // sum n r^m
  for (const auto& [slope, sum] : {std::pair{3.0, 1094.0}, {5.0, 67838.0}, {10.0, 2848969501.0}})
    CHECK(miner_sum(count_rainflow(signal), {.reference = 1.0, .cycles = 1.0, .slope = slope}) ==
          Approx(sum).epsilon(1e-14));
}

TEST_CASE("A history that is repeated, turned to start at its largest value, has whole cycles alone",
          "[strength]") {
  std::map<double, double> counts = counts_of({5, -1, 3, -4, 4, -2, 1, -3, 5});
  CHECK(counts == std::map<double, double>{{9, 1.0}, {7, 1.0}, {4, 1.0}, {3, 1.0}});
}

// Values of the program rainflow 3 (Python), which a separate count gives, too.
TEST_CASE("Rainflow counts of a sum of sines", "[strength]") {
  std::vector<double> signal;
  for (int i = 0; i <= 200; ++i) {
    const double t = 4.0 * i / 200.0;
    signal.push_back(0.2 + 0.5 * std::sin(t) + 0.2 * std::cos(10.0 * t) + 0.2 * std::sin(4.0 * t));
  }
  std::vector<RainflowCycle> cycles = count_rainflow(signal);
  std::sort(cycles.begin(), cycles.end(), [](const auto& a, const auto& b) { return a.range < b.range; });
  const std::vector<std::pair<double, double>> expected{
      {0.042589651507, 0.5}, {0.109734394457, 1},  {0.112946280786, 0.5}, {0.205710699116, 1},
      {0.214679909416, 1},   {0.438898597978, 1},  {0.483057480513, 0.5}, {0.528642386654, 0.5},
      {0.780933029316, 0.5}, {1.434361017214, 0.5}};
  REQUIRE(cycles.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(cycles[i].range == Approx(expected[i].first).margin(1e-12));
    CHECK(cycles[i].count == expected[i].second);
  }
  CHECK(miner_sum(cycles, {.reference = 1.0, .cycles = 1.0, .slope = 5.0}) ==
        Approx(3.231879081).epsilon(1e-9));
}

TEST_CASE("Rainflow counts keep the sum of all ways, and refuse what is not finite", "[strength]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> level(-1.0, 1.0);
  std::vector<double> signal(2000);
  for (double& value : signal) value = level(random);
  double way = 0.0, counted = 0.0;
  for (std::size_t i = 1; i < signal.size(); ++i) way += std::abs(signal[i] - signal[i - 1]);
  for (const RainflowCycle& cycle : count_rainflow(signal)) counted += 2.0 * cycle.count * cycle.range;
  CHECK(counted == Approx(way).epsilon(1e-12));  // a cycle goes its range up and down
  CHECK(count_rainflow(std::vector<double>{}).empty());
  CHECK(count_rainflow(std::vector<double>{1.0, 1.0}).empty());
  CHECK_THROWS_AS(count_rainflow(std::vector<double>{0.0, NAN}), ModelError);
}

// Two discs on an undamped spring, let go: twist A cos(w t), so that each period is a cycle of range 2 k A. It ends on the way, since
// beside a peak rounding would decide whether a half cycle of no range is counted: the last half cycle has half the range.
TEST_CASE("Load cycles of a run are found on the motion, whatever the steps", "[strength]") {
  Model m("free vibration");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("J_a", {"a"}, {.inertia = 2.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 3.0});
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 1200.0, .damping = 0.0});
  m.set_initial("b", 0.01, 0.0);
  const System system = m.build();
  const double w = std::sqrt(1000.0), period = 2.0 * 3.14159265358979 / w, range = 2.0 * 1200.0 * 0.01;
  const SnLine line{.reference = 1e6, .cycles = 1e4, .slope = 4.0};
  for (const Method& method :
       {Method{.name = "exact", .tolerance = 1e-12}, Method{.name = "dormand_prince", .tolerance = 1e-10}}) {
    RainflowWatch watch({{find_channel(system, "shaft.torque_Nm"), 5e4, line}});
    run_method(system, method, {.t_end = 20.25 * period}, {&watch});
    const auto& found = watch.finish();
    REQUIRE(found.size() == 1);
    CHECK(found[0].histogram.cycles() == Approx(20.5).epsilon(1e-9));
    CHECK(found[0].histogram.largest() == Approx(range).epsilon(1e-8));
    CHECK(found[0].damage ==
          Approx((20.0 + 0.5 * std::pow(0.5, 4.0)) / 1e4 * std::pow(range * 5e4 / 1e6, 4.0)).epsilon(1e-7));
    double counted = 0.0;
    for (const auto& c : found[0].histogram.classes()) counted += c.count * c.mean_range();
    CHECK(counted == Approx(20.25 * range).epsilon(1e-7));
  }
}

TEST_CASE("A motion that has come to rest under a load has no more load cycles", "[strength]") {
  Model m("settling");
  m.add_node("ground");
  m.add_node("disc");
  m.hold("ground");
  m.add<Inertia>("J", {"disc"}, {.inertia = 1.0});
  constexpr double k = 1000.0, ratio = 0.1, torque = 100.0;
  m.add<ShaftSpring>("shaft", {"ground", "disc"}, {.stiffness = k, .damping = 2.0 * ratio * std::sqrt(k)});
  m.add<AppliedTorque>("load", {"disc"}, {.table = TimeTable({0.0}, {torque})});
  const System system = m.build();
  RainflowWatch watch({{find_channel(system, "shaft.torque_Nm")}});
  REQUIRE(run_method(system, Method{.name = "exact", .tolerance = 1e-10}, {.t_end = 40.0}, {&watch}).ok());
  // Each half swing is a part q of the one before; they end where one is 1e-10 of the largest torque.
  const double q = std::exp(-3.14159265358979 * ratio / std::sqrt(1.0 - ratio * ratio));
  const double half_swings = std::log(1e-10) / std::log(q);
  CHECK(watch.finish()[0].histogram.cycles() == Approx(0.5 * half_swings).margin(2.0));
}
