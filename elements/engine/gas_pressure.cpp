#include <drev/elements/engine/gas_pressure.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace drev {

namespace {

constexpr double kJump = 1e-9;            // of the period: over which a curve that does not close jumps
constexpr double kAtmosphere = 101325.0;  // Pa

PeriodicCurve make_curve(std::vector<double> angle, std::vector<double> value, double period,
                         Interpolation interpolation) {
  if (angle.size() >= 3 && std::abs(angle.back() - angle.front() - period) <= 1e-12 * period) {
    if (value.back() == value.front())
      angle.pop_back(), value.pop_back();
    else if (interpolation == Interpolation::linear)
      angle.back() = angle.front() + period * (1.0 - kJump);
  }
  return {PeriodicTable(std::move(angle), std::move(value), period), interpolation};
}

}  // namespace

GasPressure::GasPressure(Params params, double period) : params_(std::move(params)), period_(period) {
  const Params& p = params_;
  const std::size_t n = p.angle.size();
  const std::vector<double>& parameter = p.speed.empty() ? p.load : p.speed;
  sizes_fit_ = p.pressure.size() == n && (parameter.empty() || parameter.size() == n);
  if (n == 0 || !sizes_fit_) return;  // check() says so
  std::vector<PeriodicCurve> curves;
  std::vector<double> values;
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    while (end < n && (parameter.empty() || parameter[end] == parameter[begin])) ++end;
    const auto part = [&](const std::vector<double>& all) {
      return std::vector<double>(all.begin() + static_cast<std::ptrdiff_t>(begin),
                                 all.begin() + static_cast<std::ptrdiff_t>(end));
    };
    curves.push_back(make_curve(part(p.angle), part(p.pressure), period, p.interpolation));
    values.push_back(parameter.empty() ? 0.0 : parameter[begin]);
  }
  curves_ = CurveFamily(std::move(curves), std::move(values));
  reference_ = std::isnan(p.reference_pressure) ? *std::max_element(p.pressure.begin(), p.pressure.end())
                                                : p.reference_pressure;
  bends_ = p.peak_speed;
  if (!p.speed.empty()) bends_.insert(bends_.end(), curves_.parameters().begin(), curves_.parameters().end());
  const SpeedGate& gate = p.firing;
  for (const double bend :
       {gate.from_speed, gate.from_speed + gate.speed_ramp, gate.to_speed - gate.speed_ramp, gate.to_speed})
    if (!std::isnan(bend)) bends_.push_back(bend);
  std::sort(bends_.begin(), bends_.end());
  bends_.erase(std::unique(bends_.begin(), bends_.end()), bends_.end());
}

double GasPressure::mirrored(double& angle, bool misfires) const {
  if (!misfires) return 1.0;
  const double behind = angle - period_ * std::floor(angle / period_);
  if (behind >= 0.5 * period_) return 1.0;
  angle = -behind;
  return -1.0;
}

GasPressure::Scale GasPressure::peak_scale(double size) const {
  const std::vector<double>&at = params_.peak_speed, &peak = params_.peak_pressure;
  if (at.empty()) return {};
  if (size <= at.front()) return {peak.front() / reference_, 0.0};
  if (size >= at.back()) return {peak.back() / reference_, 0.0};
  const auto i = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), size) - at.begin());
  const double slope = (peak[i] - peak[i - 1]) / (at[i] - at[i - 1]);
  return {(peak[i - 1] + slope * (size - at[i - 1])) / reference_, slope / reference_};
}

GasPressure::Point GasPressure::at(double angle, double speed, bool misfires) const {
  if (misfires || !params_.firing.gated()) return ungated(angle, speed, misfires);
  const CurvePoint part = params_.firing.at(std::abs(speed));
  const Point fired = ungated(angle, speed, false), compressed = ungated(angle, speed, true);
  const auto mixed = [&](double a, double b) { return b + part.value * (a - b); };
  return {mixed(fired.pressure, compressed.pressure), mixed(fired.angle_slope, compressed.angle_slope),
          mixed(fired.speed_slope, compressed.speed_slope) +
              (speed < 0.0 ? -part.slope : part.slope) * (fired.pressure - compressed.pressure)};
}

GasPressure::Point GasPressure::ungated(double angle, double speed, bool misfires) const {
  const double side = mirrored(angle, misfires), direction = speed < 0.0 ? -1.0 : 1.0, size = std::abs(speed);
  const bool by_speed = !params_.speed.empty();
  const CurveFamily::Point c = curves_.at(angle + params_.firing_tdc, by_speed ? size : params_.at_load);
  const Scale scale = peak_scale(size);
  const double by_size = (by_speed ? c.parameter_slope * scale.factor : 0.0) + c.value * scale.slope;
  return {c.value * scale.factor, side * c.slope * scale.factor, direction * by_size};
}

std::vector<double> GasPressure::factors(double speed) const {
  std::vector<double> parts = ungated_factors(std::abs(speed));
  if (!params_.firing.gated()) return parts;
  const std::size_t curves = parts.size();
  const double fires = firing_part(std::abs(speed));
  for (std::size_t k = 0; k < curves; ++k) {
    parts.push_back((1.0 - fires) * parts[k]);
    parts[k] *= fires;
  }
  return parts;
}

std::vector<double> GasPressure::ungated_factors(double size) const {
  const std::vector<double>& at = curves_.parameters();
  std::vector<double> parts(curves_.curves().size(), 0.0);
  const double parameter = params_.speed.empty() ? params_.at_load : size;
  if (parts.size() == 1 || parameter <= at.front()) {
    parts.front() = 1.0;
  } else if (parameter >= at.back()) {
    parts.back() = 1.0;
  } else {
    const auto i = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), parameter) - at.begin());
    parts[i] = (parameter - at[i - 1]) / (at[i] - at[i - 1]);
    parts[i - 1] = 1.0 - parts[i];
  }
  for (double& part : parts) part *= peak_scale(size).factor;
  return parts;
}

double GasPressure::curve(int k, double angle, bool misfires) const {
  const auto curves = static_cast<int>(curves_.curves().size());
  mirrored(angle, misfires || k >= curves);
  return curves_.curves()[static_cast<std::size_t>(k % curves)].at(angle + params_.firing_tdc).value;
}

CubicPiece GasPressure::piece(double angle, double direction, double speed, bool misfires) const {
  std::vector<double> parts = ungated_factors(std::abs(speed));
  if (misfires || !params_.firing.gated()) return ungated_piece(angle, direction, parts, misfires);
  const double fires = firing_part(std::abs(speed));
  std::vector<double> rest = parts;
  for (double& part : parts) part *= fires;
  for (double& part : rest) part *= 1.0 - fires;
  CubicPiece sum = ungated_piece(angle, direction, parts, false);
  const CubicPiece compressed = ungated_piece(angle, direction, rest, true);
  sum.low = std::max(sum.low, compressed.low);
  sum.high = std::min(sum.high, compressed.high);
  for (std::size_t j = 0; j < sum.terms.size(); ++j) sum.terms[j] += compressed.terms[j];
  return sum;
}

CubicPiece GasPressure::ungated_piece(double angle, double direction, const std::vector<double>& parts,
                                      bool misfires) const {
  constexpr double kOnKnot = 1e-13;  // distance from a knot over the angle, or over 1 rad
  const bool up = direction > 0.0;
  double side = 1.0, at = angle;
  CubicPiece sum;
  if (misfires) {
    // The curve is entered backwards in the half of a period behind the firing dead centre.
    const double half = 0.5 * period_, near = kOnKnot * std::max(1.0, std::abs(angle));
    double behind = angle - period_ * std::floor(angle / period_);
    if (up && period_ - behind <= near) behind -= period_;
    if (!up && behind <= near) behind += period_;
    const bool backwards = up ? behind < half - near : behind <= half + near;
    sum.low = angle - (backwards ? behind : behind - half);
    sum.high = angle + ((backwards ? half : period_) - behind);
    if (backwards) side = -1.0, at = -behind;
  }
  // Of curves that have no part at this speed too: knots do not follow the speed.
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double entered = at + params_.firing_tdc;
    const CubicPiece c = curves_.curves()[k].piece(entered, side * direction);
    const double below = entered - c.low, above = c.high - entered;
    sum.low = std::max(sum.low, angle - (side > 0.0 ? below : above));
    sum.high = std::min(sum.high, angle + (side > 0.0 ? above : below));
    double factor = parts[k];
    for (std::size_t j = 0; j < c.terms.size(); ++j, factor *= side) sum.terms[j] += factor * c.terms[j];
  }
  return sum;
}

double GasPressure::steepest_by_speed(const Interval& angle, const Interval& size, bool misfires) const {
  double most = 0.0;
  for (std::size_t i = 1; i < bends_.size(); ++i) {
    const double a = bends_[i - 1], b = bends_[i];
    if (b < size.low || a > size.high) continue;
    const auto parts_at = [&](double x) { return misfires ? ungated_factors(x) : factors(x); };
    const std::vector<double> first = parts_at(a), middle = parts_at(0.5 * (a + b)), last = parts_at(b);
    for (const double x : {std::max(a, size.low), std::min(b, size.high)}) {
      const double u = (x - a) / (b - a);
      std::vector<double> slopes(first.size());
      for (std::size_t k = 0; k < slopes.size(); ++k)
        slopes[k] =
            ((4.0 * u - 3.0) * first[k] + (4.0 - 8.0 * u) * middle[k] + (4.0 * u - 1.0) * last[k]) / (b - a);
      most = std::max(most, largest(angle, slopes, misfires));
    }
  }
  return most;
}

/// The largest size of the curves with these parts over a range of the angle; parts as of factors().
double GasPressure::largest(const Interval& angle, const std::vector<double>& parts, bool misfires) const {
  const auto curves = static_cast<std::ptrdiff_t>(curves_.curves().size());
  const std::vector<double> fired(parts.begin(), parts.begin() + curves),
      compressed(parts.begin() + curves, parts.end());
  const double end = std::min(angle.high, angle.low + period_);
  double most = 0.0;
  double at = angle.low, high = at;
  do {
    CubicPiece piece = ungated_piece(at, 1.0, fired, misfires);
    high = piece.high;
    if (!compressed.empty()) {
      const CubicPiece other = ungated_piece(at, 1.0, compressed, true);
      high = std::min(high, other.high);
      for (std::size_t j = 0; j < piece.terms.size(); ++j) piece.terms[j] += other.terms[j];
    }
    const double reach = std::max(0.0, std::min(high, end) - at);
    double bound = 0.0;
    for (std::size_t j = piece.terms.size(); j-- > 0;) bound = bound * reach + std::abs(piece.terms[j]);
    most = std::max(most, bound);
  } while (high > std::exchange(at, high) && at < end);
  return most;
}

void GasPressure::check(ParameterCheck& check) const {
  const Params& p = params_;
  if (!sizes_fit_)
    check.fail("pressure", std::to_string(p.pressure.size()) + " pressures", "",
               "must be as many as the angles, " + std::to_string(p.angle.size()) +
                   ", and as the speeds or loads where there are any");
  if (!p.speed.empty() && !p.load.empty())
    check.fail("pressure", "speed and load", "",
               "curves are given over the speed or over the load, not both");
  if (!p.peak_speed.empty() && !p.speed.empty())
    check.fail("peak_pressure", "given", "", "must not be given together with curves over the speed");
  check.all_finite("pressure.pressure", p.pressure, "Pa");
  for (const double pressure : p.pressure)
    if (pressure < -kAtmosphere) {
      check.fail(
          "pressure.pressure", to_text(pressure), "Pa",
          "must be >= -101325, the atmosphere: pressures are absolute, or above that of the crankcase");
      break;
    }
  check.finite("firing_tdc", p.firing_tdc, "rad");
  check.finite("load", p.at_load, "");
  if (!std::isnan(p.reference_pressure)) check.positive("reference_pressure", p.reference_pressure, "Pa");
  p.firing.check(check);
  if (sizes_fit_ && !curves_.curves().empty()) {
    check.increasing(p.speed.empty() ? "pressure.load" : "pressure.speed", curves_.parameters(), "");
    for (const PeriodicCurve& curve : curves_.curves()) curve.check(check, "pressure", "rad", "Pa");
    if (!p.peak_speed.empty() && std::isnan(p.reference_pressure) && !(reference_ > 0.0))
      check.fail("pressure", to_text(reference_), "Pa",
                 "the largest pressure must be > 0: it is the reference of peak_pressure");
  }
  check.increasing("peak_pressure.speed", p.peak_speed, "rad/s");
  check.all_finite("peak_pressure.pressure", p.peak_pressure, "Pa");
  if (p.peak_speed.size() != p.peak_pressure.size())
    check.fail("peak_pressure", std::to_string(p.peak_pressure.size()) + " pressures", "",
               "must be as many as the speeds, " + std::to_string(p.peak_speed.size()));
}

}  // namespace drev
