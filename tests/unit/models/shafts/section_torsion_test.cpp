#include "models/shafts/section_torsion.hpp"

#include <drev/core/error.hpp>

#include <cmath>
#include <numbers>

#include "tests/catch.hpp"

namespace {

using namespace drev;
constexpr double kPi_ = std::numbers::pi;

/// Expected J and peak stress, relative limits of both. The closed forms stand in S. Timoshenko, J. N. Goodier, Theory
/// of Elasticity, 3rd ed. 1970, sections 107 to 114; the others are by independent finite elements (triangles of second
/// order, to about 1e-6 in J and 3e-4 in stress).
void check_section(const SectionOutline& outline, double constant, double peak, double of_constant,
                   double of_peak) {
  const SectionTorsion found = solve_section(outline);
  INFO(outline.name << ": J " << found.constant.value << " +- " << found.constant.error << ", peak "
                    << found.peak_stress.value << " +- " << found.peak_stress.error);
  CHECK(std::abs(found.constant.value / constant - 1.0) < of_constant);
  CHECK(std::abs(found.peak_stress.value / peak - 1.0) < of_peak);
  // The error that is stated holds, beside the digits of the reference.
  CHECK(std::abs(found.constant.value - constant) < found.constant.error + 7e-7 * constant);
  CHECK(found.constant.error < 1e-4 * constant);
}

PeriodicCurve cosine_lift(double height) {
  std::vector<double> angles, lifts;
  for (int i = 0; i < 720; ++i) {
    const double angle = 2.0 * kPi_ * i / 720, f = angle > kPi_ ? angle - 2.0 * kPi_ : angle;
    const double c = std::abs(f) < kPi_ / 3.0 ? std::cos(1.5 * f) : 0.0;
    angles.push_back(angle);
    lifts.push_back(height * c * c);
  }
  return {PeriodicTable(angles, lifts), Interpolation::cubic};
}

TEST_CASE("Torsion of sections with closed forms: ellipse, square, rectangle, triangle, ring, groove",
          "[shafts]") {
  check_section(ellipse_outline(2.0, 1.0), kPi_ * 8.0 / 5.0, 1.6, 1e-8, 1e-4);
  check_section(rectangle_outline(1.0, 1.0), 0.1405770, 0.675314, 1e-6, 1e-4);
  check_section(rectangle_outline(2.0, 1.0), 0.4573634, 0.930060, 2e-6, 1e-4);
  const double low = std::sqrt(3.0) / 6.0;
  check_section(polygon_outline({{-0.5, -low}, {0.5, -low}, {0.0, 2.0 * low}}), std::sqrt(3.0) / 80.0,
                std::sqrt(3.0) / 4.0, 1e-6, 1e-4);
  check_section(ring_outline(1.0, 0.5, 0.0), kPi_ / 2.0 * 15.0 / 16.0, 1.0, 1e-8, 1e-5);
  check_section(grooved_outline(1.0, 0.1), 1.541969, 1.9, 1e-6, 1e-3);
  check_section(grooved_outline(1.0, 0.2), 1.465231, 1.8, 1e-6, 1e-3);
  check_section(grooved_outline(1.0, 0.3), 1.353853, 1.7, 1e-6, 1e-3);
  check_section(grooved_outline(1.0, 0.5), 1.071732, 1.5, 1e-6, 1e-3);
}

TEST_CASE("Torsion of sections against independent finite elements: keyways, cams, eccentric bore",
          "[shafts]") {
  const double round = kPi_ / 32.0, half = 0.5;  // J of the round shaft of diameter 1, its stress on G theta'
  struct Keyway {
    double width, depth, corner, constant, factor;
  };
  for (const Keyway& k :
       {Keyway{0.28, 0.1, 0.006, 0.898698, 2.932}, Keyway{0.28, 0.1, 0.02, 0.900148, 2.135},
        Keyway{0.25, 0.125, 0.00521, 0.868855, 3.578}, Keyway{0.25, 0.125, 0.02083, 0.870949, 2.410}})
    check_section(keyway_outline(1.0, k.width, k.depth, k.corner), k.constant * round,
                  k.factor * k.constant * half, 1e-5, 1e-2);
  check_section(ring_outline(1.0, 0.5, 0.25), 1.3347889, 1.33244, 1e-6, 2e-3);
  check_section(cam_outline(1.0, cosine_lift(0.5)), 2.140707, 1.45042, 1e-6, 2e-3);
  check_section(cam_outline(1.0, cosine_lift(0.8)), 2.562079, 1.6944, 1e-6, 2e-3);
  const SectionTorsion cam = solve_section(cam_outline(1.0, cosine_lift(0.5)));
  CHECK(cam.area == Approx(kPi_ * (1.0 + 1.0 / 6.0 + 1.0 / 32.0)).epsilon(1e-6));
  CHECK(cam.polar == Approx(2.479680).epsilon(1e-6));
  CHECK(std::hypot(cam.centroid[0], cam.centroid[1]) == Approx(0.186390).epsilon(1e-5));
  CHECK(cam.modulus() == Approx(1.47592).epsilon(2e-3));
  CHECK(std::hypot(cam.peak_at[0], cam.peak_at[1]) == Approx(std::hypot(0.589, 0.821)).epsilon(0.01));
  const SectionTorsion high = solve_section(cam_outline(1.0, cosine_lift(0.8)));
  CHECK(high.area == Approx(4.230678).epsilon(1e-6));
  CHECK(high.polar == Approx(3.556281).epsilon(1e-6));
  CHECK(std::hypot(high.centroid[0], high.centroid[1]) == Approx(0.32351).epsilon(2e-5));
  CHECK(std::hypot(high.peak_at[0], high.peak_at[1]) == Approx(std::hypot(0.576, 0.832)).epsilon(0.01));
}

TEST_CASE("A spline is stiffer than its minor circle and softer than its major one, with a peak in the round",
          "[shafts]") {
  const SectionTorsion found = solve_section(spline_outline(8, 0.032, 0.036, 0.006, 0.5e-3));
  const double minor = kPi_ / 32.0 * std::pow(0.032, 4), major = kPi_ / 32.0 * std::pow(0.036, 4);
  CHECK(found.constant.value > minor);
  CHECK(found.constant.value < major);
  CHECK(found.constant.value < found.polar);  // for every section but round ones (St. Venant)
  CHECK(found.peak_stress.value > 0.016);
  const double at = std::hypot(found.peak_at[0], found.peak_at[1]);
  CHECK(at > 0.016);
  CHECK(at < 0.0165);
  CHECK(solve_section(rectangle_outline(1e-3, 1e-3)).constant.value == Approx(0.1405770e-12).epsilon(1e-6));
}

TEST_CASE("Outlines that cannot be are refused with every dimension", "[shafts]") {
  const auto count = [](const auto& make) {
    try {
      make();
    } catch (const ModelError& error) {
      return error.findings().size();
    }
    return std::size_t{0};
  };
  CHECK(count([] { keyway_outline(0.1, 0.09, 0.06, 0.0); }) == 3);
  CHECK(count([] { keyway_outline(0.1, 0.028, 0.01, 0.02); }) == 2);
  CHECK(count([] { spline_outline(3, 0.03, 0.02, -1.0, 0.0); }) == 4);
  CHECK(count([] { spline_outline(40, 0.032, 0.036, 0.006, 0.5e-3); }) == 1);
  CHECK(count([] { ellipse_outline(-1.0, 0.0); }) == 2);
  CHECK(count([] { polygon_outline({{0.0, 0.0}, {1.0, 0.0}}); }) > 0);
  CHECK(count([] { ring_outline(1.0, 0.6, 0.5); }) == 1);
  CHECK(count([] { grooved_outline(1.0, 0.9); }) == 1);
  CHECK(count([] { cam_outline(1.0, cosine_lift(4.0)); }) == 1);
  CHECK(count([] { cam_outline(1.0, cosine_lift(0.5), 1.0); }) == 1);
  CHECK(count([] { solve_section(ellipse_outline(2.0, 1.0), 1.0); }) == 1);
}

}  // namespace
