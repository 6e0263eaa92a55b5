// Compliance of teeth on their gears against an independent finite-element program (triangles with six nodes, 38,000 nodes,
// five teeth; docs/gears.md), its convergence, reciprocity and the windup of a disc.
#include "models/gears/tooth_compliance.hpp"

#include <drev/core/error.hpp>
#include <drev/models/gears/mesh_cycle.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/models/gears/gear_pairs.hpp"

using namespace drev;

TEST_CASE("Regular compliance along the flank of a gear of 62 teeth", "[gears]") {
  const GearPair pair(gear_pairs::r62());
  const ToothCompliance gear(pair, 0, pair.start_of_contact(), pair.end_of_contact());
  const double base = pair.contour(0).base_radius() / 0.002;
  const std::vector<std::array<double, 3>> rows{{30.2, 3.268, 0.02},
                                                {30.6, 4.102, 0.01},
                                                {31.0, 5.312, 0.01},
                                                {31.4, 7.215, 0.01},
                                                {31.8, 10.301, 0.01}};
  for (const auto& [radius, g, limit] : rows) {
    INFO(radius);
    CHECK(std::abs(gear.own(0.002 * std::sqrt(radius * radius - base * base)) / g - 1.0) < limit);
  }
}

TEST_CASE("Regular compliance at the pitch points", "[gears]") {
  struct Row {
    GearGeometry pair;
    double g_1, g_2;
  };
  for (const Row& row : {Row{gear_pairs::t1(), 5.885, 5.408}, Row{gear_pairs::t1n(), 5.301, 5.333},
                         Row{gear_pairs::t2(), 5.506, 5.282}, Row{gear_pairs::s(), 3.303, 9.243}}) {
    const GearPair pair(row.pair);
    const double t = pair.pitch_point();
    CHECK(std::abs(ToothCompliance::own_at(pair, 0, t, 2) / row.g_1 - 1.0) < 0.01);
    CHECK(std::abs(ToothCompliance::own_at(pair, 1, pair.second_length(t), 2) / row.g_2 - 1.0) < 0.01);
  }
}

TEST_CASE("A force moves the next tooth as its own force would move this one", "[gears]") {
  const GearPair pair(gear_pairs::r62());
  const double t = pair.pitch_point(), half = 0.5 * pair.base_pitch();
  const ToothCompliance gear(pair, 0, pair.start_of_contact(), pair.end_of_contact());
  CHECK(std::abs(gear.coupling(1, t + half, t - half) / 2.035 - 1.0) < 0.01);
  // Further away it is less, and what is left at last is nearly the windup.
  CHECK(gear.coupling(2, t, t) < gear.coupling(1, t, t));
  CHECK(gear.coupling(2, t, t) > 0.5 * MeshCycle::windup(pair, 0));
}

TEST_CASE("The compliance converges with finer meshes", "[gears]") {
  // 5.25382, 5.29059, 5.29776 and (level 8) 5.29845 of gear R62; order 2.4, then 3.4.
  const GearPair pair(gear_pairs::r62());
  const double t = pair.pitch_point();
  const double one = ToothCompliance::own_at(pair, 0, t, 1), two = ToothCompliance::own_at(pair, 0, t, 2),
               four = ToothCompliance::own_at(pair, 0, t, 4);
  const double order = std::log2((two - one) / (four - two));
  INFO(order);
  CHECK(order > 2.2);
  CHECK(std::abs(four - two) < (two - one) / 3.0);  // what the error of a mesh cycle is built on
}

TEST_CASE("A gear without a bore has no mesh stiffness, and a rim can be too thin", "[gears]") {
  const auto refusal = [](GearGeometry p) {
    try {
      const GearPair pair(p);
      MeshCycle cycle(pair);
    } catch (const ModelError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  GearGeometry p = gear_pairs::t2();
  p.gear_2.bore_diameter = kNotGiven;
  CHECK(refusal(p).find("gear_2: bore_diameter") != std::string::npos);
  p = gear_pairs::t2();
  p.gear_1.bore_diameter = 0.278;
  CHECK(refusal(p).find("gear_1: bore_diameter = 0.278 m, leaves too thin a rim") != std::string::npos);
}
