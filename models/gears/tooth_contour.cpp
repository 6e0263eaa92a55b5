#include <drev/core/units.hpp>
#include <drev/models/gears/tooth_contour.hpp>

#include <cmath>

namespace drev {

double involute(double angle) { return std::tan(angle) - angle; }

ToothContour::ToothContour(const Data& data) : data_(data), side_(data.ring ? -1.0 : 1.0) {
  const double m = data.module, x = data.profile_shift, z = data.teeth;
  transverse_angle_ = std::atan(std::tan(data.pressure_angle) / std::cos(data.helix_angle));
  pitch_radius_ = 0.5 * m * z / std::cos(data.helix_angle);
  base_radius_ = pitch_radius_ * std::cos(transverse_angle_);
  root_radius_ = pitch_radius_ + side_ * (x - data.rack.dedendum) * m;
  rho_ = data.rack.root_radius * m;
  corner_depth_ = (data.rack.dedendum - data.rack.root_radius) * m;
  corner_xi_ =
      0.25 * kPi * m + corner_depth_ * std::tan(data.pressure_angle) + rho_ / std::cos(data.pressure_angle);
  rack_land_ = 0.5 * kPi * m - corner_xi_;
  form_length_ = base_radius_ * std::tan(transverse_angle_) -
                 (data.rack.dedendum - data.rack.root_radius * (1.0 - std::sin(data.pressure_angle)) - x) *
                     m / std::sin(transverse_angle_);
  const double tip = usable_tip_radius();
  tip_length_ = std::sqrt((tip - base_radius_) * (tip + base_radius_));
  psi_ = (0.5 * kPi + 2.0 * x * std::tan(data.pressure_angle)) / z + side_ * involute(transverse_angle_);
  if (!data.ring) return;
  arc_radius_ = root_radius_ - rho_;
  const double parallel = std::sqrt((arc_radius_ - base_radius_) * (arc_radius_ + base_radius_));
  form_length_ = rho_ + parallel;
  const double tangent_point = psi_ + form_length_ / base_radius_;
  arc_angle_ = tangent_point - std::atan2(parallel, base_radius_);
  arc_from_ = tangent_point - kQuarterTurn;
  rack_land_ = (kPi / z - arc_angle_) * root_radius_;
}

double ToothContour::half_angle(double radius) const {
  return psi_ - side_ * involute(std::acos(std::fmin(1.0, base_radius_ / radius)));
}

double ToothContour::tip_half_angle() const {
  return half_angle(usable_tip_radius()) - data_.chamfer / data_.tip_radius;
}

double ToothContour::Place::x() const { return radius * std::sin(angle); }
double ToothContour::Place::y() const { return radius * std::cos(angle); }

ToothContour::Place ToothContour::flank(double t) const {
  return {std::hypot(base_radius_, t), psi_ - side_ * (t / base_radius_ - std::atan(t / base_radius_))};
}

ToothContour::Corner ToothContour::corner(double u) const {
  if (data_.ring) {
    const double turn = (arc_angle_ - arc_from_) / (kQuarterTurn - data_.pressure_angle);
    const double direction = arc_from_ + turn * (u - data_.pressure_angle);
    Corner p{};
    p.x = arc_radius_ * std::sin(arc_angle_) + rho_ * std::sin(direction);
    p.y = arc_radius_ * std::cos(arc_angle_) + rho_ * std::cos(direction);
    p.dx = rho_ * turn * std::cos(direction);
    p.dy = -rho_ * turn * std::sin(direction);
    return p;
  }
  const double stretch = std::cos(data_.helix_angle), c = std::cos(u), s = std::sin(u);
  const double xi = (corner_xi_ - rho_ * c) / stretch;
  const double eta = data_.profile_shift * data_.module - corner_depth_ - rho_ * s;
  const double slope = stretch * c / s;  // n_xi/n_eta
  Corner p{};
  p.x = eta * slope;
  p.y = pitch_radius_ + eta;
  p.travel = p.x - xi;
  p.dy = -rho_ * c;
  p.dx = p.dy * slope - eta * stretch / (s * s);
  p.dtravel = p.dx - rho_ * s / stretch;
  return p;
}

ToothContour::Place ToothContour::fillet(double u) const {
  const Corner p = corner(u);
  return {std::hypot(p.x, p.y), std::atan2(p.x, p.y) - p.travel / pitch_radius_};
}

/// I_p = integral of R^4/4 over the angle, tooth by tooth.
double ToothContour::polar_moment() const {
  const auto power = [](double t, double base) {
    return (base * base * t * t * t / 3.0 + std::pow(t, 5) / 5.0);
  };
  const double tip = data_.tip_radius, tip_angle = tip_half_angle();
  double half = 0.25 * std::pow(tip, 4) * tip_angle;
  half +=
      0.25 * side_ * (power(tip_length_, base_radius_) - power(form_length_, base_radius_)) / base_radius_;
  if (data_.chamfer > 0.0) {  // a straight line: R^2 is quadratic along it
    const Place from{tip, tip_angle}, to = flank(tip_length_);
    const double cross = from.x() * to.y() - to.x() * from.y();
    const auto square = [&](double s) {
      return std::pow(from.x() + s * (to.x() - from.x()), 2) +
             std::pow(from.y() + s * (to.y() - from.y()), 2);
    };
    half -= 0.25 * cross * (square(0.0) + 4.0 * square(0.5) + square(1.0)) / 6.0;
  }
  // Fillet by Gauss-Legendre with 5 points on 20 stretches.
  static constexpr double kPlaces[] = {0.0, 0.5384693101056831, 0.9061798459386640};
  static constexpr double kWeights[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  constexpr int kStretches = 20;
  const double from = data_.pressure_angle, r = 0.5 * (kQuarterTurn - from) / kStretches;
  for (int i = 0; i < kStretches; ++i) {
    for (int k = -2; k <= 2; ++k) {
      const double u = from + r * (2 * i + 1 + (k < 0 ? -1.0 : 1.0) * kPlaces[std::abs(k)]);
      const Corner p = corner(u);
      const double square = p.x * p.x + p.y * p.y;
      const double angle_slope = (p.dx * p.y - p.x * p.dy) / square - p.dtravel / pitch_radius_;
      half += r * kWeights[std::abs(k)] * 0.25 * square * square * angle_slope;
    }
  }
  half += 0.25 * std::pow(root_radius_, 4) * (kPi / data_.teeth - root_angle());
  return 2.0 * data_.teeth * half;
}

std::vector<std::array<double, 2>> ToothContour::points(int points) const {
  std::vector<std::array<double, 2>> line;
  const auto add = [&](const Place& p) { line.push_back({p.x(), p.y()}); };
  const auto piece = [&](auto place) {
    for (int i = line.empty() ? 0 : 1; i <= points; ++i) add(place(static_cast<double>(i) / points));
  };
  const double tip_angle = tip_half_angle();
  piece([&](double s) { return Place{data_.tip_radius, s * tip_angle}; });
  piece([&](double s) { return flank(tip_length_ + s * (form_length_ - tip_length_)); });
  piece([&](double s) { return fillet(data_.pressure_angle + s * (kQuarterTurn - data_.pressure_angle)); });
  const double from = root_angle(), to = kPi / data_.teeth;
  piece([&](double s) { return Place{root_radius_, from + s * (to - from)}; });
  return line;
}

}  // namespace drev
