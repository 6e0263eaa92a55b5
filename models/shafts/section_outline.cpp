#include "models/shafts/section_outline.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/shafts/argument_check.hpp"

namespace drev {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr int kRoundCells = 12;  // along a quarter of a round

OutlineEdge line(PlanePoint a, PlanePoint b, bool free = true) {
  return {.at =
              [a, b](double t) {
                return PlanePoint{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
              },
          .free = free};
}
/// Angles from x towards y; from > to: clockwise, the material outside the circle.
OutlineEdge arc(PlanePoint centre, double radius, double from, double to, int cells = 0) {
  return {.at =
              [=](double t) {
                const double angle = from + t * (to - from);
                return PlanePoint{centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)};
              },
          .cells = cells};
}
OutlineEdge turned(const OutlineEdge& edge) {
  OutlineEdge other = edge;
  other.at = [at = edge.at](double t) {
    const PlanePoint p = at(1.0 - t);
    return PlanePoint{-p[0], p[1]};
  };
  return other;
}

}  // namespace

SectionOutline ellipse_outline(double a, double b) {
  ArgumentCheck check("ellipse");
  check.lengths({{"a", a}, {"b", b}});
  check.refuse();
  OutlineEdge edge{.at = [a, b](double t) {
    return PlanePoint{a * std::cos(2.0 * kHalfTurn * t), b * std::sin(2.0 * kHalfTurn * t)};
  }};
  edge.cells = 48;
  return {.name = "ellipse", .edges = {edge}, .size = std::max(a, b)};
}

SectionOutline polygon_outline(const std::vector<PlanePoint>& corners) {
  ArgumentCheck check("polygon");
  const std::size_t n = corners.size();
  SectionOutline outline{.name = "polygon"};
  for (std::size_t k = 0; k < n; ++k) {
    const PlanePoint &a = corners[k], &b = corners[(k + 1) % n], &c = corners[(k + 2) % n];
    const double turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    if (!(turn > 0.0))
      check.fail("corner " + std::to_string((k + 1) % n + 1), to_text(b[0]) + ", " + to_text(b[1]), "m",
                 "must be a convex corner, counter-clockwise from the one before it");
    outline.size = std::max(outline.size, std::hypot(a[0], a[1]));
    outline.edges.push_back(line(a, b));
  }
  if (n < 3) check.fail("corners", std::to_string(n), "", "must be at least 3");
  check.refuse();
  return outline;
}

SectionOutline rectangle_outline(double a, double b) {
  ArgumentCheck check("rectangle");
  check.lengths({{"a", a}, {"b", b}});
  check.refuse();
  SectionOutline outline =
      polygon_outline({{-0.5 * a, -0.5 * b}, {0.5 * a, -0.5 * b}, {0.5 * a, 0.5 * b}, {-0.5 * a, 0.5 * b}});
  outline.name = "rectangle";
  return outline;
}

SectionOutline ring_outline(double radius, double hole_radius, double offset) {
  ArgumentCheck check("ring");
  check.lengths({{"radius", radius}, {"hole_radius", hole_radius}});
  check.finite("offset", offset, "m");
  if (check.sound() && !(hole_radius + std::abs(offset) < 0.999 * radius))
    check.fail("hole_radius + offset", to_text(hole_radius + std::abs(offset)), "m",
               "must be less than 0.999 radius, " + to_text(0.999 * radius));
  check.refuse();
  return {.name = "ring",
          .edges = {arc({0.0, 0.0}, radius, 0.0, 2.0 * kHalfTurn, 64)},
          .size = radius,
          .hole = {offset, 0.0},
          .hole_radius = hole_radius};
}

SectionOutline grooved_outline(double radius, double groove_radius) {
  ArgumentCheck check("grooved circle");
  check.lengths({{"radius", radius}, {"groove_radius", groove_radius}});
  if (check.sound() && !(groove_radius < 0.8 * radius))
    check.fail("groove_radius", to_text(groove_radius), "m",
               "must be less than 0.8 radius, " + to_text(0.8 * radius));
  check.refuse();
  // The groove's centre is (0, radius): both circles meet at an angle of 2 asin(b/2a) from there about the axis.
  const double from_top = 2.0 * std::asin(0.5 * groove_radius / radius);
  const double end = 0.5 * kHalfTurn - from_top;  // of the circle, about the axis
  const double start = std::atan2(radius * std::sin(end) - radius, radius * std::cos(end));
  const PlanePoint bottom{0.0, radius - groove_radius};
  return {.name = "grooved circle",
          .edges = {arc({0.0, 0.0}, radius, -0.5 * kHalfTurn, end),
                    arc({0.0, radius}, groove_radius, start, -0.5 * kHalfTurn, kRoundCells),
                    line(bottom, {0.0, -radius}, false)},
          .copies = 2,
          .size = radius};
}

SectionOutline keyway_outline(double diameter, double width, double depth, double corner_radius) {
  ArgumentCheck check("keyway");
  check.lengths({{"diameter", diameter}, {"width", width}, {"depth", depth}});
  check.finite("corner_radius", corner_radius, "m");
  if (!(corner_radius > 0.0))
    check.fail("corner_radius", to_text(corner_radius), "m",
               "must be > 0: the stress in a sharp inner corner has no limit");
  const double radius = 0.5 * diameter, half = 0.5 * width, bottom = radius - depth;
  if (diameter > 0.0 && width >= 0.8 * diameter)
    check.fail("width", to_text(width), "m", "must be less than 0.8 diameter, " + to_text(0.8 * diameter));
  if (diameter > 0.0 && depth >= 0.45 * diameter)
    check.fail("depth", to_text(depth), "m", "must be less than 0.45 diameter, " + to_text(0.45 * diameter));
  check.refuse();
  const double crown = std::sqrt(radius * radius - half * half);
  if (!(corner_radius <= half))
    check.fail("corner_radius", to_text(corner_radius), "m",
               "must be at most half the width, " + to_text(half));
  if (!(bottom + corner_radius < crown))
    check.fail("depth", to_text(depth), "m",
               "must exceed the crown's height over the keyway's sides and the corner radius, together " +
                   to_text(radius - crown + corner_radius));
  if (corner_radius < 1e-3 * radius)
    check.fail("corner_radius", to_text(corner_radius), "m",
               "must be at least 0.0005 diameter, " + to_text(5e-4 * diameter));
  check.refuse();
  SectionOutline outline{.name = "keyway", .copies = 2, .size = radius};
  outline.edges = {
      arc({0.0, 0.0}, radius, -0.5 * kHalfTurn, std::atan2(crown, half)),
      line({half, crown}, {half, bottom + corner_radius}),
      arc({half - corner_radius, bottom + corner_radius}, corner_radius, 0.0, -0.5 * kHalfTurn, kRoundCells)};
  if (corner_radius < 0.999 * half)
    outline.edges.push_back(line({half - corner_radius, bottom}, {0.0, bottom}));
  outline.edges.push_back(line({0.0, bottom}, {0.0, -radius}, false));
  return outline;
}

SectionOutline spline_outline(int teeth, double minor_diameter, double major_diameter, double tooth_width,
                              double root_radius) {
  ArgumentCheck check("spline");
  if (teeth < 4 || teeth > 200) check.fail("teeth", std::to_string(teeth), "", "must be between 4 and 200");
  check.lengths(
      {{"minor_diameter", minor_diameter}, {"major_diameter", major_diameter}, {"tooth_width", tooth_width}});
  if (!(root_radius > 0.0))
    check.fail("root_radius", to_text(root_radius), "m",
               "must be > 0: the stress in a sharp inner corner has no limit");
  if (!(major_diameter > minor_diameter))
    check.fail("major_diameter", to_text(major_diameter), "m",
               "must exceed minor_diameter, " + to_text(minor_diameter));
  check.refuse();
  const double root = 0.5 * minor_diameter, tip = 0.5 * major_diameter, half = 0.5 * tooth_width;
  const double pitch = kHalfTurn / teeth;  // half of the angle of a tooth and its space
  // The round touches the side x = half and the root circle from outside: centre at x = half + r, |c| = root + r.
  const double cx = half + root_radius, reach = root + root_radius;
  if (!(half < tip))
    check.fail("tooth_width", to_text(tooth_width), "m", "must be less than the major diameter");
  check.refuse();
  const double cy = std::sqrt(std::max(reach * reach - cx * cx, 0.0)), centre = std::atan2(cx, cy);  // from y
  if (!(cx < reach) || !(centre < pitch))
    check.fail("root_radius", to_text(root_radius), "m",
               "must leave room between the teeth: tooth width and twice the radius must be less than " +
                   to_text(2.0 * reach * std::sin(pitch)));
  const double top = std::sqrt(tip * tip - half * half);
  if (!(cy < top))
    check.fail("root_radius", to_text(root_radius), "m",
               "must be less than the height of the tooth's sides above it");
  if (root_radius < 1e-3 * root)
    check.fail("root_radius", to_text(root_radius), "m",
               "must be at least 0.0005 minor diameter, " + to_text(1e-3 * root));
  check.refuse();
  const double quarter = 0.5 * kHalfTurn;
  // Right half of a tooth about the y axis, from its space to its top.
  std::vector<OutlineEdge> edges = {
      line({0.0, 0.0}, {root * std::sin(pitch), root * std::cos(pitch)}, false),
      arc({0.0, 0.0}, root, quarter - pitch, quarter - centre),
      arc({cx, cy}, root_radius, -quarter - centre, -kHalfTurn, kRoundCells / 2),
      line({half, cy}, {half, top}), arc({0.0, 0.0}, tip, std::atan2(top, half), quarter)};
  std::vector<OutlineEdge> images;
  for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge) images.push_back(turned(*edge));
  edges.insert(edges.end(), images.begin(), images.end());
  return {.name = "spline", .edges = std::move(edges), .copies = teeth, .size = tip};
}

SectionOutline cam_outline(double base_radius, const PeriodicCurve& lift, double bore_radius) {
  ArgumentCheck check("cam");
  check.lengths({{"base_radius", base_radius}});
  check.non_negative("bore_radius", bore_radius, "m");
  lift.check(check, "lift", "rad", "m");
  check.refuse();
  const double turn = 2.0 * kHalfTurn;
  if (std::abs(lift.points().period() - turn) > 1e-9)
    check.fail("lift", to_text(lift.points().period()), "rad", "must have a period of one turn");
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (int i = 0; i < 720; ++i) {
    const double height = lift.at(turn * i / 720).value;
    least = std::min(least, height), most = std::max(most, height);
  }
  if (check.sound() && !(least > -0.5 * base_radius && most < 3.0 * base_radius))
    check.fail("lift", to_text(least) + " to " + to_text(most), "m",
               "must stay between -0.5 and 3 times base_radius, " + to_text(base_radius));
  if (check.sound() && !(bore_radius < 0.98 * (base_radius + least)))
    check.fail("bore_radius", to_text(bore_radius), "m",
               "must be less than 0.98 of the profile's smallest radius, " + to_text(base_radius + least));
  check.refuse();
  SectionOutline outline{
      .name = "cam", .size = base_radius + std::max(most, 0.0), .hole_radius = bore_radius};
  constexpr int kSectors = 96;
  OutlineEdge edge{.at = [base_radius, lift, turn](double t) {
    const double radius = base_radius + lift.at(turn * t).value;
    return PlanePoint{radius * std::cos(turn * t), radius * std::sin(turn * t)};
  }};
  edge.cells = kSectors;
  outline.edges = {edge};
  return outline;
}

}  // namespace drev
