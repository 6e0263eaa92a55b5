// Internal pairs: geometry of the ring, compliance of its teeth on their rim against an independent finite-element program
// (docs/gears.md: all teeth, triangles of six nodes, Hertz's pressure resolved), the rack as the limit of many teeth,
// load sharing, contact outside the path, the element that follows.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/models/gears/gear_drawing.hpp>

#include <cmath>

#include "models/gears/analytic_stiffness.hpp"
#include "models/gears/gear_element.hpp"
#include "models/gears/tooth_compliance.hpp"
#include "tests/catch.hpp"
#include "tests/unit/models/gears/gear_pairs.hpp"

using namespace drev;

namespace {

constexpr double kModule = 0.002;

/// `rim`: from the ring's root to its outside, modules.
GearGeometry ring_pair(int z_1 = 24, int z_2 = 72, double x_1 = 0.0, double x_2 = 0.0, double rim = 5.25) {
  GearGeometry p = gear_pairs::pair(1e3 * kModule, z_1, z_2, x_1, x_2);
  p.internal = true;
  p.gear_2.tip_alteration = -0.2;  // clear of the fillet of gear 1
  p.gear_1.width = p.gear_2.width = 0.02;
  p.gear_2.bore_diameter = kNotGiven;
  p.gear_2.outer_diameter = kModule * (z_2 - 2.0 * x_2 + 2.5 + 2.0 * rim);
  return p;
}

double apart(double value, double expected) { return std::abs(value / expected - 1.0); }

std::string ring_refusal(const GearGeometry& p) {
  try {
    MeshCycle cycle((GearPair(p)));
  } catch (const ModelError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A ring with shifts has no play at its own centre distance", "[gears]") {
  for (const double x_2 : {-0.3, 0.0, 0.4}) {
    const GearPair pair(ring_pair(24, 72, 0.4, x_2));
    CHECK(std::abs(pair.circumferential_backlash()) < 1e-15);
    // ISO 21771 with z_2 < 0: thickness m (pi/2 + 2 x tan(alpha)) of the ring's tooth on its pitch circle.
    const double pitch_thickness = 2.0 * 0.072 * pair.contour(1).half_angle(0.072);
    CHECK(apart(pitch_thickness, kModule * (0.5 * kPi + 2.0 * x_2 * std::tan(kPi / 9.0))) < 1e-13);
  }
  // Moving the pinion out of mesh (towards the ring's centre) by d opens by 2 d tan(alpha_w).
  GearGeometry p = ring_pair(24, 72, 0.2, 0.1);
  const GearPair closed(p);
  p.centre_distance = closed.centre_distance() - 1e-6;
  CHECK(apart(GearPair(p).circumferential_backlash(), 2e-6 * std::tan(closed.operating_angle())) < 1e-3);
}

TEST_CASE("Backlash of a ring at working temperature", "[gears]") {
  const GearPair pair(ring_pair());
  BacklashTolerances t{.thickness = {{{-100e-6, 0.0}, {-100e-6, 0.0}}}};
  const double cold = Backlash(pair, t).lowest(), opening = 2.0 * std::sin(pair.operating_angle());
  t.temperature_rise = {60.0, 60.0};
  t.housing_temperature_rise = 60.0;
  CHECK(std::abs(Backlash(pair, t).lowest() - cold) < 1e-12);  // all alike: nothing to first order
  t.temperature_rise = {60.0, 20.0};                           // a cold ring on a hot planet
  CHECK(std::abs(Backlash(pair, t).lowest() - cold + opening * 0.072 * 11.5e-6 * 40.0) < 1e-11);
  t.temperature_rise = {60.0, 60.0};
  t.housing_temperature_rise = 20.0;  // the axes stay nearer than the gears grow: more play
  CHECK(std::abs(Backlash(pair, t).lowest() - cold - opening * 0.048 * 11.5e-6 * 40.0) < 1e-11);
}

TEST_CASE("Flank, fillet and root of a ring's tooth meet with one tangent", "[gears]") {
  const GearPair pair(ring_pair(24, 72, 0.4, 0.4));
  const ToothContour& c = pair.contour(1);
  // By an independent program that solves for the tangent circle: 14.005861 modules.
  CHECK(std::abs(c.form_length() / kModule - 14.00586147) < 1e-7);
  const auto end = c.flank(c.form_length()), start = c.fillet(kPi / 9.0);
  CHECK(std::abs(end.radius - start.radius) < 1e-14);
  CHECK(std::abs(end.angle - start.angle) < 1e-14);
  CHECK(std::abs(c.fillet(ToothContour::kQuarterTurn).radius - c.root_radius()) < 1e-14);
  const auto above = c.flank(c.form_length() - 1e-7), below = c.fillet(kPi / 9.0 + 1e-5);
  const double cross =
      (above.x() - end.x()) * (start.y() - below.y()) - (above.y() - end.y()) * (start.x() - below.x());
  CHECK(std::abs(cross) < 1e-4 * std::hypot(above.x() - end.x(), above.y() - end.y()) *
                              std::hypot(start.x() - below.x(), start.y() - below.y()));
  // The opening's polar moment by its polygon: sum of (x0 y1 - x1 y0) (x0^2 + x0 x1 + x1^2 + y...)/12.
  const auto line = c.points(400);
  double moment = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const auto &a = line[i - 1], &b = line[i];
    moment += 72.0 * 2.0 / 12.0 * (b[0] * a[1] - a[0] * b[1]) *
              (a[0] * a[0] + a[0] * b[0] + b[0] * b[0] + a[1] * a[1] + a[1] * b[1] + b[1] * b[1]);
  }
  CHECK(apart(c.polar_moment(), moment) < 1e-6);
  const double outside = kPi / 32.0 * std::pow(pair.gear(1).outer_diameter, 4);
  CHECK(apart(pair.inertia(1), 7850.0 * 0.02 * (outside - moment)) < 1e-5);
}

TEST_CASE("A ring's teeth on their rim agree with independent finite elements", "[gears]") {
  // 31,000 to 309,000 nodes; two meshes of the first ring differ by 2e-5 of g and 5e-4 of the coupling.
  const double pitch = std::sin(kPi / 9.0);  // t at the pitch point over the pitch radius
  struct Row {
    GearGeometry pair;
    double t, g;
  };
  const std::vector<Row> rows{{ring_pair(), 36.0 * pitch, 3.0639},
                              {ring_pair(), 10.5, 6.0843},
                              {ring_pair(), 11.0, 5.0319},
                              {ring_pair(), 14.5, 1.4384},
                              {ring_pair(24, 72, 0.4, 0.4, 2.0), 12.0, 1.8342},
                              {ring_pair(24, 72, 0.4, 0.4, 2.0), 13.5, 1.0088},
                              {ring_pair(24, 72, 0, 0, 22.75), 36.0 * pitch, 3.7903},
                              {ring_pair(24, 120, 0, 0, 2.75), 60.0 * pitch, 2.7777}};
  for (const Row& row : rows) {
    INFO(row.pair.gear_2.teeth << " teeth, t " << row.t);
    CHECK(apart(ToothCompliance::own_at(GearPair(row.pair), 1, row.t * kModule, 2), row.g) < 0.01);
    CHECK(apart(ToothCompliance::own_at(GearPair(row.pair), 1, row.t * kModule, 4), row.g) < 0.002);
  }
  // The next tooth, whose t is less by a base pitch: response at a force on the one, and the other way round.
  const GearPair pair(ring_pair());
  const ToothCompliance ring(pair, 1, 10.0 * kModule, 15.0 * kModule);
  const double base = pair.base_pitch();
  CHECK(apart(ring.coupling(1, 14.5 * kModule, 14.5 * kModule - base), 0.54316) < 0.005);
  CHECK(apart(ring.coupling(1, 10.5 * kModule + base, 10.5 * kModule), 0.40927) < 0.005);
  CHECK(apart(ring.coupling(1, 11.0 * kModule + base, 11.0 * kModule), 0.46991) < 0.005);
}

TEST_CASE("A ring's compliance converges with finer meshes", "[gears]") {
  // 3.02924, 3.05719, 3.06317, 3.06419 at levels 1, 2, 4, 8; the independent program 3.0639.
  const GearPair pair(ring_pair());
  const double t = pair.second_length(pair.pitch_point());
  const double one = ToothCompliance::own_at(pair, 1, t, 1), two = ToothCompliance::own_at(pair, 1, t, 2),
               four = ToothCompliance::own_at(pair, 1, t, 4);
  const double order = std::log2((two - one) / (four - two));
  INFO(order);
  CHECK(order > 2.1);
}

TEST_CASE("A ring and an external gear of many teeth are the same rack", "[gears]") {
  std::vector<double> gaps, rings, gears;
  for (const int z : {500, 1000, 2000}) {
    const GearPair inner(ring_pair(24, z, 0, 0, 5.0));
    GearGeometry other = gear_pairs::pair(1e3 * kModule, 24, z, 0, 0);
    other.gear_2.tip_alteration = -0.2;
    other.gear_2.bore_diameter = kModule * (z - 2.5 - 10.0);  // as thick a rim
    const GearPair outer(other);
    rings.push_back(ToothCompliance::own_at(inner, 1, inner.second_length(inner.pitch_point()), 2));
    gears.push_back(ToothCompliance::own_at(outer, 1, outer.second_length(outer.pitch_point()), 2));
  }
  CHECK(apart(rings[2], gears[2]) < 0.01);
  // What is left falls with 1/z, so that both tend to one value.
  CHECK(apart((gears[0] - rings[0]) / (gears[1] - rings[1]), 2.0) < 0.02);
  CHECK(apart((gears[1] - rings[1]) / (gears[2] - rings[2]), 2.0) < 0.02);
  CHECK(apart(2.0 * rings[2] - rings[1], 2.0 * gears[2] - gears[1]) < 3e-4);
}

TEST_CASE("Pairs of a ring share the load by their own and mutual compliance", "[gears]") {
  const GearPair pair(ring_pair());
  const MeshCycleOptions options{.corner_contact = false};
  const MeshCycle cycle(pair, options);
  const double from = pair.start_of_contact(), to = pair.end_of_contact(), base = pair.base_pitch();
  const ToothCompliance pinion(pair, 0, from, to),
      ring(pair, 1, pair.second_length(from), pair.second_length(to));
  const double E = 210e9, w = options.load, part = 0.91 / (kPi * E);
  const auto own = [&](double t, double force) {  // 1/rho = 1/t_1 - 1/t_2
    const double t_2 = t + pair.tangent_length(), rho = 1.0 / (1.0 / t - 1.0 / t_2);
    const double a = std::sqrt(4.0 * force * rho * 2.0 * part);
    return (pinion.own(t) + ring.own(t_2)) / E + 2.0 * part * (2.0 * std::log(2.0 * kModule / a) - 0.3 / 0.7);
  };
  for (const std::size_t i : {5U, 30U, 60U}) {
    const double t = from + cycle.points()[i].phase * base, other = t + base;
    const double mutual =
        (pinion.coupling(1, other, t) + ring.coupling(1, pair.second_length(other), pair.second_length(t))) /
        E;
    double low = 0.0, high = w;  // the entering pair's force
    for (int k = 0; k < 60; ++k) {
      const double f = 0.5 * (low + high), g = w - f;
      (f * own(t, f) + mutual * g < g * own(other, g) + mutual * f ? low : high) = f;
    }
    const double delta = low * own(t, low) + mutual * (w - low);
    CHECK(apart(cycle.points()[i].loaded_error, delta) < 1e-6);
    CHECK(std::abs(cycle.points()[i].shares[0] - low / w) < 1e-6);
  }
  CHECK(std::abs(cycle.figures().loaded_contact_ratio - pair.contact_ratio()) < 0.011);
  CHECK(cycle.errors().mean < 0.005 * cycle.figures().mean);
  // Internal pairs are stiffer than external ones with the same pinion, and touch over a longer way under load.
  const MeshCycle external(GearPair(gear_pairs::pair(1e3 * kModule, 24, 72, 0, 0)), options);
  CHECK(cycle.figures().single_pair > 1.1 * external.figures().single_pair);
}

TEST_CASE("Contact of a ring outside the path makes the curve smooth", "[gears]") {
  const GearPair pair(ring_pair());
  const MeshCycle cycle(pair, {.points = 400});
  double jump = 0.0;
  for (std::size_t i = 1; i < 400; ++i)
    jump = std::max(jump, std::abs(cycle.points()[i].secant - cycle.points()[i - 1].secant));
  CHECK(jump < 0.03 * cycle.figures().mean);
  CHECK(cycle.figures().loaded_contact_ratio > pair.contact_ratio() + 0.15);
  CHECK(std::abs(MeshCycle(pair, {.load = 1.0}).figures().loaded_contact_ratio - pair.contact_ratio()) <
        0.03);
  MeshCycleOptions relieved;
  relieved.tip_relief[1] = {.depth = 4e-6, .length = 2e-3};
  CHECK(MeshCycle(pair, relieved).points()[0].shares[0] < 0.5 * MeshCycle(pair).points()[0].shares[0]);
}

TEST_CASE("Analytic stiffnesses of an internal pair", "[gears]") {
  const GearPair pair(ring_pair());
  const double t = pair.pitch_point(), w = 100e3;
  CHECK(std::isnan(analytic_pair_stiffness(pair, AnalyticMethod::potential_energy, t, w)));
  // Half-planes as bodies know no rim: within the spread that drawings of external gears show.
  CHECK(apart(analytic_pair_stiffness(pair, AnalyticMethod::weber_banaschek, t, w),
              MeshCycle(pair).figures().single_pair) < 0.15);
  // z_n2 infinite: q' = .04723 + .15551/24.
  CHECK(apart(iso_mesh_stiffness(pair, w).theoretical, 1e9 / (0.04723 + 0.15551 / 24.0)) < 1e-12);
  CHECK(iso_mesh_stiffness(pair, w).outside.find("z_n2 infinite") != std::string::npos);
}

TEST_CASE("A ring's drawing gives the element of an internal pair", "[gears]") {
  GearDrawing drawing;
  drawing.geometry = ring_pair();
  drawing.torque_1 = 45.0;
  const GearMesh::Params p = gear_mesh_params(drawing);
  CHECK(p.internal);
  CHECK(apart(p.base_radius_2 / p.base_radius_1, 3.0) < 1e-14);
  const GearMeshData data = gear_mesh_data(drawing);
  CHECK(apart(p.stiffness.mean(), data.cycle.figures().mean * 0.02) < 0.002);
  const GearMesh mesh(p);
  CHECK(apart(mesh.closed_stiffness(), p.stiffness.mean()) < 1e-12);
}

TEST_CASE("Rings that cannot be are refused by their dimension", "[gears]") {
  GearGeometry p = ring_pair();
  p.gear_2.outer_diameter = kNotGiven;
  CHECK(ring_refusal(p).find("gear_2: outer_diameter") != std::string::npos);
  p.gear_2.outer_diameter = 0.148;
  CHECK(ring_refusal(p).find("must exceed the root circle, 0.149") != std::string::npos);
  p.gear_2.outer_diameter = 0.1495;
  CHECK(ring_refusal(p).find("leaves too thin a rim for the tooth; at least") != std::string::npos);
  p.gear_2.bore_diameter = 0.1;
  CHECK(ring_refusal(p).find("held at its outer_diameter") != std::string::npos);
  p = ring_pair();
  p.gear_1.outer_diameter = 0.2;
  CHECK(ring_refusal(p).find("it is that of a ring") != std::string::npos);
  // Three teeth of difference: the tips meet where they do not mesh.
  p = ring_pair(57, 60);
  CHECK(ring_refusal(p).find("run into each other") != std::string::npos);
  p = ring_pair();
  p.gear_2.tip_alteration = 0.0;
  CHECK(ring_refusal(p).find("runs into the fillet of gear 1") != std::string::npos);
  p = ring_pair();
  p.gear_1.tip_alteration = 0.24;
  CHECK(ring_refusal(p).find("runs into the fillet of the ring") != std::string::npos);
  p.gear_1.tip_alteration = 0.3;
  CHECK(ring_refusal(p).find("runs into the root of the ring") != std::string::npos);
  p = ring_pair();
  p.rack.root_radius = 0.6;
  CHECK(ring_refusal(p).find("does not fit into the ring's root") != std::string::npos);
}
