// The dead zone with its damping laws.
#include <drev/core/law_element.hpp>
#include <drev/elements/backlash_law.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;
using namespace drev::test;

namespace {

constexpr double kStiffness = 2e8;  // N/m
constexpr CurvePoint kConstant{kStiffness, 0.0};

/// The law at a constant stiffness, as an element's.
struct LawAtConstantStiffness {
  BacklashLaw law;
  ScalarResponse operator()(const ScalarInput& in) const { return law.evaluate(in.x, in.x_dot, kConstant); }
  std::span<const double> kinks() const { return law.kinks(); }
  std::optional<Gap> gap() const { return law.gap(); }
};

BacklashLaw law(MeshDamping damping_law, double backlash = 80e-6, double damping = 1000.0) {
  return BacklashLaw({.normal_backlash = backlash, .damping = damping, .damping_law = damping_law});
}

}  // namespace

TEST_CASE("dead zone by hand: 2b = 80 um, k = 2e8 N/m") {
  const BacklashLaw undamped({.normal_backlash = 80e-6});
  CHECK(undamped.evaluate(39e-6, 1.0, kConstant).y == 0.0);
  CHECK(undamped.evaluate(-39e-6, 1.0, kConstant).dy_dx == 0.0);
  const ScalarResponse front = undamped.evaluate(50e-6, 1.0, kConstant);
  CHECK(front.y == Approx(2000.0));  // 10 um * 2e8
  CHECK(front.dy_dx == kStiffness);
  CHECK(front.stored_energy == Approx(0.01));  // 2e8 * (1e-5)^2/2
  CHECK(front.dissipated_power == 0.0);
  CHECK(undamped.evaluate(-50e-6, 1.0, kConstant).y == Approx(-2000.0));
  REQUIRE(undamped.gap());
  CHECK(undamped.gap()->low == -40e-6);
  CHECK(undamped.gap()->high == 40e-6);
  CHECK(undamped.kinks().size() == 2);
}

TEST_CASE("proportional damping grows from the edge and saturates at p_ref = b/20 = 2 um") {
  const BacklashLaw l = law(MeshDamping::proportional);
  // p = 1 um, half of p_ref: c_eff = 500; 200 N + 500 * 0.1 m/s.
  CHECK(l.evaluate(41e-6, 0.1, kConstant).y == Approx(250.0));
  CHECK(l.evaluate(41e-6, 0.1, kConstant).dy_dx_dot == Approx(500.0));
  // p = 10 um: c_eff = c.
  CHECK(l.evaluate(50e-6, 0.1, kConstant).y == Approx(2100.0));
  CHECK(l.evaluate(-50e-6, -0.1, kConstant).y == Approx(-2100.0));
  CHECK(l.evaluate(50e-6, 0.1, kConstant).dissipated_power == Approx(10.0));
  // Continuous at the edge at any rate.
  CHECK(std::abs(l.evaluate(40e-6 + 1e-15, 10.0, kConstant).y) < 1e-4);
  CHECK(l.kinks().size() == 4);
}

TEST_CASE("flanks never pull") {
  for (const auto kind : {MeshDamping::proportional, MeshDamping::limited, MeshDamping::contact_only}) {
    const BacklashLaw l = law(kind);
    // p = 10 um carries 2000 N; leaving at 3 m/s the damper wants -3000 N.
    const ScalarResponse front = l.evaluate(50e-6, -3.0, kConstant);
    CHECK(front.y == 0.0);
    CHECK(front.dy_dx == 0.0);
    CHECK(front.dy_dx_dot == 0.0);
    CHECK(front.dissipated_power == Approx(6000.0));  // 2000 N * 3 m/s of the spring is lost
    CHECK(l.evaluate(-50e-6, 3.0, kConstant).y == 0.0);
    CHECK(l.evaluate(0.0, 5.0, kConstant).y == 0.0);
  }
}

TEST_CASE("the source's law acts in the gap and pulls") {
  const BacklashLaw l = law(MeshDamping::always);
  CHECK(l.evaluate(0.0, 5.0, kConstant).y == Approx(5000.0));
  CHECK(l.evaluate(50e-6, -3.0, kConstant).y == Approx(-1000.0));
  CHECK(l.evaluate(0.0, 5.0, kConstant).dissipated_power == Approx(25000.0));
}

TEST_CASE("limited damping adds at most the spring's own force") {
  const BacklashLaw l = law(MeshDamping::limited);
  // p = 1 um: 200 N of spring; the damper would add 1000 N/(m/s) * 1 m/s.
  CHECK(l.evaluate(41e-6, 1.0, kConstant).y == Approx(400.0));
  CHECK(l.evaluate(41e-6, 0.1, kConstant).y == Approx(300.0));
  CHECK(l.evaluate(-41e-6, -1.0, kConstant).y == Approx(-400.0));
  CHECK(std::abs(l.evaluate(40e-6 + 1e-15, 10.0, kConstant).y) < 1e-4);
}

TEST_CASE("contact-only damping jumps at the edge") {
  const BacklashLaw l = law(MeshDamping::contact_only);
  CHECK(l.evaluate(40e-6, 1.0, kConstant).y == 0.0);
  CHECK(l.evaluate(40e-6 + 1e-12, 1.0, kConstant).y == Approx(1000.0));
}

TEST_CASE("without backlash every damping law is the same linear spring and damper") {
  for (const auto kind :
       {MeshDamping::proportional, MeshDamping::limited, MeshDamping::contact_only, MeshDamping::always}) {
    const BacklashLaw l = law(kind, 0.0);
    CHECK_FALSE(l.gap());
    CHECK(l.kinks().empty());
    for (const double x : {-1e-5, 0.0, 1e-5})
      CHECK(l.evaluate(x, -3.0, kConstant).y == Approx(kStiffness * x - 3000.0));
    CHECK(l.evaluate(1e-5, -3.0, kConstant).dissipated_power == Approx(9000.0));
  }
}

TEST_CASE("every damping law is sound at random states") {
  for (const auto kind :
       {MeshDamping::proportional, MeshDamping::limited, MeshDamping::contact_only, MeshDamping::always})
    for (const double backlash : {0.0, 80e-6, 0.7853981633974483})
      CHECK(check_element(LawElement<LawAtConstantStiffness>({law(kind, backlash)}), 2, {.samples = 2000})
                .text() == "");
}

TEST_CASE("a flank that gets stiffer with its load, by hand and at random states") {
  const Stiffening stiffening{{0.0, 5e-6, 20e-6}, {0.9, 1.0, 1.2}};
  const BacklashLaw undamped({.normal_backlash = 80e-6, .stiffening = stiffening});
  // p = 30 um: 5 um at 0.9, 15 um at 1, 10 um at 1.2: 31.5 um times 2e8 N/m.
  const ScalarResponse deep = undamped.evaluate(70e-6, 1.0, kConstant);
  CHECK(deep.y == Approx(6300.0));
  CHECK(deep.dy_dx == Approx(1.2 * kStiffness));
  // 0.9 p^2/2 to 5 um; 4.5 um + s to 20 um; 19.5 um + 1.2 s to 30 um.
  CHECK(deep.stored_energy == Approx(kStiffness * 1e-12 * (11.25 + 67.5 + 112.5 + 195.0 + 60.0)));
  CHECK(undamped.evaluate(-70e-6, 1.0, kConstant).y == Approx(-6300.0));
  CHECK(undamped.evaluate(43e-6, 1.0, kConstant).y == Approx(540.0));
  REQUIRE(undamped.gap());
  CHECK(undamped.gap()->high == 40e-6);
  CHECK(undamped.kinks().size() == 6);
  // p = 10 um: 9.5 um times 2e8 N/m and the full damper.
  const BacklashLaw damped({.normal_backlash = 80e-6, .damping = 1000.0, .stiffening = stiffening});
  CHECK(damped.evaluate(50e-6, 0.1, kConstant).y == Approx(2000.0));
  CHECK(damped.evaluate(50e-6, -1.95, kConstant).y == 0.0);  // lets go
  for (const auto kind :
       {MeshDamping::proportional, MeshDamping::limited, MeshDamping::contact_only, MeshDamping::always})
    for (const double backlash : {0.0, 80e-6}) {
      const BacklashLaw l(
          {.normal_backlash = backlash, .damping = 1000.0, .damping_law = kind, .stiffening = stiffening});
      CHECK(check_element(LawElement<LawAtConstantStiffness>({l}), 2, {.samples = 2000}).text() == "");
    }
}

TEST_CASE("a loading cycle dissipates: work done over it is positive") {
  // x = 60 um sin(w t) over whole periods; for `always` the work is exactly pi c X^2 w a period.
  const double amplitude = 60e-6, omega = 2000.0, period = 2 * M_PI / omega;
  const auto work = [&](const BacklashLaw& l) {
    return integral(
        [&](double t) {
          const double x_dot = amplitude * omega * std::cos(omega * t);
          return l.evaluate(amplitude * std::sin(omega * t), x_dot, kConstant).y * x_dot;
        },
        0.0, period, 200000);
  };
  const double linear = M_PI * 1000.0 * amplitude * amplitude * omega;
  CHECK(work(law(MeshDamping::always)) == Approx(linear).epsilon(1e-6));
  const double proportional = work(law(MeshDamping::proportional));
  const double contact_only = work(law(MeshDamping::contact_only));
  CHECK(proportional > 0.0);
  CHECK(contact_only > proportional);
  CHECK(contact_only < linear);
  CHECK(std::abs(work(law(MeshDamping::proportional, 80e-6, 0.0))) < 1e-9 * linear);
}

TEST_CASE("backlash law: faults") {
  const auto faults = [](const BacklashLaw::Params& p) {
    std::vector<Finding> all;
    ParameterCheck check("mesh", all);
    BacklashLaw(p).check(check);
    return all.empty() ? std::string() : std::string(ModelError(all).what());
  };
  CHECK(faults({}) == "");
  CHECK(faults({.normal_backlash = -0.5}) == "mesh: normal_backlash = -0.5 m, must be >= 0 and finite");
  CHECK(contains(faults({.damping = NAN}), "damping = NaN N s/m"));
  CHECK(contains(faults({.reference_penetration = 0.0}), "reference_penetration = 0 m"));
  CHECK(faults({.normal_backlash = 80e-6, .damping = 1.0, .stiffening = {{0.0, 3e-6}, {0.9, 1.0}}}) == "");
  CHECK(contains(faults({.normal_backlash = 80e-6, .damping = 1.0, .stiffening = {{0.0, 1e-6}, {0.9, 1.0}}}),
                 "the penetration up to which the damping rises"));
  CHECK(contains(faults({.stiffening = {{0.0, 2e-6, 2e-6}, {0.9, 1.0, 1.0}}}), "penetrations[2]"));
  CHECK(contains(faults({.stiffening = {{1e-6}, {0.9}}}), "penetrations[0] = 1e-06 m, must be 0"));
  CHECK(contains(faults({.stiffening = {{0.0, 2e-6}, {0.9, -1.0}}}), "slopes[1]"));
  CHECK(contains(faults({.stiffening = {{0.0}, {}}}), "stiffening.slopes"));
}
