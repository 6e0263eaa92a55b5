// PeriodicCurve, CurveFamily and the cam torque that follows a spline.
#include <drev/core/units.hpp>
#include <drev/elements/cam_torque.hpp>
#include <drev/elements/periodic_curve.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

namespace {

PeriodicTable sampled(int points, double jitter = 0.0) {
  std::vector<double> angle, value;
  for (int i = 0; i < points; ++i) {
    angle.push_back(kTwoPi * i / points + jitter * std::sin(7.0 * i));
    value.push_back(std::cos(angle.back()) + 0.3 * std::sin(2.0 * angle.back()));
  }
  return PeriodicTable(angle, value);
}

double worst(const PeriodicCurve& curve) {
  double error = 0.0;
  for (int i = 0; i < 997; ++i) {
    const double a = kTwoPi * (2.0 * i / 997 - 1.0);
    error = std::max(error, std::abs(curve.at(a).value - std::cos(a) - 0.3 * std::sin(2.0 * a)));
  }
  return error;
}

}  // namespace

TEST_CASE("A cubic spline meets its points, is smooth across the period and of fourth order") {
  for (const double jitter : {0.0, 0.05}) {
    const PeriodicTable points = sampled(24, jitter);
    const PeriodicCurve curve(points, Interpolation::cubic);
    for (std::size_t i = 0; i < points.arguments().size(); ++i) {
      const double a = points.arguments()[i], step = 1e-7;
      CHECK(curve.at(a).value == Approx(points.values()[i]).margin(1e-14));
      CHECK(curve.at(a + kTwoPi).value == Approx(points.values()[i]).margin(1e-13));
      CHECK(curve.at(a - step).slope == Approx(curve.at(a + step).slope).margin(1e-6));
      // Curvature from both sides.
      const double before = (curve.at(a).slope - curve.at(a - 1e-4).slope) / 1e-4;
      const double behind = (curve.at(a + 1e-4).slope - curve.at(a).slope) / 1e-4;
      CHECK(before == Approx(behind).margin(2e-3));
    }
  }
  // 5/384 h^4 max|f''''| <= 5/384 h^4 (1 + 16 * 0.3)
  for (const int points : {24, 48}) {
    const double h = kTwoPi / points;
    CHECK(worst(PeriodicCurve(sampled(points), Interpolation::cubic)) < 5.0 / 384.0 * std::pow(h, 4) * 5.8);
  }
  CHECK(worst(PeriodicCurve(sampled(24), Interpolation::cubic)) >
        12.0 * worst(PeriodicCurve(sampled(48), Interpolation::cubic)));
  const PeriodicCurve curve(sampled(17, 0.05), Interpolation::cubic);
  CHECK(curve.mean() ==
        Approx(test::integral([&](double a) { return curve.at(a).value; }, 0.0, kTwoPi, 200000) / kTwoPi)
            .margin(1e-10));
}

TEST_CASE("Curves over a parameter: linear between, constant beyond") {
  const PeriodicTable low({0.0, 1.0}, {1.0, 3.0}, 2.0), high({0.0, 1.0}, {2.0, 8.0}, 2.0);
  const CurveFamily family(
      {PeriodicCurve(low, Interpolation::linear), PeriodicCurve(high, Interpolation::linear)}, {10.0, 20.0});
  const CurveFamily::Point p = family.at(0.5, 15.0);  // 2 and 5, slopes 2 and 6
  CHECK(p.value == Approx(3.5));
  CHECK(p.slope == Approx(4.0));
  CHECK(p.parameter_slope == Approx(0.3));
  CHECK(family.at(0.5, 5.0).value == Approx(2.0));
  CHECK(family.at(0.5, 25.0).value == Approx(5.0));
  CHECK(family.at(0.5, 25.0).parameter_slope == 0.0);
}

TEST_CASE("A cam torque by a spline: scaled, with its tangent, refused with two points") {
  const CamTorque cam({.angle_table = sampled(24), .interpolation = Interpolation::cubic, .scale = -3.0});
  CHECK(check_element(cam, 1).ok());
  CHECK(!cam.table());
  CHECK(cam.evaluate({.nominal_angle = 0.3}).torque ==
        Approx(-3.0 * (std::cos(0.3) + 0.3 * std::sin(0.6))).epsilon(1e-4));
  const CamTorque linear({.angle_table = sampled(24), .scale = 2.0});
  CHECK(check_element(linear, 1).ok());
  CHECK(linear.table()->values[0] == Approx(2.0));
  const CamTorque two(
      {.angle_table = PeriodicTable({0.0, 1.0}, {0.0, 1.0}), .interpolation = Interpolation::cubic});
  CHECK(test::contains(test::findings(two), "a cubic spline needs at least 3"));
}
