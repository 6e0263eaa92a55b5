#include "models/shafts/published_factors.hpp"

#include <drev/core/error.hpp>

#include <cmath>
#include <numbers>

#include "models/shafts/argument_check.hpp"

namespace drev {
namespace {

struct FitRow {
  double constant, of_root, of_ratio;
};

/// sum_i C_i x^(i-1), C_i of q = h/r.
double fitted(const FitRow (&rows)[4], double q, double x) {
  double sum = 0.0, power = 1.0;
  for (const FitRow& row : rows) {
    sum += power * (row.constant + row.of_root * std::sqrt(q) + row.of_ratio * q);
    power *= x;
  }
  return sum;
}

constexpr FitRow kShoulder[4] = {
    {0.905, 0.783, -0.075}, {-0.437, -1.969, 0.553}, {1.557, 1.073, -0.578}, {-1.061, 0.171, 0.086}};
constexpr FitRow kShallowGroove[4] = {
    {1.245, 0.264, 0.491}, {-3.030, 3.269, -3.633}, {7.199, -11.286, 8.318}, {-4.414, 7.753, -5.176}};
constexpr FitRow kDeepGroove[4] = {
    {1.651, 0.614, 0.040}, {-4.794, -0.314, -0.217}, {8.457, -0.962, 0.389}, {-4.314, 0.662, -0.212}};

}  // namespace

double shoulder_factor(double large_diameter, double small_diameter, double fillet_radius) {
  ArgumentCheck check("shoulder_factor");
  check.lengths({{"small_diameter", small_diameter}, {"fillet_radius", fillet_radius}});
  check.finite("large_diameter", large_diameter, "m");
  check.refuse();
  const double h = 0.5 * (large_diameter - small_diameter);
  check.within("(large_diameter - small_diameter)/(2 fillet_radius)", h / fillet_radius, 0.25, 4.0, "");
  check.refuse();
  return fitted(kShoulder, h / fillet_radius, 2.0 * h / large_diameter);
}

double groove_factor(double diameter, double depth, double radius) {
  ArgumentCheck check("groove_factor");
  check.lengths({{"diameter", diameter}, {"depth", depth}, {"radius", radius}});
  check.refuse();
  check.within("depth/radius", depth / radius, 0.25, 50.0, "");
  if (!(2.0 * depth < diameter))
    check.fail("depth", to_text(depth), "m",
               "must be less than half of the diameter, " + to_text(0.5 * diameter));
  check.refuse();
  const double q = depth / radius;
  return fitted(q <= 2.0 ? kShallowGroove : kDeepGroove, q, 2.0 * depth / diameter);
}

double neuber_groove_factor(double net_diameter, double radius) {
  ArgumentCheck check("neuber_groove_factor");
  check.lengths({{"net_diameter", net_diameter}, {"radius", radius}});
  check.refuse();
  const double a = std::sqrt(1.0 + net_diameter / (2.0 * radius));
  return 3.0 * (1.0 + a) * (1.0 + a) / (4.0 * (1.0 + 2.0 * a));
}

double cone_flexibility(double small_diameter, double large_diameter, double length) {
  ArgumentCheck check("cone_flexibility");
  check.lengths({{"small_diameter", small_diameter}, {"large_diameter", large_diameter}, {"length", length}});
  check.refuse();
  // (1/d^3 - 1/D^3)/(D - d) = (D^2 + D d + d^2)/(d D)^3, which holds at D = d too.
  const double d = small_diameter, D = large_diameter;
  return 32.0 * length / (3.0 * std::numbers::pi) * (D * D + D * d + d * d) / std::pow(d * D, 3);
}

double exact_cone_flexibility(double half_angle, double inner_sphere, double outer_sphere) {
  ArgumentCheck check("exact_cone_flexibility");
  check.within("half_angle", half_angle, 1e-3, 0.499 * std::numbers::pi, "rad");
  check.lengths({{"inner_sphere", inner_sphere}});
  if (!(outer_sphere > inner_sphere))
    check.fail("outer_sphere", to_text(outer_sphere), "m",
               "must exceed inner_sphere, " + to_text(inner_sphere));
  check.refuse();
  const double c = std::cos(half_angle), f = 2.0 / 3.0 - c + c * c * c / 3.0;
  return (std::pow(inner_sphere, -3.0) - std::pow(outer_sphere, -3.0)) / (6.0 * std::numbers::pi * f);
}

}  // namespace drev
