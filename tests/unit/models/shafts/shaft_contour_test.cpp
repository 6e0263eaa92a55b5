#include <drev/core/error.hpp>
#include <drev/core/verify.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/shafts/contour_shaft.hpp>
#include <drev/models/shafts/shaft_contour.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/catch.hpp"

namespace {

using namespace drev;
constexpr double kG = 8e10, kRho = 7850.0;
double polar_moment(double d) { return std::numbers::pi / 32.0 * std::pow(d, 4); }

ShaftContour plain_shaft(std::vector<ShaftStation> stations) {
  return {.shear_modulus = kG, .density = kRho, .stations = std::move(stations)};
}

PeriodicTable lift_of(double height) {
  std::vector<double> angles, lifts;
  for (int i = 0; i < 180; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 180;
    const double f = angle > std::numbers::pi ? angle - 2.0 * std::numbers::pi : angle;
    const double c = std::abs(f) < std::numbers::pi / 3.0 ? std::cos(1.5 * f) : 0.0;
    angles.push_back(angle);
    lifts.push_back(height * c * c);
  }
  return {angles, lifts};
}

std::vector<std::string> refused(const ShaftContour& contour) {
  std::vector<Finding> findings;
  ParameterCheck check("shaft", findings);
  contour.check(check);
  std::vector<std::string> parameters;
  for (const Finding& f : findings) parameters.push_back(f.parameter);
  return parameters;
}

TEST_CASE("A stepped contour: flexibility, inertia, stress factor, and what the naive sum is off by",
          "[shafts]") {
  const ShaftSections s =
      shaft_sections(plain_shaft({{.length = 0.2, .outer_diameter = 0.1, .fillet_end = 0.01},
                                  {.name = "flange", .length = 0.3, .outer_diameter = 0.15}}));
  const double small = polar_moment(0.1), large = polar_moment(0.15);
  CHECK(s.naive_flexibility == Approx(0.2 / small + 0.3 / large).epsilon(1e-12));
  // dL/d of D/d 1.5, r/d 0.1 is 0.05300, by independent finite elements.
  CHECK(s.flexibility.value == Approx(0.2053 / small + 0.3 / large).epsilon(1e-4));
  CHECK(s.naive_excess() == Approx(0.0053 / (0.2 + 0.3 * small / large)).epsilon(2e-3));
  CHECK(s.stiffness() == Approx(kG / s.flexibility.value));
  CHECK(s.sections[0].stress_factor.value == Approx(1.3799).epsilon(0.005));
  CHECK(s.sections[0].stress_place == "fillet");
  CHECK(s.sections[1].name == "flange");
  // The fillet is a ring of (1 - pi/4) r^2 at about the surface: 0.2 % of the small shaft's inertia.
  const double bare = kRho * (0.2 * small + 0.3 * large);
  CHECK(s.inertia() > bare);
  CHECK(s.inertia() == Approx(bare + kRho * 2.0 * std::numbers::pi * (1.0 - std::numbers::pi / 4.0) * 1e-4 *
                                         std::pow(0.0522, 3))
                           .epsilon(2e-4));
  double sum = 0.0;
  for (const double f : s.segment_flexibility) sum += f;
  CHECK(sum == Approx(s.flexibility.value).epsilon(1e-10));
}

TEST_CASE("A taper, a groove, a keyway and a sharp shoulder of a contour", "[shafts]") {
  const ShaftSections s = shaft_sections(
      plain_shaft({{.length = 0.2, .outer_diameter = 0.1, .end_diameter = 0.15},
                   {.length = 0.3, .outer_diameter = 0.15, .groove = ShaftGroove{0.15, 0.015, 0.015}},
                   {.length = 0.2, .outer_diameter = 0.15, .keyway = ShaftKeyway{0.042, 0.015, 0.003}},
                   {.length = 0.2, .outer_diameter = 0.12}}));
  CHECK(s.sections[0].inertia ==
        Approx(kRho * std::numbers::pi / 160.0 * 0.2 * (std::pow(0.15, 5) - std::pow(0.1, 5)) / 0.05)
            .epsilon(1e-9));
  CHECK(s.sections[1].stress_place == "groove");
  CHECK(s.sections[1].stress_factor.value == Approx(1.4352).epsilon(0.005));
  CHECK(s.sections[1].diameter == Approx(0.12));
  CHECK(s.sections[2].stress_place == "keyway");
  CHECK(s.sections[2].stress_factor.value == Approx(2.135).epsilon(0.005));
  CHECK(s.sections[2].torsion_constant == Approx(0.900148 * polar_moment(0.15)).epsilon(1e-4));
  CHECK(s.sections[3].stress_place == "sharp shoulder");
  CHECK(std::isinf(s.sections[3].stress_factor.value));
}

TEST_CASE("A contour that is drawn from its other end has the same segments", "[shafts]") {
  ShaftContour drawn = plain_shaft({{.length = 0.2, .outer_diameter = 0.1, .fillet_end = 0.01},
                                    {.length = 0.1, .outer_diameter = 0.4},
                                    {.length = 0.05, .outer_diameter = 0.1, .fillet_start = 0.01}});
  for (const double up_to : {kNotGiven, 5000.0}) {
    drawn.up_to_frequency = up_to;
    ShaftContour mirrored = drawn;
    std::reverse(mirrored.stations.begin(), mirrored.stations.end());
    for (ShaftStation& s : mirrored.stations) std::swap(s.fillet_start, s.fillet_end);
    const ShaftSections a = shaft_sections(drawn), b = shaft_sections(mirrored);
    const std::size_t n = a.segment_flexibility.size();
    REQUIRE(b.segment_flexibility.size() == n);
    for (std::size_t k = 0; k < n; ++k) {
      INFO("segment " << k + 1 << " of " << n);
      CHECK(a.segment_flexibility[k] == Approx(b.segment_flexibility[n - 1 - k]).epsilon(1e-3));
    }
    // Between two planes no section is stiffer than one that turns as a whole.
    CHECK(a.sections[1].flexibility > a.sections[1].naive_flexibility);
  }
}

TEST_CASE("Stress has no limit where a taper turns outwards", "[shafts]") {
  const auto places = [](std::vector<ShaftStation> stations) {
    std::vector<std::string> found;
    for (const ShaftSection& s : shaft_sections(plain_shaft(std::move(stations))).sections) {
      CHECK(std::isinf(s.stress_factor.value) == s.stress_place.starts_with("sharp"));
      found.push_back(s.stress_place);
    }
    return found;
  };
  using Places = std::vector<std::string>;
  CHECK(places({{.length = 0.2, .outer_diameter = 0.15, .end_diameter = 0.1},
                {.length = 0.1, .outer_diameter = 0.1},
                {.length = 0.1, .outer_diameter = 0.12}}) ==
        Places{"sharp corner", "sharp shoulder", "surface"});
  // Held ends turn as a whole, as a thicker part would; a corner that turns inwards is relieved.
  CHECK(places({{.length = 0.1, .outer_diameter = 0.1, .end_diameter = 0.2}}) == Places{"sharp corner"});
  CHECK(places({{.length = 0.1, .outer_diameter = 0.2},
                {.length = 0.1, .outer_diameter = 0.2, .end_diameter = 0.1992}}) ==
        Places{"surface", "surface"});
  // A groove beside it does not hide a shoulder.
  CHECK(places({{.length = 0.3, .outer_diameter = 0.1, .groove = ShaftGroove{0.1, 0.01, 0.01}},
                {.length = 0.1, .outer_diameter = 0.12}}) == Places{"sharp shoulder", "surface"});
}

TEST_CASE("Cams and hubs lie between bounds, and cams far from their own section's stiffness", "[shafts]") {
  const ShaftStation journal{
      .length = 0.06, .outer_diameter = 0.05, .fillet_start = 0.002, .fillet_end = 0.002};
  const ShaftStation cam{.length = 0.03, .outer_diameter = 0.08, .cam = ShaftCam{lift_of(0.02)}};
  ShaftStation first = journal, last = journal;
  first.fillet_start = last.fillet_end = 0.0;
  const ShaftContour contour = plain_shaft({first, cam, last});
  const ShaftSections s = shaft_sections(contour);
  const ShaftBounds bounds = shaft_bounds(contour);
  CHECK(bounds.softest < s.stiffness());
  CHECK(s.stiffness() < bounds.stiffest);
  CHECK(bounds.stiffest / bounds.softest < 1.05);
  CHECK(s.sections[1].torsion_constant == Approx(2.140707 * std::pow(0.04, 4)).epsilon(1e-4));
  CHECK(s.sections[1].inertia == Approx(kRho * 0.03 * 2.479680 * std::pow(0.04, 4)).epsilon(1e-4));
  // 3/8 of d wide: the whole has the collar's flexibility, far more than the naive sum says.
  CHECK(s.naive_excess() > 0.05);
  const ShaftContour fitted = plain_shaft({{.length = 0.1, .outer_diameter = 0.05},
                                           {.length = 0.05, .outer_diameter = 0.05, .hub_diameter = 0.09},
                                           {.length = 0.1, .outer_diameter = 0.05}});
  const ShaftBounds hub = shaft_bounds(fitted);
  CHECK(hub.softest == Approx(kG * polar_moment(0.05) / 0.25).epsilon(1e-6));
  CHECK(hub.stiffest == Approx(shaft_sections(fitted).stiffness()).epsilon(1e-6));
  CHECK(hub.stiffest > 1.05 * hub.softest);
}

TEST_CASE("A uniform contour is a distributed shaft, with the segments that the accuracy asks for",
          "[shafts]") {
  ShaftContour contour = plain_shaft({{.length = 1.0, .outer_diameter = 0.1, .inner_diameter = 0.04}});
  contour.up_to_frequency = 3000.0;
  contour.frequency_accuracy = 1e-3;
  const ContourShaft element(contour);
  CHECK(check_element(element, 2).ok());
  const int segments = segments_for(1.0, std::sqrt(kG / kRho), 1e-3, 3000.0, SegmentMass::averaged, 1.0);
  CHECK(element.part_count() == segments);
  const auto modes = [](const auto& add) {
    Model m("shaft");
    m.add_node("a");
    m.add_node("b");
    add(m);
    return solve_modes(m.build(), {.count = 2}).frequency_Hz;
  };
  const auto by_contour = modes([&](Model& m) { m.add<ContourShaft>("shaft", {"a", "b"}, contour); });
  const auto uniform = modes([&](Model& m) {
    m.add<DistributedShaft>("shaft", {"a", "b"},
                            {.shear_modulus = kG,
                             .density = kRho,
                             .outer_diameter = 0.1,
                             .inner_diameter = 0.04,
                             .length = 1.0,
                             .segments = segments,
                             .mass = SegmentMass::averaged});
  });
  CHECK(by_contour[0] == Approx(uniform[0]).epsilon(1e-6));
  CHECK(by_contour[1] == Approx(uniform[1]).epsilon(1e-6));
  CHECK(by_contour[0] == Approx(0.5 * std::sqrt(kG / kRho)).epsilon(1e-3));
}

TEST_CASE("Contours that cannot be are refused with every dimension at once", "[shafts]") {
  ShaftContour bad =
      plain_shaft({{.length = -1.0, .outer_diameter = 0.1},
                   {.length = 0.1, .outer_diameter = 0.1, .hub_diameter = 0.05},
                   {.length = 0.1, .outer_diameter = 0.1, .end_diameter = 0.12, .fillet_end = 0.01}});
  bad.density = 0.0;
  CHECK(refused(bad) == std::vector<std::string>{"density", "stations[1].length", "stations[2].hub_diameter",
                                                 "stations[3].fillet_start"});
  CHECK(refused(plain_shaft({})) == std::vector<std::string>{"stations"});
  CHECK(refused(plain_shaft({{.length = 0.1, .outer_diameter = 0.1, .inner_diameter = 0.1},
                             {.length = 0.1, .outer_diameter = 6.0}})) ==
        std::vector<std::string>{"stations[1].inner_diameter", "stations"});
  CHECK(refused(plain_shaft({{.length = 0.1, .outer_diameter = 0.1, .fillet_start = 0.01, .fillet_end = 0.01},
                             {.length = 0.1, .outer_diameter = 0.05}})) ==
        std::vector<std::string>{"stations[1].fillet_start", "stations[1].fillet_end"});
  CHECK(refused(plain_shaft({{.length = 0.005, .outer_diameter = 0.1, .fillet_end = 0.01},
                             {.length = 0.1, .outer_diameter = 0.2}})) ==
        std::vector<std::string>{"stations[1].length"});
  CHECK(refused(
            plain_shaft({{.length = 0.1, .outer_diameter = 0.1, .keyway = ShaftKeyway{0.09, 0.06, 0.0}}})) ==
        std::vector<std::string>{"stations[1].keyway.corner_radius", "stations[1].keyway.width",
                                 "stations[1].keyway.depth"});
  CHECK(refused(plain_shaft(
            {{.length = 0.1, .outer_diameter = 0.1, .groove = ShaftGroove{0.001, 0.06, 0.01}}})) ==
        std::vector<std::string>{"stations[1].groove.depth", "stations[1].groove.position"});
  CHECK_THROWS_AS(shaft_sections(plain_shaft({})), ModelError);
}

}  // namespace
