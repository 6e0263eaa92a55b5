// Covers solvers/strength/class_judgement.hpp: ranges, limits and chatter of sweeps whose answers are known.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/strength/class_judgement.hpp>

#include <cmath>

#include "solvers/strength/iacs_m68.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

/// A shaft whose half range rises straight from 0 at 100 rad/s to 1000 N m at 150, and falls to 0 at 200, with the peak
/// between two speeds, and a mesh whose mean is 300 N while its half range is the same.
LinearSweep triangle() {
  LinearSweep sweep;
  for (const double speed : {100.0, 120.0, 140.0, 160.0, 180.0, 200.0}) sweep.speeds.push_back(speed);
  SweepSection shaft, mesh;
  shaft.name = "shaft.torque_Nm", shaft.unit = "N m";
  Vector half(6), heat(6);
  half << 0.0, 400.0, 800.0, 800.0, 400.0, 0.0;
  heat << 1.0, 2.0, 3.0, 30.0, 3.0, 2.0;
  shaft.maximum = half, shaft.minimum = -half, shaft.mean = Vector::Constant(6, 50.0), shaft.heat = heat;
  mesh = shaft;
  mesh.name = "mesh.force_N", mesh.unit = "N", mesh.contact = true, mesh.mean = Vector::Constant(6, -600.0);
  sweep.sections = {shaft, mesh};
  sweep.peaks = {{0, 150.0, 1000.0, false}};
  sweep.criticals = {{0, 5.0, 150.0, 10.0, 0.01, 0, 900.0, 1000.0}};
  return sweep;
}

SectionStrength shaft_of(double diameter) {
  SectionStrength s;
  s.element = "shaft";
  s.diameter = diameter;
  return s;
}

}  // namespace

TEST_CASE("Where a limit is exceeded, by straight lines between speeds and peaks", "[strength]") {
  Strength strength;
  SectionStrength shaft = shaft_of(0.05);
  shaft.permissible_torque = 500.0;
  shaft.transient_torque = 1200.0;
  strength.sections = {shaft};
  strength.rated_speed = 300.0;
  const ClassJudgement found = judge_sweep(triangle(), strength);
  REQUIRE(found.sections.size() == 1);
  const SectionJudgement& s = found.sections.front();
  CHECK(s.utilisation == Approx(2.0));
  CHECK(s.utilisation_speed == 150.0);
  CHECK(s.rule == "permissible torque");
  REQUIRE(s.exceeded.size() == 1);
  CHECK(s.exceeded[0].from == Approx(125.0));
  CHECK(s.exceeded[0].to == Approx(175.0));
  CHECK(s.exceeded[0].worst == Approx(2.0));
  CHECK(s.exceeded[0].may_be_passed());
  CHECK_FALSE(s.exceeded[0].open_from);
  CHECK_FALSE(found.accepted());
  CHECK(s.heat == 30.0);
  CHECK(s.heat_speed == 160.0);
  CHECK(found.not_judged == std::vector<std::string>{"mesh.force_N"});
  // The peak alone exceeds the limit: it is seen though no speed of the sweep shows it.
  strength.sections[0].permissible_torque = 900.0;
  const auto narrow = judge_sweep(triangle(), strength).sections.front().exceeded;
  REQUIRE(narrow.size() == 1);
  CHECK(narrow[0].from == Approx(145.0));
  CHECK(narrow[0].to == Approx(155.0));
  // Not to be passed: above the transient limit, or near the rated speed.
  strength.sections[0].transient_torque = 950.0;
  CHECK_FALSE(judge_sweep(triangle(), strength).sections.front().exceeded[0].may_be_passed());
  strength.sections[0].transient_torque = 1200.0;
  strength.rated_speed = 180.0;
  CHECK_FALSE(judge_sweep(triangle(), strength).sections.front().exceeded[0].may_be_passed());
}

TEST_CASE("The lowest of a section's limits holds, as a torque", "[strength]") {
  SectionStrength s = shaft_of(0.1);
  const double modulus = polar_section_modulus(0.1);
  s.permissible_stress = 40e6;
  s.stress_concentration = 2.0;
  TorqueLimit limit = torque_limit(s, 0.5);
  CHECK(limit.continuous == Approx(20e6 * modulus));  // local stress
  CHECK(limit.rule == "permissible stress");
  CHECK(std::isnan(limit.transient));
  s.permissible_stress = 400e6;
  s.tensile_strength = 600e6;
  s.shape_factor = 1.0;
  limit = torque_limit(s, 0.5);
  const iacs_m68::Permissible rule = iacs_m68::permissible_stress(600e6, 1.0, 0.1, 0.5);
  CHECK(limit.continuous == Approx(rule.continuous * modulus));  // nominal stress
  CHECK(limit.transient == Approx(rule.transient * modulus));
  CHECK(limit.rule == "IACS UR M68.5");
  CHECK(torque_limit(s, 1.2).rule == "permissible stress");  // the rule ends at 1.05
}

TEST_CASE("Barred range by rule about a critical above the limit", "[strength]") {
  Strength strength;
  SectionStrength shaft = shaft_of(0.04);
  shaft.tensile_strength = 600e6;
  shaft.shape_factor = 1.0;
  strength.sections = {shaft};
  strength.rated_speed = 250.0;
  const auto barred = judge_sweep(triangle(), strength).sections.front().barred;
  REQUIRE(barred.size() == 1);
  CHECK(barred[0].speed_ratio == Approx(0.6));
  CHECK(barred[0].from == Approx(16.0 * 150.0 / 17.4));
  CHECK(barred[0].to == Approx(17.4 * 150.0 / 16.0));
  strength.rated_speed = 180.0;  // ratio 0.83
  CHECK(judge_sweep(triangle(), strength).sections.front().barred[0].to == 0.0);
}

TEST_CASE("Chatter: where the vibratory force of a mesh exceeds its mean", "[strength]") {
  Strength strength;
  strength.sections = {shaft_of(0.05)};
  strength.sections[0].permissible_torque = 5000.0;
  const ClassJudgement found = judge_sweep(triangle(), strength);
  REQUIRE(found.chatter.size() == 1);
  CHECK(found.chatter[0].range.from == Approx(130.0));
  CHECK(found.chatter[0].range.to == Approx(170.0));
  CHECK(found.chatter[0].range.worst == Approx(800.0 / 600.0));
  CHECK(found.chatter[0].separated == 2);
  CHECK(found.accepted());
}

TEST_CASE("Faults of strength data are listed at once", "[strength]") {
  Strength strength;
  SectionStrength bad = shaft_of(0.05);
  bad.bore = 0.06;
  bad.tensile_strength = 900e6;
  bad.stress_concentration = 0.5;
  SectionStrength missing = shaft_of(0.05);
  missing.element = "shft";
  strength.sections = {bad, missing};
  try {
    judge_sweep(triangle(), strength);
    FAIL("was taken");
  } catch (const ModelError& error) {
    const std::string text = error.what();
    for (const char* part : {"bore", "tensile_strength", "stress_concentration", "rated_speed", "shft"})
      CHECK(text.find(part) != std::string::npos);
  }
}
