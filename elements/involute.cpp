#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/involute.hpp>

#include <cmath>

namespace drev {

double involute_base_radius(double module, int teeth, double pressure_angle) {
  return 0.5 * module * teeth * std::cos(pressure_angle);
}

double involute_contact_ratio(const InvolutePair& g) {
  std::vector<Finding> findings;
  ParameterCheck check("involute pair", findings);
  check.positive("base_radius_1", g.base_radius_1, "m");
  check.positive("base_radius_2", g.base_radius_2, "m");
  check.positive("teeth_1", g.teeth_1, "");
  if (!(g.tip_radius_1 > g.base_radius_1))
    check.fail("tip_radius_1", to_text(g.tip_radius_1), "m", "must exceed the base radius");
  if (!(g.tip_radius_2 > g.base_radius_2))
    check.fail("tip_radius_2", to_text(g.tip_radius_2), "m", "must exceed the base radius");
  if (!(g.centre_distance > g.base_radius_1 + g.base_radius_2))
    check.fail("centre_distance", to_text(g.centre_distance), "m", "must exceed the sum of the base radii");
  if (!findings.empty()) throw ModelError(std::move(findings));

  // a sin(alpha_w): length of the common tangent of the base circles.
  const double base_sum = g.base_radius_1 + g.base_radius_2;
  const double tangent = std::sqrt((g.centre_distance - base_sum) * (g.centre_distance + base_sum));
  const auto leg = [](double tip, double base) { return std::sqrt((tip - base) * (tip + base)); };
  const double path = leg(g.tip_radius_1, g.base_radius_1) + leg(g.tip_radius_2, g.base_radius_2) - tangent;
  return path / (kTwoPi * g.base_radius_1 / g.teeth_1);
}

double involute_contact_ratio(double module, int teeth_1, int teeth_2, double pressure_angle,
                              double addendum) {
  const double r_1 = 0.5 * module * teeth_1, r_2 = 0.5 * module * teeth_2;
  return involute_contact_ratio({.base_radius_1 = r_1 * std::cos(pressure_angle),
                                 .tip_radius_1 = r_1 + addendum * module,
                                 .base_radius_2 = r_2 * std::cos(pressure_angle),
                                 .tip_radius_2 = r_2 + addendum * module,
                                 .centre_distance = r_1 + r_2,
                                 .teeth_1 = teeth_1});
}

}  // namespace drev
