// TimeCurve: a formula over time by cubics, and friction's engagement by it.
#include <drev/core/units.hpp>
#include <drev/elements/friction/clutch.hpp>
#include <drev/elements/time_curve.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

namespace {

TimeCurve::Params closing() {
  return {.function = [](const Dual& t) { return 1.0 - exp(-(t - 0.1) / 0.2); }, .from = 0.1, .to = 1.7};
}

std::string curve_findings(TimeCurve::Params p) {
  return test::findings(Clutch({.torque = 1.0, .engagement_formula = TimeCurve(std::move(p))}));
}

}  // namespace

TEST_CASE("A formula over time: its values and slopes to the accuracy, constant outside") {
  const auto exact = [](double t) { return 1.0 - std::exp(-(t - 0.1) / 0.2); };
  for (const double accuracy : {1e-6, 1e-10}) {
    TimeCurve::Params p = closing();
    p.accuracy = accuracy;
    const TimeCurve curve(p);
    double worst = 0.0;
    for (double t = 0.1; t < 1.7; t += 0.00137) worst = std::max(worst, std::abs(curve.at(t)[0] - exact(t)));
    CHECK(worst < 1.2 * accuracy);
    CHECK(worst > 1e-4 * accuracy);
    // Of fourth order: some 10 times as many stretches for 10^4.
    CHECK(curve.knots().size() < (accuracy < 1e-8 ? 400 : 40));
    CHECK(curve.knots().front() == 0.1);
    CHECK(curve.knots().back() == 1.7);
  }
  const TimeCurve curve(closing());
  CHECK(curve.at(0.5)[1] == Approx(std::exp(-2.0) / 0.2).epsilon(1e-7));
  CHECK(curve.at(0.0) == std::array<double, 4>{0.0, 0.0, 0.0, 0.0});
  CHECK(curve.at(5.0)[0] == Approx(exact(1.7)));
  CHECK(curve.at(5.0)[1] == 0.0);
  CHECK(curve.smallest() >= -1e-10);
}

TEST_CASE("A formula over time: jumps and kinks at its breakpoints, one that is none is refused") {
  TimeCurve::Params p{
      .function = [](const Dual& t) { return t.value < 0.5 ? Dual(2.0) : 0.25 * t; }, .from = 0.0, .to = 1.0};
  CHECK(test::contains(curve_findings(p), "none of the breakpoints"));
  p.breakpoints = {0.5};
  CHECK(curve_findings(p) == "");
  const TimeCurve curve(p);
  CHECK(curve.knots() == std::vector<double>{0.0, 0.5, 1.0});
  CHECK(curve.at(0.499999)[0] == 2.0);
  CHECK(curve.at(0.5)[0] == 0.125);
  CHECK(curve.at(0.5)[1] == Approx(0.25));
}

TEST_CASE("A formula over time: each side of a kink at a breakpoint or an end has its own slope") {
  const auto kinked = [](Dual (*f)(const Dual&), double at, double to) {
    TimeCurve::Params p{.function = f, .from = 0.0, .to = to};
    if (at < to) p.breakpoints = {at};
    CHECK(curve_findings(p) == "");
    return TimeCurve(p);
  };
  const TimeCurve v = kinked([](const Dual& t) { return abs(t - 1.0); }, 1.0, 2.0);
  CHECK(v.knots() == std::vector<double>{0.0, 1.0, 2.0});
  CHECK(v.at(0.75)[1] == Approx(-1.0));
  CHECK(v.at(1.0)[0] == 0.0);
  CHECK(v.at(1.0)[1] == Approx(1.0));
  const TimeCurve rising = kinked([](const Dual& t) { return t < 0.5 ? Dual(0.5) : t; }, 0.5, 2.0);
  CHECK(rising.at(0.25)[0] == 0.5);
  CHECK(rising.at(1.25)[0] == Approx(1.25));
  CHECK(kinked([](const Dual& t) { return abs(sin(kPi * t)); }, 1.0, 1.0).at(0.25)[0] ==
        Approx(std::sqrt(0.5)).epsilon(1e-10));
  // What is refused is not called negative as well.
  const std::string found =
      curve_findings({.function = [](const Dual& t) { return abs(t - 0.3); }, .from = 0.0, .to = 2.0});
  CHECK(test::contains(found, "none of the breakpoints"));
  CHECK_FALSE(test::contains(found, "must be >= 0"));
}

TEST_CASE("A formula over time that is not finite somewhere is refused") {
  TimeCurve::Params p{.function = [](const Dual& t) { return 1.0 / t; }, .from = 0.0, .to = 1.0};
  CHECK(test::contains(curve_findings(p), "not finite"));
  p.function = [](const Dual& t) { return Dual(t.value < 0.5 ? std::nan("") : 1.0); };
  CHECK(test::contains(curve_findings(p), "not finite"));
}

TEST_CASE("A formula over time: bad input is named") {
  TimeCurve::Params p = closing();
  p.to = 0.0;
  CHECK(test::contains(curve_findings(p), "must be behind from"));
  p = closing();
  p.accuracy = 1.0;
  CHECK(test::contains(curve_findings(p), "accuracy"));
  p = closing();
  p.breakpoints = {0.9, 0.5};
  CHECK(test::contains(curve_findings(p), "breakpoints"));
  p = closing();
  p.function = {};
  CHECK(test::contains(curve_findings(p), "exactly one of function and formula"));
  CHECK(test::contains(
      curve_findings({.function = [](const Dual& t) { return 0.1 - t; }, .from = 0.0, .to = 1.0}),
      "must be >= 0"));
  CHECK(test::contains(test::findings(Clutch({.torque = 1.0,
                                              .engagement = TimeTable({0.0}, {1.0}),
                                              .engagement_formula = TimeCurve(closing())})),
                       "together with engagement"));
}
