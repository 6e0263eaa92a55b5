// Covers solvers/strength/class_judgement.hpp and solvers/strength/exceeded_ranges.hpp: ranges, limits and chatter of sweeps whose answers are known.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/strength/class_judgement.hpp>

#include <algorithm>
#include <cmath>
#include <complex>

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
  CHECK(s.exceeded[0].kept_below == 120.0);  // the ends are no better known than to the grid
  CHECK(s.exceeded[0].kept_above == 180.0);
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
  // The section's own top of the order, where the critical's is another section's.
  LinearSweep other = triangle();
  other.criticals[0].section = 1, other.criticals[0].speed = 145.0;
  other.criticals[0].in_sections = {{.speed = 150.0}, {.speed = 145.0}};
  const auto own = judge_sweep(other, strength).sections.front().barred;
  REQUIRE(own.size() == 1);
  CHECK(own[0].speed == 150.0);
  CHECK(own[0].from == Approx(16.0 * 150.0 / 17.4));
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

TEST_CASE("A section is not within a rule that has no limit at any of the speeds", "[strength]") {
  using Verdict = ClassJudgement::Verdict;
  const LinearSweep sweep = triangle();
  Strength strength;
  strength.sections = {shaft_of(0.34)};
  strength.sections[0].tensile_strength = 600e6, strength.sections[0].shape_factor = 0.6;
  strength.rated_speed = 0.5 * sweep.speeds.front();
  const ClassJudgement beyond = judge_sweep(sweep, strength);
  CHECK(beyond.sections[0].torque_undecided());
  CHECK(beyond.verdict() == Verdict::undecided);
  strength.sections[0].permissible_torque = 1e9;  // which holds where the rule does not
  CHECK(judge_sweep(sweep, strength).verdict() == Verdict::within);
}

TEST_CASE("A limit of heat that is known at some speeds only is kept by no train, and may be exceeded",
          "[strength]") {
  using Verdict = ClassJudgement::Verdict;
  LinearSweep sweep = triangle();
  Strength strength;
  strength.sections = {shaft_of(0.05)};
  strength.sections[0].permissible_torque = 5000.0;
  strength.sections[0].permissible_heat = 50.0;
  CHECK(judge_sweep(sweep, strength).verdict() == Verdict::within);
  sweep.sections[0].heat[4] = std::nan("");
  const ClassJudgement some = judge_sweep(sweep, strength);
  CHECK(some.sections[0].heat_unknown == std::vector<double>{180.0});
  CHECK(some.sections[0].heat_undecided());
  CHECK_FALSE(some.sections[0].heat_judged());
  CHECK(some.verdict() == Verdict::undecided);
  CHECK_FALSE(some.accepted());
  sweep.sections[0].heat.setConstant(std::nan(""));
  CHECK(judge_sweep(sweep, strength).verdict() == Verdict::undecided);
  // Heat alone has a limit: the section is not one without.
  strength.sections[0].permissible_torque = SectionStrength::kNone;
  CHECK(judge_sweep(sweep, strength).not_judged == std::vector<std::string>{"mesh.force_N"});
  // Too much at one speed decides, whatever it is at the others; without a limit there is nothing to decide.
  sweep.sections[0].heat[1] = 51.0;
  CHECK(judge_sweep(sweep, strength).verdict() == Verdict::exceeded);
  strength.sections[0].permissible_heat = SectionStrength::kNone;
  ClassJudgement free = judge_sweep(sweep, strength);
  CHECK(free.verdict() == Verdict::within);
  free.without_motion = {220.0};
  CHECK(free.verdict() == Verdict::undecided);
}

TEST_CASE("Heat and chatter are judged at the peaks between the speeds, too", "[strength]") {
  LinearSweep sweep = triangle();
  // The mesh's mean is 1,200 N, so that no speed of the grid has a ratio above 1; at 150 rad/s it is 1,500 / 1,200.
  sweep.sections[1].mean.setConstant(-1200.0);
  SweepPeak peak;
  peak.section = 1, peak.speed = 150.0, peak.half_range = 1500.0, peak.mean = -1200.0;
  peak.maximum = 1500.0, peak.minimum = -1500.0;
  sweep.peaks.push_back(peak);
  sweep.sections[0].heat_peak = 90.0, sweep.sections[0].heat_peak_speed = 151.0;
  Strength strength;
  strength.sections = {shaft_of(0.05)};
  strength.sections[0].permissible_heat = 50.0;
  const ClassJudgement found = judge_sweep(sweep, strength);
  CHECK(found.sections[0].heat == 90.0);
  CHECK(found.sections[0].heat_speed == 151.0);
  CHECK(found.sections[0].heat_exceeds());
  CHECK_FALSE(found.accepted());
  CHECK(found.not_judged == std::vector<std::string>{"mesh.force_N"});  // the shaft's heat is judged
  REQUIRE(found.chatter.size() == 1);
  CHECK(found.chatter[0].range.worst == Approx(1.25));
  CHECK(found.chatter[0].range.worst_speed == 150.0);
  // Straight lines from 800 / 1200 at 140 and 160.
  CHECK(found.chatter[0].range.from == Approx(140.0 + 10.0 * (1.0 / 3.0) / (1.25 - 2.0 / 3.0)));
  CHECK(found.chatter[0].separated == 1);
  // The heat at a peak of the half range counts as well.
  sweep.peaks[0].heat = 95.0;
  CHECK(judge_sweep(sweep, strength).sections[0].heat == 95.0);
  CHECK(judge_sweep(sweep, strength).sections[0].heat_speed == 150.0);
}

TEST_CASE("Why a range may not be passed, or is not judged", "[strength]") {
  using Passing = ExceededRange::Passing;
  Strength strength;
  strength.sections = {shaft_of(0.05)};
  SectionStrength& shaft = strength.sections.front();
  shaft.permissible_torque = 500.0;
  const auto passing = [&strength](double transient, double rated) {
    strength.sections.front().transient_torque = transient;
    strength.rated_speed = rated;
    return judge_sweep(triangle(), strength).sections.front().exceeded.at(0).passing;
  };
  const double none = SectionStrength::kNone;
  CHECK(passing(1200.0, 300.0) == Passing::permitted);
  CHECK(passing(950.0, 300.0) == Passing::above_limit);
  CHECK(passing(none, 300.0) == Passing::no_limit);
  CHECK(passing(none, 180.0) == Passing::near_rated);
  CHECK(passing(1200.0, none) == Passing::no_rated_speed);
  CHECK(to_text(Passing::no_limit) == std::string("no transient limit given"));
}

TEST_CASE("Beside an unbounded peak a range ends where a hyperbola meets the limit", "[strength]") {
  LinearSweep sweep = triangle();
  // 4,000 N m (rad/s) / |w - 150| at the speeds; at 500 N m the distance is 8 rad/s.
  Vector half(6);
  for (Eigen::Index i = 0; i < 6; ++i)
    half[i] = 4000.0 / std::abs(sweep.speeds[static_cast<std::size_t>(i)] - 150.0);
  sweep.sections[0].maximum = half, sweep.sections[0].minimum = -half;
  sweep.peaks[0].half_range = HUGE_VAL;
  Strength strength;
  strength.sections = {shaft_of(0.05)};
  strength.sections[0].permissible_torque = 500.0;
  const SectionJudgement s = judge_sweep(sweep, strength).sections.front();
  CHECK(std::isinf(s.utilisation));
  REQUIRE(s.exceeded.size() == 1);
  CHECK(s.exceeded[0].from == Approx(142.0));
  CHECK(s.exceeded[0].to == Approx(158.0));
  CHECK(s.exceeded[0].worst_speed == 150.0);
  // A peak at a speed of the grid replaces what rounding left there.
  sweep.peaks[0].speed = 140.0;
  CHECK(std::isinf(judge_sweep(sweep, strength).sections.front().utilisation));
}

TEST_CASE("Ends are where the solved sweep crosses the limit, those of torque and of chatter at once",
          "[strength]") {
  // 4,000 N m (rad/s) / |w - 150| in the shaft: 500 N m at 142 and 158 rad/s. In the mesh 800 exp(-((w - 150) / 20)^2) N with
  // a mean that falls from -300 N by 1 N each rad/s beyond 150 rad/s.
  const auto shaft = [](double w) { return 4000.0 / std::abs(w - 150.0); };
  const auto mesh = [](double w) { return 800.0 * std::exp(-std::pow((w - 150.0) / 20.0, 2)); };
  int rounds = 0;
  const SweepAt at = [&](const std::vector<double>& speeds) {
    ++rounds;
    LinearSweep sweep = triangle();
    sweep.speeds = speeds;
    const auto count = static_cast<Eigen::Index>(speeds.size());
    for (SweepSection& s : sweep.sections)
      s.maximum.resize(count), s.minimum.resize(count), s.mean.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double w = speeds[static_cast<std::size_t>(i)];
      sweep.sections[0].maximum[i] = shaft(w), sweep.sections[1].maximum[i] = mesh(w);
      sweep.sections[1].mean[i] = -300.0 - (w - 150.0);
    }
    for (SweepSection& s : sweep.sections) s.minimum = -s.maximum;
    return sweep;
  };
  LinearSweep sweep = at(triangle().speeds);
  rounds = 0;
  sweep.peaks = triangle().peaks;
  sweep.peaks[0].half_range = HUGE_VAL;
  Strength strength;
  strength.sections = {shaft_of(0.05)};
  strength.sections[0].permissible_torque = 500.0;
  const ClassJudgement found = judge_sweep(sweep, strength, at);
  REQUIRE(found.sections[0].exceeded.size() == 1);
  CHECK(found.sections[0].exceeded[0].from == Approx(142.0).epsilon(1e-7));
  CHECK(found.sections[0].exceeded[0].to == Approx(158.0).epsilon(1e-7));
  // Roots of 800 exp(-(x / 20)^2) = |300 + x| by a separate program: x = -20.509949116 and 19.171672957.
  REQUIRE(found.chatter.size() == 1);
  CHECK(found.chatter[0].range.from == Approx(150.0 - 20.509949116).epsilon(1e-7));
  CHECK(found.chatter[0].range.to == Approx(150.0 + 19.171672957).epsilon(1e-7));
  CHECK(rounds < 25);
}

TEST_CASE("The largest utilisation is followed to its top where the limit falls with the speed",
          "[strength]") {
  // Two discs of 20 and 30 t m^2 on a shaft of 20 MN m/rad and 0.34 m, judged by UR M68.5 (600 MPa, C_K 0.6).
  constexpr double k = 20e6, first = 20e3, second = 30e3, order = 5.0, mu = first * second / (first + second);
  const double c = 0.2 * std::sqrt(k * mu);
  Strength strength;
  strength.sections = {shaft_of(0.34)};
  strength.sections[0].tensile_strength = 600e6, strength.sections[0].shape_factor = 0.6;
  strength.rated_speed = rpm(100.0);
  const auto used = [&](double w) {  // of a torque of 1 N m
    const double W = order * w;
    const std::complex<double> z(k, W * c);
    return std::abs(z * mu / first / (z - mu * W * W)) /
           torque_limit(strength.sections[0], w / strength.rated_speed).continuous;
  };
  double top = 0.0, at = 0.0;
  for (double n = 60.0; n < 100.0; n += 1e-3)
    if (used(rpm(n)) > top) top = used(rpm(n)), at = n;
  constexpr double largest = 1.0046;
  Model m("ship");
  m.add_node("engine");
  m.add_node("propeller");
  m.set_reference("engine", constant_speed(rpm(100.0)));
  m.add<Inertia>("J_e", {"engine"}, {.inertia = first});
  m.add<Inertia>("J_p", {"propeller"}, {.inertia = second});
  m.add<ShaftSpring>("shaft", {"engine", "propeller"}, {.stiffness = k, .damping = c});
  m.add<EngineOrderTorque>("gas", {"engine"},
                           {.harmonics = {{order, largest / top, 0.0}}, .twist_feedback = false});
  const System system = m.build();
  LinearSweepOptions options{.orders = {order}};
  for (double n = 30.0; n < 101.0; n += 5.0) options.speeds.push_back(rpm(n));
  const LinearSweep sweep = sweep_linear(system, options);
  const ClassJudgement found = judge_sweep(sweep, strength, sweep_between(system, options));
  const SectionJudgement& s = found.sections.front();
  CHECK(s.utilisation == Approx(largest).epsilon(1e-8));
  CHECK(to_rpm(s.utilisation_speed) == Approx(at).margin(2e-3));
  CHECK(found.verdict() == ClassJudgement::Verdict::exceeded);
  REQUIRE(s.exceeded.size() == 1);
  CHECK(used(s.exceeded[0].from) == Approx(top / largest).epsilon(1e-6));
  CHECK(used(s.exceeded[0].to) == Approx(top / largest).epsilon(1e-6));
  CHECK(s.exceeded[0].worst == s.utilisation);
  // Its speeds and the peak of the torque alone do not show it.
  LinearSweep alone = sweep;
  alone.points.clear();
  CHECK(judge_sweep(alone, strength).verdict() == ClassJudgement::Verdict::within);
}

TEST_CASE("All resonances below the end of the rule are judged, however many larger ones lie above",
          "[strength]") {
  // Two discs of 1 kg m^2 and a shaft, excited by orders 0.5 to 12. The rule ends at 315 rpm, and the 17 orders that resonate
  // above it have the larger torques.
  constexpr double k = 50e3, c = 2.0, mu = 0.5;
  constexpr int orders = 24, angles = 7200;
  std::vector<Harmonic> harmonics;
  LinearSweepOptions options;
  for (int i = 1; i <= orders; ++i) {
    harmonics.push_back({0.5 * i, 400.0 / i, 0.0});
    options.orders.push_back(0.5 * i);
  }
  Model m("train");
  m.add_node("a");
  m.add_node("b");
  m.set_reference("a", constant_speed(rpm(600.0)));
  m.add<Inertia>("J_a", {"a"}, {.inertia = 1.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = k, .damping = c});
  m.add<EngineOrderTorque>("gas", {"a"}, {.harmonics = harmonics, .twist_feedback = false});
  const System system = m.build();
  Strength strength;
  strength.sections = {shaft_of(0.06)};
  strength.sections[0].tensile_strength = 600e6, strength.sections[0].shape_factor = 0.5;
  strength.rated_speed = rpm(300.0);
  // Of the closed form of each order, sampled over the cycle of two revolutions.
  std::vector<std::complex<double>> turns;
  for (int j = 0; j < angles; ++j) turns.push_back(std::polar(1.0, 2.0 * rpm(30.0) * j * 2.0 / angles));
  const auto used = [&](double w) {
    std::vector<double> sum(angles, 0.0);
    for (int i = 1; i <= orders; ++i) {
      const double W = 0.5 * i * w;
      const std::complex<double> z(k, W * c), torque = 400.0 / i * z * mu / (z - mu * W * W);
      for (int j = 0; j < angles; ++j)
        sum[static_cast<std::size_t>(j)] +=
            std::real(torque * turns[static_cast<std::size_t>(i * j % angles)]);
    }
    const auto [low, high] = std::minmax_element(sum.begin(), sum.end());
    return 0.5 * (*high - *low) / torque_limit(strength.sections[0], w / strength.rated_speed).continuous;
  };
  std::vector<SectionJudgement> found;
  for (const double step : {45.0, 15.0}) {
    options.speeds.clear();
    for (double n = 150.0; n <= 2400.0; n += step) options.speeds.push_back(rpm(n));
    const LinearSweep sweep = sweep_linear(system, options);
    found.push_back(judge_sweep(sweep, strength, sweep_between(system, options)).sections.front());
  }
  double largest = 0.0;
  for (double n = 300.0; n < 304.0; n += 0.05) largest = std::max(largest, used(rpm(n)));
  CHECK(found[0].utilisation == Approx(largest).epsilon(1e-3));
  CHECK(found[1].utilisation == Approx(found[0].utilisation).epsilon(1e-9));
  REQUIRE(found[0].exceeded.size() >= 3);
  REQUIRE(found[1].exceeded.size() == found[0].exceeded.size());
  for (std::size_t i = 0; i < found[0].exceeded.size(); ++i) {
    const ExceededRange &range = found[0].exceeded[i], &fine = found[1].exceeded[i];
    CHECK(used(range.from) == Approx(1.0).epsilon(3e-4));
    if (range.open_to)
      CHECK(to_rpm(range.to) == Approx(315.0));
    else
      CHECK(used(range.to) == Approx(1.0).epsilon(3e-4));
    CHECK(fine.from == Approx(range.from).epsilon(1e-6));
    CHECK(fine.to == Approx(range.to).epsilon(1e-6));
  }
}

TEST_CASE("A section that does not vibrate uses nothing of its limit", "[strength]") {
  LinearSweep still = triangle();
  for (Vector* values : {&still.sections[0].maximum, &still.sections[0].minimum}) values->setZero();
  still.peaks.clear();
  Strength strength;
  strength.sections = {shaft_of(0.05)};
  strength.sections[0].permissible_torque = 500.0;
  const ClassJudgement found = judge_sweep(still, strength);
  CHECK(found.sections[0].judged());
  CHECK(found.sections[0].utilisation == 0.0);
  CHECK(found.sections[0].rule == "permissible torque");
  CHECK(found.not_judged == std::vector<std::string>{"mesh.force_N"});
}

TEST_CASE("A limit while a range is passed is not below that in continuous running", "[strength]") {
  Strength strength;
  strength.sections = {shaft_of(0.05)};
  strength.sections[0].permissible_torque = 500.0, strength.sections[0].transient_torque = 400.0;
  strength.sections[0].permissible_stress = 30e6, strength.sections[0].transient_stress = 30e6;
  const std::vector<Finding> findings = check_strength(strength);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].parameter == "transient_torque");
  CHECK(findings[0].value == "400");
  CHECK(findings[0].unit == "N m");
  CHECK(findings[0].range.find("500 N m") != std::string::npos);
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
