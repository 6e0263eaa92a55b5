// Geometry of gear pairs against figures computed independently to the digits that stand here (ISO 21771; contact ratios
// of the pairs 62/62 and 20/20 also by ROSS), and what cannot be is refused by its name.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/models/gears/gear_geometry.hpp>

#include <cmath>

#include "tests/unit/models/gears/gear_pairs.hpp"

using namespace drev;

namespace {

bool names(const std::string& message, const std::vector<const char*>& parts) {
  INFO(message);
  bool all = true;
  for (const char* part : parts) {
    INFO(part);
    const bool found = message.find(part) != std::string::npos;
    CHECK(found);
    all = all && found;
  }
  return all;
}

struct Row {
  const char* name;
  GearGeometry pair;
  double a, angle, pitch, ratio, start, end;  // mm, degrees
  double digits_ratio;
};

}  // namespace

TEST_CASE("Gear pairs have the dimensions of their drawings", "[gears]") {
  const std::vector<Row> rows{
      {"T1, tips cut", gear_pairs::t1(), 497.007097, 16.162324, 23.617051, 1.721726, 42.6835, 83.3456, 5e-7},
      {"T1n", gear_pairs::t1n(), 508.0, 20.0, 23.617051, 1.792792, 59.4200, 101.7605, 5e-7},
      {"T2", gear_pairs::t2(), 417.003544, 19.427212, 26.569183, 1.770465, 25.9997, 73.0395, 5e-7},
      {"T2 at 417", gear_pairs::t2(0.417), 417.0, 19.425831, 26.569183, 1.770866, 25.9890, 73.0395, 5e-7},
      {"R62", gear_pairs::r62(), 124.0, 20.0, 5.904263, 1.789779867, 15.92158, 26.48891, 5e-10},
      {"S", gear_pairs::s(), 120.0, 20.0, 11.808526, 1.543485270, 8.29096, 26.51725, 5e-10},
      {"20/20", gear_pairs::pair(10, 20, 20, 0, 0), 200.0, 20.0, 29.521314, 1.556838303, NAN, NAN, 5e-10},
      {"20/40", gear_pairs::pair(4, 20, 40, 0.5, 0.3), 122.947464, 23.484914, 11.808526, 1.491960755, NAN,
       NAN, 5e-10}};
  for (const Row& row : rows) {
    INFO(row.name);
    const GearPair pair(row.pair);
    CHECK(std::abs(pair.centre_distance() * 1e3 - row.a) < 5e-7);
    CHECK(std::abs(pair.operating_angle() * 180.0 / kPi - row.angle) < 5e-7);
    CHECK(std::abs(pair.base_pitch() * 1e3 - row.pitch) < 5e-7);
    CHECK(std::abs(pair.contact_ratio() - row.ratio) < row.digits_ratio);
    if (!std::isnan(row.start)) {
      CHECK(std::abs(pair.start_of_contact() * 1e3 - row.start) < 6e-5);
      CHECK(std::abs(pair.end_of_contact() * 1e3 - row.end) < 6e-5);
    }
  }
}

TEST_CASE("Relations of a gear pair hold to rounding", "[gears]") {
  GearGeometry p = gear_pairs::pair(3, 23, 57, 0.21, -0.13);
  p.helix_angle = 0.3;
  const GearPair pair(p);
  const double an = p.pressure_angle, mt = 0.003 / std::cos(0.3),
               at = std::atan(std::tan(an) / std::cos(0.3));
  const double aw = pair.operating_angle();
  CHECK(std::abs(std::tan(aw) - aw - (std::tan(at) - at + 2.0 * std::tan(an) * 0.08 / 80.0)) < 1e-15);
  CHECK(std::abs(pair.centre_distance() * 2.0 * std::cos(aw) / (80.0 * mt * std::cos(at)) - 1.0) < 1e-14);
  CHECK(std::abs(pair.normal_backlash()) < 1e-15);
  CHECK(std::abs(pair.tangent_length() / (pair.centre_distance() * std::sin(aw)) - 1.0) < 1e-13);
  // The shift that a centre distance leaves to gear 2 is the one that gives it.
  GearGeometry from = p;
  from.centre_distance = pair.centre_distance();
  from.gear_2.profile_shift = kNotGiven;
  CHECK(std::abs(GearPair(from).gear(1).profile_shift + 0.13) < 1e-12);
  // Opened by d the pair has the play 2 d tan(alpha_w) to first order.
  from.gear_2.profile_shift = -0.13;
  from.centre_distance += 1e-6;
  CHECK(std::abs(GearPair(from).circumferential_backlash() / (2e-6 * std::tan(aw)) - 1.0) < 1e-3);
}

TEST_CASE("Play at the centre distances of the source's drawings", "[gears]") {
  CHECK(std::abs(
            GearPair(gear_pairs::pair(8, 59, 68, -0.626, -0.626, -0.27, 0.497)).circumferential_backlash() *
                1e3 +
            0.0041) < 5e-5);
  CHECK(std::abs(GearPair(gear_pairs::t2(0.417)).circumferential_backlash() * 1e3 + 0.0025) < 5e-5);
}

TEST_CASE("Flank, fillet and root of a tooth meet with one tangent", "[gears]") {
  for (const GearGeometry& p : {gear_pairs::t1(), gear_pairs::t2(), gear_pairs::s(), gear_pairs::helical()}) {
    const GearPair pair(p);
    for (int i = 0; i < 2; ++i) {
      const ToothContour& c = pair.contour(i);
      const auto end = c.flank(c.form_length()), start = c.fillet(p.pressure_angle);
      CHECK(std::abs(end.radius - start.radius) < 1e-12);
      CHECK(std::abs(end.angle - start.angle) < 1e-12);
      CHECK(std::abs(c.fillet(ToothContour::kQuarterTurn).radius - c.root_radius()) < 1e-12);
      const auto flank = c.flank(c.form_length() + 1e-7), fillet = c.fillet(p.pressure_angle + 1e-5);
      const double along =
          (flank.x() - end.x()) * (start.y() - fillet.y()) - (flank.y() - end.y()) * (start.x() - fillet.x());
      CHECK(std::abs(along) < 1e-4 * std::hypot(flank.x() - end.x(), flank.y() - end.y()) *
                                  std::hypot(start.x() - fillet.x(), start.y() - fillet.y()));
    }
  }
}

TEST_CASE("Form limits and polar moments of gears", "[gears]") {
  const GearPair t1(gear_pairs::t1());
  CHECK(std::abs(t1.contour(0).form_length() * 1e3 - 42.685) < 5e-4);
  CHECK(std::abs((t1.tangent_length() - t1.contour(1).form_length()) * 1e3 - 83.349) < 5e-4);
  // Full tips for the moments: solid outlines with teeth and fillets, mm^4.
  const auto moment = [](double m, int z, double x, double k) {
    return ToothContour({.module = m * 1e-3,
                         .pressure_angle = 20.0 * kPi / 180.0,
                         .helix_angle = 0.0,
                         .teeth = z,
                         .profile_shift = x,
                         .tip_radius = 0.5e-3 * m * (z + 2.0 * x + 2.0 + 2.0 * k)})
               .polar_moment() *
           1e12;
  };
  CHECK(std::abs(moment(9, 59, -0.082, 0) / 7.682437e9 - 1.0) < 2e-7);
  CHECK(std::abs(moment(9, 34, -0.082, 0) / 8.40066e8 - 1.0) < 1e-6);
  CHECK(std::abs(moment(8, 59, -0.626, 0) / 4.434051e9 - 1.0) < 2e-7);
  CHECK(std::abs(moment(8, 68, -0.626, 0) / 7.924360e9 - 1.0) < 2e-7);
  CHECK(std::abs(moment(2, 62, 0, 0) / 2.310710e7 - 1.0) < 3e-7);
  // The camshaft's gear, solid, 130 mm wide.
  GearGeometry solid = gear_pairs::t2();
  solid.gear_2.bore_diameter = 0.0;
  CHECK(std::abs(GearPair(solid).inertia(1) - 7.84) < 0.005);
}

TEST_CASE("Web, rim, hub and bore of a gear's inertia", "[gears]") {
  GearGeometry p = gear_pairs::t2();
  p.gear_2.bore_diameter = 0.1;
  p.gear_2.rim_inner_diameter = 0.4;
  p.gear_2.hub_diameter = 0.2;
  p.gear_2.web_thickness = 0.02;
  const auto disc = [](double d) { return kPi / 32.0 * std::pow(d, 4); };
  const double solid = GearPair(p).contour(1).polar_moment();
  const double expected =
      7850.0 * (0.13 * (solid - disc(0.4) + disc(0.2) - disc(0.1)) + 0.02 * (disc(0.4) - disc(0.2)));
  CHECK(std::abs(GearPair(p).inertia(1) / expected - 1.0) < 1e-13);
}

TEST_CASE("An internal pair follows from the same formulas", "[gears]") {
  GearGeometry p = gear_pairs::pair(2, 24, 72, 0, 0);
  p.internal = true;
  p.gear_2.bore_diameter = kNotGiven;
  p.gear_2.tip_alteration = -0.2;  // clear of the fillet of gear 1
  const GearPair pair(p);
  CHECK(std::abs(pair.centre_distance() - 0.048) < 1e-15);
  CHECK(std::abs(pair.gear(1).tip_diameter - 0.002 * (72 - 1.6)) < 1e-15);
  // eps = (sqrt(ra1^2 - rb1^2) - sqrt(ra2^2 - rb2^2) + a sin(alpha_w))/p_b, ISO 21771 equation for z_2 < 0.
  const double c = std::cos(20.0 * kPi / 180.0), rb1 = 24 * c, rb2 = 72 * c, ra1 = 26, ra2 = 70.4;
  const double path =
      std::sqrt(ra1 * ra1 - rb1 * rb1) - std::sqrt(ra2 * ra2 - rb2 * rb2) + 48 * std::sin(20.0 * kPi / 180.0);
  CHECK(std::abs(pair.contact_ratio() - path / (2 * kPi * c)) < 1e-12);
  CHECK(std::abs(pair.normal_backlash()) < 1e-15);
}

TEST_CASE("Drawings that cannot be are refused by their dimension", "[gears]") {
  const auto refusal = [](const GearGeometry& p) {
    try {
      GearPair pair(p);
    } catch (const ModelError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  // The source's mesh 1 with full tips: contact ratio 2.21 by formula, 1.72 on the flanks.
  CHECK(names(refusal(gear_pairs::pair(8, 59, 68, -0.626, -0.626)),
              {"gear_1.tip_diameter", "fillet of the other gear", "by formula 2.2096", "flanks allow 1.72"}));
  CHECK(names(refusal(gear_pairs::pair(5, 12, 40, 0, 0)), {"undercut"}));
  CHECK(names(refusal(gear_pairs::pair(5, 12, 40, 1.2, 0)), {"pointed"}));
  CHECK(names(refusal(gear_pairs::t2(0.39)), {"centre_distance", "base radii"}));
  CHECK(names(refusal(gear_pairs::t2(0.4165)), {"jams the teeth"}));
  CHECK(names(refusal(gear_pairs::t2(0.427)), {"contact_ratio"}));
  GearGeometry p = gear_pairs::t2();
  p.gear_1.tip_diameter = 0.34;
  CHECK(names(refusal(p), {"runs into the root", "gear_1.tip_diameter"}));
  p = gear_pairs::t2();
  p.rack.root_radius = 0.6;
  CHECK(names(refusal(p), {"rack.root_radius"}));
  p = gear_pairs::t2();
  p.gear_1.bore_diameter = 0.3;
  p.gear_2.web_thickness = 0.01;
  p.gear_2.width = -1.0;
  const std::string both = refusal(p);
  CHECK(names(both, {"gear_2.web_thickness", "gear_2.width"}));
}
