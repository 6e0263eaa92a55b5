#include "models/gears/analytic_stiffness.hpp"

#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <cmath>
#include <vector>

namespace drev {
namespace {

constexpr int kSteps = 400;

/// A tooth as a beam under a unit force at t: its integrals over y, in m.
struct Beam {
  double angle;                         // a'
  double arm;                           // y_p above the root circle
  double depth;                         // h
  double root_width;                    // s = S_f, chord of the root
  double root_angle;                    // half the tooth's angle at the root circle
  double bending = 0.0, section = 0.0;  // int (y_p - y)^2/(2x)^3 dy, int dy/(2x)
};

Beam beam_of(const ToothContour& c, double t) {
  const auto contact = c.flank(t);
  const double side = c.side();  // a ring's tooth stands on its root circle and points inwards
  Beam beam{};
  beam.angle = std::atan2(t, c.base_radius()) - side * contact.angle;
  beam.root_angle = c.root_angle();
  const double arm = side * contact.y() - contact.x() * std::tan(beam.angle);
  beam.arm = arm - side * c.root_radius();
  beam.depth = contact.x() / std::cos(beam.angle);
  beam.root_width = 2.0 * c.root_radius() * beam.root_angle;
  ToothContour::Place last{c.root_radius(), beam.root_angle};
  const auto go = [&](const ToothContour::Place& next) {
    const double dy = side * (next.y() - last.y()), width = next.x() + last.x(),
                 y = 0.5 * side * (next.y() + last.y());
    beam.bending += (arm - y) * (arm - y) / (width * width * width) * dy;
    beam.section += dy / width;
    last = next;
  };
  const double from = c.data().pressure_angle, to = ToothContour::kQuarterTurn;
  for (int i = 1; i <= kSteps; ++i) go(c.fillet(to + (from - to) * i / kSteps));
  for (int i = 1; i <= kSteps; ++i) go(c.flank(c.form_length() + (t - c.form_length()) * i / kSteps));
  return beam;
}

double energy_compliance(const Beam& b, const GearMaterial& m) {
  const double c = std::cos(b.angle), s = std::sin(b.angle);
  return (12.0 * c * c * b.bending + (2.4 * (1.0 + m.poisson_ratio) * c * c + s * s) * b.section) /
         m.youngs_modulus;
}

double sainsot_compliance(const Beam& b, const GearMaterial& m, double h) {
  if (!(h >= 1.4 && h <= 7.0)) return kNotGiven;
  const double th = b.root_angle, t2 = 1.0 / (th * th);
  const auto fit = [&](double a, double bb, double c, double d, double e, double f) {
    return a * t2 + bb * h * h + c * h / th + d / th + e * h + f;
  };
  const double l = fit(-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045);
  const double mm = fit(60.111e-5, 28.1e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086);
  const double p = fit(-50.952e-5, 185.5e-3, 0.0538e-4, 53.3e-3, 0.2895, 0.9236);
  const double q = fit(-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904);
  const double ratio = b.arm / b.root_width, c = std::cos(b.angle), tangent = std::tan(b.angle);
  return c * c / m.youngs_modulus * (l * ratio * ratio + mm * ratio + p * (1.0 + q * tangent * tangent));
}

double weber_compliance(const Beam& b, const GearMaterial& m) {
  const double nu = m.poisson_ratio, c = std::cos(b.angle), square = std::pow(std::tan(b.angle), 2);
  const double tooth = 12.0 * b.bending + (2.4 / (1.0 - nu) + square) * b.section,
               ratio = b.arm / b.root_width;
  const double body = 5.2 * ratio * ratio + ratio + 1.4 * (1.0 + 0.294 * square);
  return (1.0 - nu * nu) * c * c / m.youngs_modulus * (tooth + body);
}

}  // namespace

double analytic_pair_stiffness(const GearPair& pair, AnalyticMethod method, double t, double load) {
  std::vector<Finding> findings;
  ParameterCheck check("analytic stiffness", findings);
  check.positive("load", load, "N/m");
  check.within("t", t, std::max(0.0, pair.contour(0).form_length()),
               pair.contour(0).tip_length() * (1.0 + 1e-12), "m");
  const bool linear = method == AnalyticMethod::potential_energy_yang_sun,
             by_energy = linear || method == AnalyticMethod::potential_energy;
  if (by_energy && !pair.geometry().internal)
    for (int i = 0; i < 2; ++i)
      check.positive("gear_" + std::to_string(i + 1) + ".bore_diameter", pair.gear(i).bore_diameter, "m");
  if (!findings.empty()) throw ModelError(std::move(findings));
  if (by_energy && pair.geometry().internal) return kNotGiven;  // Sainsot's body is a disc
  const double t_2 = pair.second_length(t);
  double shape = 0.0, compliance = 0.0;
  for (int i = 0; i < 2; ++i) {
    const GearMaterial& m = pair.gear(i).material;
    shape += (1.0 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
  }
  const double half_width = std::sqrt(4.0 * load * t * t_2 / pair.tangent_length() / kPi * shape);
  for (int i = 0; i < 2; ++i) {
    const GearMaterial& m = pair.gear(i).material;
    const double nu = m.poisson_ratio;
    const Beam beam = beam_of(pair.contour(i), i == 0 ? t : t_2);
    compliance += by_energy
                      ? energy_compliance(beam, m) +
                            sainsot_compliance(
                                beam, m, 2.0 * pair.contour(i).root_radius() / pair.gear(i).bore_diameter)
                      : weber_compliance(beam, m);
    const double contact = linear ? 2.0 : 2.0 * std::log(2.0 * beam.depth / half_width) - nu / (1.0 - nu);
    compliance += (1.0 - nu * nu) / (kPi * m.youngs_modulus) * contact;
  }
  return 1.0 / compliance;
}

IsoStiffness iso_mesh_stiffness(const IsoStiffnessInput& in) {
  constexpr double kLowLoad = 100e3, kUnit = 1e9;  // N/(mm um) in N/m per m
  const double z1 = in.virtual_teeth_1, z2 = in.virtual_teeth_2, x1 = in.profile_shift_1,
               x2 = in.profile_shift_2;
  const double q = 0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1 - 0.00193 * x2 -
                   0.24188 * x2 / z2 + 0.00529 * x1 * x1 + 0.00182 * x2 * x2;
  IsoStiffness c;
  c.theoretical = kUnit / q;
  const double rack =
      (1.0 + 0.5 * (1.2 - in.dedendum)) * (1.0 - 0.02 * (20.0 - in.pressure_angle * 180.0 / kPi));
  c.single = 0.8 * rack * std::cos(in.helix_angle) * c.theoretical;
  if (in.load < kLowLoad) c.single *= std::pow(in.load / kLowLoad, 0.25);
  c.mesh = c.single * (0.75 * in.contact_ratio + 0.25);
  c.crowned = 0.85 * c.mesh;
  if (x1 < x2) c.outside = "x_1 < x_2";
  if (x1 + x2 < -0.5 || x1 + x2 > 2.0)
    c.outside += std::string(c.outside.empty() ? "" : "; ") + "x_1 + x_2 = " + to_text(x1 + x2) +
                 " is not within -0.5 and 2";
  if (std::isinf(z2))
    c.outside += std::string(c.outside.empty() ? "" : "; ") + "of a ring an approximation, z_n2 infinite";
  return c;
}

IsoStiffness iso_mesh_stiffness(const GearPair& pair, double load) {
  const GearGeometry& g = pair.geometry();
  const double scale = std::pow(std::cos(pair.base_helix_angle()), 2) * std::cos(g.helix_angle);
  return iso_mesh_stiffness(
      IsoStiffnessInput{.virtual_teeth_1 = g.gear_1.teeth / scale,
                        .virtual_teeth_2 = g.internal ? INFINITY : g.gear_2.teeth / scale,
                        .profile_shift_1 = g.gear_1.profile_shift,
                        .profile_shift_2 = g.gear_2.profile_shift,
                        .dedendum = g.rack.dedendum,
                        .pressure_angle = g.pressure_angle,
                        .helix_angle = g.helix_angle,
                        .contact_ratio = pair.contact_ratio(),
                        .load = load * std::cos(pair.transverse_angle())});
}

}  // namespace drev
