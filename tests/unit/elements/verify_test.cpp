// check_element() must catch what is wrong: deliberately broken elements.
#include <drev/core/general_force.hpp>
#include <drev/core/law_element.hpp>
#include <drev/core/load.hpp>
#include <drev/core/verify.hpp>
#include <drev/elements/shaft_spring.hpp>

#include <cmath>
#include <functional>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;
using namespace drev::test;

namespace {

/// y = k x + k3 x^3 + c x', and a way to spoil the answer.
struct Law {
  std::function<void(const ScalarInput&, ScalarResponse&)> spoil = {};
  ScalarResponse operator()(const ScalarInput& in) const {
    const double k = 2e4, k3 = 5e6, c = 3.0, x = in.x;
    ScalarResponse r{.y = k * x + k3 * x * x * x + c * in.x_dot,
                     .dy_dx = k + 3 * k3 * x * x,
                     .dy_dx_dot = c,
                     .stored_energy = 0.5 * k * x * x + 0.25 * k3 * x * x * x * x,
                     .dissipated_power = c * in.x_dot * in.x_dot};
    if (spoil) spoil(in, r);
    return r;
  }
};

std::string report(std::function<void(const ScalarInput&, ScalarResponse&)> spoil) {
  return check_element(LawElement<Law>({std::move(spoil)}), 2).text();
}

/// An element made of whatever a test puts into its terms.
class Anything final : public Element {
 public:
  explicit Anything(std::function<void(Terms&)> fill) : fill_(std::move(fill)) {}
  std::string_view type() const override { return "anything"; }
  int min_nodes() const override { return 2; }
  void check(ParameterCheck&) const override {}
  void describe(int, Terms& terms) const override { fill_(terms); }

 private:
  std::function<void(Terms&)> fill_;
};

struct CountingLoad final : Load {
  mutable int calls = 0;
  LoadResponse evaluate(const LoadInput&) const override { return {.torque = 1.0 + ++calls}; }
};

struct WrongLoad final : Load {
  explicit WrongLoad(bool depends) : depends_(depends) {}
  LoadResponse evaluate(const LoadInput& in) const override {
    return {.torque = -2.0 * in.speed, .dtorque_dangle = 0.0, .dtorque_dspeed = depends_ ? 2.0 : 0.0};
  }
  bool depends_on_motion() const override { return depends_; }
  bool depends_;
};

/// f = (k d^3, -k d^3) + c relative rate, d = q_0 - q_1; history counts.
struct Coupling final : GeneralForce {
  Coupling(double tangent_factor, double skew, double damper)
      : factor(tangent_factor), skew(skew), damper(damper) {}
  double factor, skew, damper;
  int history_size() const override { return 1; }
  void initial_history(std::span<double> h) const override { h[0] = 7.0; }
  void evaluate(const LocalState& s, LocalResponse& r) const override {
    const double d = s.q[0] - s.q[1], w = s.v[0] - s.v[1], k = 1e3;
    const double y = k * d * d * d + damper * w, slope = factor * 3 * k * d * d;
    r.f << y + skew * s.q[1], -y;
    r.stiffness << slope, -slope + skew, -slope, slope;
    r.damping << damper, -damper, -damper, damper;
    r.stored_energy = 0.25 * k * d * d * d * d;
    r.dissipated_power = damper * w * w;
    r.history[0] = s.history[0] + 1.0;
  }
};

std::string report(const GeneralForce& force) {
  return check_element(Anything([&](Terms& t) { t.generals.push_back(&force); }), 2).text();
}

}  // namespace

TEST_CASE("a sound law passes") { CHECK(report(nullptr) == ""); }

TEST_CASE("wrong tangents are caught") {
  CHECK(contains(report([](auto&, auto& r) { r.dy_dx *= 1.001; }), "wrong tangent: dy_dx"));
  CHECK(contains(report([](auto&, auto& r) { r.dy_dx_dot = 0.0; }), "wrong tangent: dy_dx_dot"));
}

TEST_CASE("wrong energies and active dampers are caught") {
  CHECK(contains(report([](auto&, auto& r) { r.stored_energy *= 1.01; }), "energy does not match the force"));
  CHECK(contains(report([](auto&, auto& r) { r.stored_energy -= 1.0; }), "negative stored energy"));
  CHECK(
      contains(report([](auto&, auto& r) { r.dissipated_power *= 0.5; }), "dissipated power does not match"));
  const std::string active = report([](const ScalarInput& in, ScalarResponse& r) {
    r.y -= 6.0 * in.x_dot;
    r.dy_dx_dot -= 6.0;
    r.dissipated_power -= 6.0 * in.x_dot * in.x_dot;
  });
  CHECK(contains(active, "active damper"));
  CHECK(contains(active, "negative dissipated power"));
  CHECK(contains(
      report([](const ScalarInput& in, ScalarResponse& r) { r.stored_energy += 1.0 + std::sin(in.t); }),
      "varies() is false"));
}

TEST_CASE("impure and non-finite laws are caught") {
  int calls = 0;
  CHECK(contains(report([&calls](auto&, auto& r) { r.dissipated_power += 1e-9 * ++calls; }), "impure"));
  CHECK(contains(report([](auto&, auto& r) { r.y = NAN; }), "not finite"));
}

TEST_CASE("a failure is listed a few times only") {
  CHECK(check_element(LawElement<Law>({[](auto&, auto& r) { r.dy_dx *= 2; }}), 2).failures.size() == 3);
}

TEST_CASE("parameters and node counts are reported, and nothing is tried then") {
  CHECK(check_element(ShaftSpring({}), 2).text() ==
        "shaft spring: stiffness = NaN N m/rad, must be > 0 and finite");
  CHECK(contains(check_element(ShaftSpring({.stiffness = 1}), 1).text(), "1 given, takes 2 to 2"));
}

TEST_CASE("wrong loads are caught") {
  const auto report_load = [](const Load& load) {
    return check_element(Anything([&](Terms& t) { t.loads.push_back({0, &load}); }), 2).text();
  };
  CHECK(contains(report_load(CountingLoad()), "impure"));
  CHECK(contains(report_load(WrongLoad(true)), "wrong tangent: dtorque_dspeed = 2"));
  CHECK(contains(report_load(WrongLoad(false)), "depends_on_motion() is false"));
}

TEST_CASE("general forces") {
  CHECK(report(Coupling(1.0, 0.0, 5.0)) == "");
  CHECK(contains(report(Coupling(1.01, 0.0, 5.0)), "wrong tangent: stiffness"));
  CHECK(contains(report(Coupling(1.0, 10.0, 5.0)), "symmetric_tangent() is true"));
  CHECK(contains(report(Coupling(1.0, 0.0, -5.0)), "negative dissipated power"));
}

TEST_CASE("wrong matrices, speed_ratio_constraints and sizes are caught") {
  const auto report_terms = [](std::function<void(Terms&)> fill) {
    return check_element(Anything(std::move(fill)), 2).text();
  };
  CHECK(contains(report_terms([](Terms& t) { t.mass(0, 1) = 1.0; }), "unsymmetric matrix: mass"));
  CHECK(contains(report_terms([](Terms& t) { t.damping(0, 0) = -1.0; }),
                 "matrix not positive semi-definite: damping"));
  // A spring that ties speeds without saying so.
  CHECK(contains(report_terms([](Terms& t) { t.stiffness << 1, -1, -1, 1; }), "speed_ratio_constraints"));
  // A speed ratio constraint of the wrong sign.
  CHECK(contains(report_terms([](Terms& t) {
                   t.stiffness << 1, -1, -1, 1;
                   t.speed_ratio_constraints.push_back({.b = Eigen::Vector2d(1, 1)});
                 }),
                 "speed_ratio_constraints"));
  CHECK(report_terms([](Terms& t) {
          t.stiffness << 1, -1, -1, 1;
          t.speed_ratio_constraints.push_back({.b = Eigen::Vector2d(1, -1)});
        }) == "");
  CHECK(
      contains(report_terms([](Terms& t) { t.scalars.push_back({.b = LocalRow::Ones(3)}); }), "scalar row"));
  CHECK(
      contains(report_terms([](Terms& t) { t.speed_ratio_constraints.push_back({.b = LocalRow::Zero(2)}); }),
               "ties 0 nodes"));
}
