#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/models/gears/gear_geometry.hpp>
#include <drev/models/gears/tooth_contour.hpp>

#include <algorithm>
#include <cmath>

namespace drev {
namespace {

constexpr int kFewestTeeth = 6, kMostTeeth = 2000;
constexpr double kOverrun =
    2e-4;  // modules by which contact may pass the end of a flank: drawings are rounded
constexpr double kMostJam = 0.01;  // modules of negative play that tooth thickness tolerances can make up for
constexpr double kMostRatio = 3.99;  // contact ratio: five pairs at once are not computed

bool is_given(double value) { return !std::isnan(value); }
double tangent_of(double radius, double base) { return std::sqrt((radius - base) * (radius + base)); }
std::string name_of(const char* key, int gear) { return "gear_" + std::to_string(gear + 1) + "." + key; }

void check_body(ParameterCheck& check, const GearData& g, int gear, bool ring) {
  const auto name = [gear](const char* key) { return name_of(key, gear); };
  const auto not_here = [&](const char* key, double value, const char* why) {
    if (is_given(value)) check.fail(name(key), to_text(value), "m", why);
  };
  if (ring) {
    constexpr const char* kHeldOutside = "must not be there: a ring is held at its outer_diameter";
    not_here("bore_diameter", g.bore_diameter, kHeldOutside);
    not_here("rim_inner_diameter", g.rim_inner_diameter, kHeldOutside);
    not_here("hub_diameter", g.hub_diameter, kHeldOutside);
    not_here("web_thickness", g.web_thickness, kHeldOutside);
    if (is_given(g.outer_diameter)) check.positive(name("outer_diameter"), g.outer_diameter, "m");
  } else {
    not_here("outer_diameter", g.outer_diameter,
             "must not be there: it is that of a ring (internal, gear_2)");
  }
  if (g.teeth < kFewestTeeth || g.teeth > kMostTeeth)
    check.fail(name("teeth"), std::to_string(g.teeth), "",
               "must be from " + std::to_string(kFewestTeeth) + " to " + std::to_string(kMostTeeth));
  if (is_given(g.profile_shift)) check.within(name("profile_shift"), g.profile_shift, -3.0, 3.0, "modules");
  if (is_given(g.tip_diameter)) check.positive(name("tip_diameter"), g.tip_diameter, "m");
  check.within(name("tip_alteration"), g.tip_alteration, -2.0, 1.0, "modules");
  check.non_negative(name("tip_chamfer"), g.tip_chamfer, "m");
  if (is_given(g.width)) check.positive(name("width"), g.width, "m");
  if (is_given(g.bore_diameter)) check.non_negative(name("bore_diameter"), g.bore_diameter, "m");
  check.positive(name("youngs_modulus"), g.material.youngs_modulus, "Pa");
  check.within(name("poisson_ratio"), g.material.poisson_ratio, 0.0, 0.49, "");
  check.positive(name("density"), g.material.density, "kg/m^3");
  const int web = is_given(g.rim_inner_diameter) + is_given(g.hub_diameter) + is_given(g.web_thickness);
  if (web == 0 || ring) return;
  if (web < 3) {
    check.fail(name("web_thickness"), to_text(g.web_thickness), "m",
               "must be given together with rim_inner_diameter and hub_diameter");
    return;
  }
  check.positive(name("web_thickness"), g.web_thickness, "m");
  if (g.web_thickness > g.width)
    check.fail(name("web_thickness"), to_text(g.web_thickness), "m",
               "must not exceed the width, " + to_text(g.width));
  if (!(g.hub_diameter > (is_given(g.bore_diameter) ? g.bore_diameter : 0.0)))
    check.fail(name("hub_diameter"), to_text(g.hub_diameter), "m", "must exceed the bore");
  if (!(g.rim_inner_diameter > g.hub_diameter))
    check.fail(name("rim_inner_diameter"), to_text(g.rim_inner_diameter), "m", "must exceed hub_diameter");
}

ToothContour::Data contour_data(const GearGeometry& p, const GearData& g) {
  return {.module = p.module,
          .pressure_angle = p.pressure_angle,
          .helix_angle = p.helix_angle,
          .teeth = g.teeth,
          .profile_shift = g.profile_shift,
          .rack = p.rack,
          .tip_radius = 0.5 * g.tip_diameter,
          .chamfer = g.tip_chamfer,
          .ring = p.internal && &g == &p.gear_2};
}

}  // namespace

double inverse_involute(double value) {
  // Near 0 inv(a) = a^3/3; Newton's iteration from above converges from there on, inv being convex.
  double angle = std::min(std::cbrt(3.0 * value), 1.5);
  for (int i = 0; i < 60; ++i) {
    const double tangent = std::tan(angle);
    const double step = tangent > 0.0 ? (tangent - angle - value) / (tangent * tangent) : 0.0;
    angle -= step;
    if (std::abs(step) < 1e-16) break;
  }
  return angle;
}

GearPair::GearPair(GearGeometry geometry, const std::string& place)
    : geometry_(std::move(geometry)), contour_1_(ToothContour::Data{}), contour_2_(ToothContour::Data{}) {
  std::vector<Finding> findings;
  ParameterCheck check(place, findings);
  const auto stop = [&] {
    if (!findings.empty()) throw ModelError(std::move(findings));
  };
  check_numbers(check);
  stop();
  find_shifts(check);
  stop();
  contour_1_ = ToothContour(contour_data(geometry_, geometry_.gear_1));
  contour_2_ = ToothContour(contour_data(geometry_, geometry_.gear_2));
  const double sign = geometry_.internal ? -1.0 : 1.0;
  const double rb_1 = contour_1_.base_radius(), rb_2 = contour_2_.base_radius();
  base_sum_ = geometry_.internal ? rb_2 - rb_1 : rb_1 + rb_2;
  const double a = geometry_.centre_distance;
  operating_angle_ = std::acos(base_sum_ / a);
  base_pitch_ = kTwoPi * rb_1 / geometry_.gear_1.teeth;
  base_helix_ = std::atan(std::tan(geometry_.helix_angle) * std::cos(transverse_angle()));
  tangent_ = tangent_of(a, base_sum_);
  start_ = sign * (tangent_ - tangent_of(contour_2_.usable_tip_radius(), rb_2));
  end_ = contour_1_.tip_length();
  const double w1 = geometry_.gear_1.width, w2 = geometry_.gear_2.width;
  width_ = is_given(w1) && is_given(w2) ? std::min(w1, w2) : (is_given(w1) ? w1 : w2);
  overlap_ = is_given(width_) ? width_ * std::tan(base_helix_) / base_pitch_ : 0.0;
  const auto thickness = [&](const GearData& g, double rw, double side) {  // on the working pitch circle
    return 2.0 * rw *
           ((0.5 * kPi + 2.0 * g.profile_shift * std::tan(geometry_.pressure_angle)) / g.teeth +
            side * (involute(transverse_angle()) - involute(operating_angle_)));
  };
  const double rw_1 = rb_1 / std::cos(operating_angle_), rw_2 = rb_2 / std::cos(operating_angle_);
  play_ = kTwoPi * rw_1 / geometry_.gear_1.teeth - thickness(geometry_.gear_1, rw_1, 1.0) -
          thickness(geometry_.gear_2, rw_2, sign);
  check_teeth(check);
  stop();
}

void GearPair::check_numbers(ParameterCheck& check) const {
  const GearGeometry& p = geometry_;
  check.within("module", p.module, 1e-5, 10.0, "m");
  check.within("pressure_angle", p.pressure_angle, 10.0 * kPi / 180.0, 35.0 * kPi / 180.0, "rad");
  check.within("helix_angle", p.helix_angle, 0.0, kPi / 4.0, "rad");
  check.within("rack.addendum", p.rack.addendum, 0.1, 3.0, "modules");
  check.within("rack.dedendum", p.rack.dedendum, 0.1, 3.0, "modules");
  check.within("rack.root_radius", p.rack.root_radius, 0.0, 1.0, "modules");
  if (is_given(p.centre_distance)) check.positive("centre_distance", p.centre_distance, "m");
  check_body(check, p.gear_1, 0, false);
  check_body(check, p.gear_2, 1, p.internal);
  if (p.internal && p.gear_2.teeth <= p.gear_1.teeth)
    check.fail("gear_2.teeth", std::to_string(p.gear_2.teeth), "", "of a ring must exceed those of gear 1");
  if (is_given(p.centre_distance) && is_given(p.gear_1.profile_shift) && p.internal &&
      !is_given(p.gear_2.profile_shift))
    check.fail("gear_2.profile_shift", "NaN", "modules", "of a ring must be given");
}

void GearPair::find_shifts(ParameterCheck& check) {
  GearGeometry& p = geometry_;
  const int sign = p.internal ? -1 : 1;
  const double z = std::abs(p.gear_1.teeth + sign * p.gear_2.teeth);
  const double at = std::atan(std::tan(p.pressure_angle) / std::cos(p.helix_angle));
  const double reference = 0.5 * z * p.module / std::cos(p.helix_angle);  // centre distance without shifts
  const double signed_z = p.internal ? -z : z, slope = 2.0 * std::tan(p.pressure_angle) / signed_z;
  if (!is_given(p.gear_1.profile_shift)) p.gear_1.profile_shift = 0.0;
  if (is_given(p.centre_distance) && !(p.centre_distance > reference * std::cos(at))) {
    check.fail("centre_distance", to_text(p.centre_distance), "m",
               "must exceed the sum of the base radii, " + to_text(reference * std::cos(at)));
    return;
  }
  if (!is_given(p.gear_2.profile_shift)) {
    p.gear_2.profile_shift = 0.0;
    if (is_given(p.centre_distance)) {
      const double aw = std::acos(reference * std::cos(at) / p.centre_distance);
      p.gear_2.profile_shift = (involute(aw) - involute(at)) / slope - p.gear_1.profile_shift;
      check.within("gear_2.profile_shift", p.gear_2.profile_shift, -3.0, 3.0,
                   "modules, from the centre distance");
    }
  }
  const double sum = p.gear_1.profile_shift + p.gear_2.profile_shift;
  const double value = involute(at) + slope * sum;
  if (!(value > 0.0)) {
    check.fail("gear_2.profile_shift", to_text(p.gear_2.profile_shift), "modules",
               "makes the sum of shifts " + to_text(sum) +
                   ": there is no operating pressure angle without backlash");
    return;
  }
  zero_backlash_distance_ = reference * std::cos(at) / std::cos(inverse_involute(value));
  if (!is_given(p.centre_distance)) p.centre_distance = zero_backlash_distance_;
  for (GearData* g : {&p.gear_1, &p.gear_2}) {
    const bool ring = p.internal && g == &p.gear_2;
    const double outwards = g->profile_shift + p.rack.addendum + g->tip_alteration;
    if (!is_given(g->tip_diameter))
      g->tip_diameter = p.module * (g->teeth / std::cos(p.helix_angle) + (ring ? -2.0 : 2.0) * outwards);
  }
}

void GearPair::check_teeth(ParameterCheck& check) const {
  const GearGeometry& p = geometry_;
  const double m = p.module;
  for (int i = 0; i < 2; ++i) check_tooth(check, i);
  if (!(play_ >= -kMostJam * m))
    check.fail("centre_distance", to_text(p.centre_distance), "m",
               "jams the teeth by " + to_text(-play_) + " m on the pitch circle; without backlash it is " +
                   to_text(zero_backlash_distance_));
  if (p.internal)
    check_ring(check);
  else
    check_tips(check);
  if (!(contact_ratio() >= 1.0))
    check.fail("contact_ratio", to_text(contact_ratio()), "",
               "must be at least 1: the tips do not reach far enough");
  if (contact_ratio() > kMostRatio)
    check.fail("contact_ratio", to_text(contact_ratio()), "", "must be at most " + to_text(kMostRatio));
}

/// One gear's tooth by itself.
void GearPair::check_tooth(ParameterCheck& check, int i) const {
  const ToothContour& c = contour(i);
  const GearData& g = gear(i);
  const bool ring = is_ring(i);
  if (!(c.rack_tip_land() >= 0.0))
    check.fail("rack.root_radius", to_text(geometry_.rack.root_radius), "modules",
               ring ? "does not fit into the ring's root" : "does not fit into the rack's tip");
  if (ring && !(c.usable_tip_radius() > c.base_radius() && c.usable_tip_radius() < c.root_radius())) {
    check.fail(name_of("tip_diameter", i), to_text(g.tip_diameter), "m",
               "of a ring with its chamfer must exceed its base circle, " + to_text(2.0 * c.base_radius()) +
                   ", and be less than its root circle, " + to_text(2.0 * c.root_radius()));
    return;
  }
  if (!ring && !(c.usable_tip_radius() > std::max(c.base_radius(), c.root_radius()))) {
    check.fail(name_of("tip_diameter", i), to_text(g.tip_diameter), "m",
               "less the chamfer must exceed the base circle, " + to_text(2.0 * c.base_radius()) +
                   ", and the root circle, " + to_text(2.0 * c.root_radius()));
    return;
  }
  if (c.form_length() < 0.0)
    check.fail(
        name_of("profile_shift", i), to_text(g.profile_shift), "modules",
        "leaves the tooth undercut; it must be at least " +
            to_text(g.profile_shift - c.form_length() * std::sin(c.transverse_angle()) / geometry_.module));
  if (!(c.tip_half_angle() > 0.0))
    check.fail(name_of("tip_diameter", i), to_text(g.tip_diameter), "m",
               "leaves the tooth pointed below its tip");
  if (!(c.side() * (c.tip_length() - c.form_length()) > 0.0))
    check.fail(name_of("tip_diameter", i), to_text(g.tip_diameter), "m",
               "leaves no involute above the fillet");
  const auto inside = [&](const char* key, double value) {
    if (is_given(value) && !(0.5 * value < c.root_radius()))
      check.fail(name_of(key, i), to_text(value), "m",
                 "must be less than the root circle, " + to_text(2.0 * c.root_radius()));
  };
  inside("bore_diameter", g.bore_diameter);
  inside("rim_inner_diameter", g.rim_inner_diameter);
  if (is_given(g.outer_diameter) && !(0.5 * g.outer_diameter > c.root_radius()))
    check.fail(name_of("outer_diameter", i), to_text(g.outer_diameter), "m",
               "must exceed the root circle, " + to_text(2.0 * c.root_radius()));
}

/// Tips of external gears against the other's root and fillet.
void GearPair::check_tips(ParameterCheck& check) const {
  for (int i = 0; i < 2; ++i) {
    const ToothContour& own = contour(i);
    const ToothContour& other = contour(1 - i);
    if (own.data().tip_radius + other.root_radius() > centre_distance())
      check.fail(name_of("tip_diameter", i), to_text(gear(i).tip_diameter), "m",
                 "runs into the root of the other gear; at most " +
                     to_text(2.0 * (centre_distance() - other.root_radius())));
    else if (tangent_ - own.tip_length() < other.form_length() - kOverrun * geometry_.module)
      check.fail(name_of("tip_diameter", i), to_text(gear(i).tip_diameter), "m",
                 "runs into the fillet of the other gear: contact ratio by formula " +
                     to_text(contact_ratio()) + ", the flanks allow " + to_text(flank_contact_ratio()) +
                     "; less twice the chamfer at most " +
                     to_text(2.0 * std::hypot(own.base_radius(), tangent_ - other.form_length())));
  }
}

/// Tips of a ring and of its pinion against the other's root and fillet, and against each other outside the path.
void GearPair::check_ring(ParameterCheck& check) const {
  const GearGeometry& p = geometry_;
  const double a = p.centre_distance, overrun = kOverrun * p.module;
  const double tip_1 = contour_1_.data().tip_radius, tip_2 = contour_2_.data().tip_radius;
  const auto fail = [&](int i, const std::string& why) {
    check.fail(name_of("tip_diameter", i), to_text(gear(i).tip_diameter), "m", why);
  };
  if (a + tip_1 > contour_2_.root_radius())
    fail(0, "runs into the root of the ring; at most " + to_text(2.0 * (contour_2_.root_radius() - a)));
  else if (tangent_ + end_ > contour_2_.form_length() + overrun)
    fail(0, "runs into the fillet of the ring; less twice the chamfer at most " +
                to_text(2.0 * std::hypot(contour_1_.base_radius(), contour_2_.form_length() - tangent_)));
  if (tip_2 - a < contour_1_.root_radius())
    fail(1, "runs into the root of gear 1; at least " + to_text(2.0 * (a + contour_1_.root_radius())));
  else if (start_ < contour_1_.form_length() - overrun)
    fail(1, "runs into the fillet of gear 1; at least " +
                to_text(2.0 * std::hypot(contour_2_.base_radius(), tangent_ + contour_1_.form_length())));
  const double cosine = (tip_2 * tip_2 - tip_1 * tip_1 - a * a) / (2.0 * a * tip_1);
  if (!(std::abs(cosine) < 1.0)) return;  // the tip circles do not cross
  const auto inv_at = [](const ToothContour& c) {
    return involute(std::atan(c.tip_length() / c.base_radius()));
  };
  const double inv_w = involute(operating_angle_),
               ratio = contour_1_.base_radius() / contour_2_.base_radius();
  const double room = ratio * (std::acos(cosine) + inv_at(contour_1_) - inv_w) + inv_w - inv_at(contour_2_) -
                      std::acos((tip_2 * tip_2 - tip_1 * tip_1 + a * a) / (2.0 * a * tip_2));
  if (room < 0.0)
    fail(1,
         "lets the tips of ring and pinion run into each other by " + to_text(-room * tip_2) +
             " m outside the path of contact: more teeth of the ring, a larger tip of the ring or a shorter "
             "one of gear 1 make room");
}

double GearPair::flank_contact_ratio() const {
  const double sign = geometry_.internal ? -1.0 : 1.0;
  return (sign * (tangent_ - contour_2_.form_length()) - contour_1_.form_length()) / base_pitch_;
}

double GearPair::normal_backlash() const { return play_ * std::cos(operating_angle_); }

double GearPair::inertia(int gear_number) const {
  const GearData& g = gear(gear_number);
  std::vector<Finding> findings;
  ParameterCheck check("gear pair", findings);
  check.positive(name_of("width", gear_number), g.width, "m");
  if (is_ring(gear_number)) check.positive("gear_2.outer_diameter", g.outer_diameter, "m");
  if (!findings.empty()) throw ModelError(std::move(findings));
  const auto disc = [](double diameter) { return kPi / 32.0 * std::pow(diameter, 4); };
  const double outline = contour(gear_number).polar_moment();
  if (is_ring(gear_number)) return g.material.density * g.width * (disc(g.outer_diameter) - outline);
  const double bore = is_given(g.bore_diameter) ? disc(g.bore_diameter) : 0.0;
  double full = outline - bore, web = 0.0;
  if (is_given(g.web_thickness)) {
    web = disc(g.rim_inner_diameter) - disc(g.hub_diameter);
    full -= web;
  }
  return g.material.density * (g.width * full + (web > 0.0 ? g.web_thickness * web : 0.0));
}

}  // namespace drev
