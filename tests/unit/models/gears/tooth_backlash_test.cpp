// Backlash from tolerances: the relations of DIN 3967 with entered numbers, temperature, percentiles.
#include <drev/core/error.hpp>
#include <drev/models/gears/tooth_backlash.hpp>

#include <array>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/models/gears/gear_pairs.hpp"

using namespace drev;

TEST_CASE("Backlash from allowances, tolerances and centre distance", "[gears]") {
  const GearPair pair(gear_pairs::t1n());
  const double cosine = std::cos(pair.operating_angle());
  // Circumferential .149 to .431 mm by allowances of .13 and .11, tolerances of .04 and .06, centre distance +-.125.
  const Backlash wide(pair, {.thickness = {{{-130e-6, 40e-6}, {-110e-6, 60e-6}}}, .centre_distance = 125e-6});
  CHECK(std::abs(wide.lowest() / cosine - 149e-6) < 0.5e-6);
  CHECK(std::abs(wide.highest() / cosine - 431e-6) < 0.5e-6);
  const Backlash plain(pair, {.thickness = {{{-75e-6, 0.0}, {-75e-6, 0.0}}}});
  CHECK(std::abs(plain.lowest() / cosine - 150e-6) < 1e-12);
  CHECK(plain.percentile(0.3) == plain.lowest());
  // The source's .15 and .43 mm as half gaps along the line of action, 20 and 16.16 degrees.
  CHECK(std::abs(0.5 * 150e-6 * cosine - 70.5e-6) < 0.05e-6);
  CHECK(std::abs(0.5 * 430e-6 * std::cos(GearPair(gear_pairs::t1()).operating_angle()) - 206.5e-6) < 0.05e-6);
}

TEST_CASE("Thinner teeth leave the backlash of the profile shifts that make them as thin", "[gears]") {
  // Thickness on the reference cylinder, exactly: m (pi/2 + 2 x tan(alpha_n)).
  GearGeometry helical = gear_pairs::pair(4, 25, 50, 0.5, 0.5, -0.27, 163.5e-3);
  helical.helix_angle = 20.0 * 3.14159265358979323846 / 180.0;
  for (const GearGeometry& drawing :
       {gear_pairs::t1(0.49700709762), gear_pairs::pair(4, 25, 50, 0.5, 0.5, -0.27, 153.68e-3),
        gear_pairs::pair(4, 25, 50, 0.0, 0.0, 0.0, 150e-3), helical}) {
    const std::array<double, 2> thinner{90e-6, 70e-6};
    GearGeometry shifted = drawing;
    for (const int i : {0, 1}) {
      GearData& gear = i == 0 ? shifted.gear_1 : shifted.gear_2;
      gear.tip_diameter = 2.0 * GearPair(drawing).contour(i).usable_tip_radius();
      gear.profile_shift -=
          thinner[static_cast<std::size_t>(i)] / (2.0 * shifted.module * std::tan(shifted.pressure_angle));
    }
    const double allowed =
        Backlash(GearPair(drawing), {.thickness = {{{-thinner[0], 0.0}, {-thinner[1], 0.0}}}}).lowest();
    INFO(drawing.module << " m, " << drawing.gear_1.teeth << " teeth: " << allowed << " m");
    CHECK(std::abs(allowed - GearPair(shifted).normal_backlash()) < 1e-12);
  }
}

TEST_CASE("Percentiles of the backlash", "[gears]") {
  const GearPair pair(gear_pairs::t1n());
  const Backlash both(pair, {.thickness = {{{-100e-6, 50e-6}, {-100e-6, 50e-6}}}});
  const double cosine = std::cos(pair.operating_angle());
  CHECK(std::abs(both.percentile(0.5) - both.mean()) < 1e-12);
  // The sum of two equal even distributions is a triangle: an eighth lies below the middle of the first half.
  CHECK(std::abs(both.percentile(0.125) / cosine - 225e-6) < 1e-11);
  CHECK(both.percentile(0.0) == both.lowest());
  CHECK(both.percentile(1.0) == both.highest());
  const Backlash three(pair, {.thickness = {{{-100e-6, 50e-6}, {-100e-6, 40e-6}}}, .centre_distance = 50e-6});
  CHECK(std::abs(three.percentile(0.5) - three.mean()) < 1e-12);
  CHECK(std::abs(three.percentile(0.01) + three.percentile(0.99) - 2.0 * three.mean()) < 1e-12);
}

TEST_CASE("Backlash at working temperature", "[gears]") {
  const GearPair pair(gear_pairs::t2());
  BacklashTolerances t{.thickness = {{{-100e-6, 0.0}, {-100e-6, 0.0}}}};
  const double cold = Backlash(pair, t).lowest();
  t.temperature_rise = {60.0, 60.0};
  t.housing_temperature_rise = 60.0;
  CHECK(std::abs(Backlash(pair, t).lowest() - cold) < 1e-12);  // all alike: nothing to first order
  t.housing_temperature_rise = 30.0;
  const double widening = -0.417003544 * 11.5e-6 * 30.0;
  CHECK(std::abs(Backlash(pair, t).lowest() - cold - 2.0 * std::sin(pair.operating_angle()) * widening) <
        1e-11);
  t.temperature_rise = {200.0, 200.0};  // hot gears in a cold housing
  t.housing_temperature_rise = 0.0;
  CHECK_THROWS_AS(Backlash(pair, t), ModelError);
  t = {.thickness = {{{100e-6, -1.0}, {0.0, 0.0}}}};
  CHECK_THROWS_AS(Backlash(pair, t), ModelError);
}
