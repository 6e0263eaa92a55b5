#include <drev/core/error.hpp>
#include <drev/models/gears/tooth_backlash.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace drev {

Backlash::Backlash(const GearPair& pair, const BacklashTolerances& tolerances) {
  std::vector<Finding> findings;
  ParameterCheck check("backlash", findings);
  const auto stop = [&] {
    if (!findings.empty()) throw ModelError(std::move(findings));
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string gear = "gear_" + std::to_string(i + 1);
    if (!(tolerances.thickness[i].upper_allowance <= 0.0))
      check.fail(gear + ".upper_allowance", to_text(tolerances.thickness[i].upper_allowance), "m",
                 "must be <= 0");
    check.finite(gear + ".upper_allowance", tolerances.thickness[i].upper_allowance, "m");
    check.non_negative(gear + ".thickness_tolerance", tolerances.thickness[i].tolerance, "m");
    check.within(gear + ".temperature_rise", tolerances.temperature_rise[i], -300.0, 1000.0, "K");
    check.within(gear + ".expansion", tolerances.expansion[i], 0.0, 1e-3, "1/K");
  }
  check.non_negative("centre_distance_tolerance", tolerances.centre_distance, "m");
  check.within("housing_temperature_rise", tolerances.housing_temperature_rise, -300.0, 1000.0, "K");
  check.within("housing_expansion", tolerances.housing_expansion, 0.0, 1e-3, "1/K");
  stop();
  const double cosine = std::cos(pair.operating_angle());
  // A tooth thinner by A on its reference cylinder frees r_b/r A of the line of action, whatever the centre distance.
  const double thinning = std::cos(pair.transverse_angle()) / std::cos(pair.geometry().helix_angle);
  const double opening = 2.0 * std::sin(pair.operating_angle());
  const double apart = pair.geometry().internal ? -1.0 : 1.0;  // a ring's teeth close as the axes part
  double widening =
      apart * pair.centre_distance() * tolerances.housing_expansion * tolerances.housing_temperature_rise;
  for (std::size_t i = 0; i < 2; ++i) {
    const double working_radius = pair.contour(static_cast<int>(i)).base_radius() / cosine;
    const double side = pair.geometry().internal && i == 1 ? -1.0 : 1.0;
    widening -= side * working_radius * tolerances.expansion[i] * tolerances.temperature_rise[i];
    widths_[i] = tolerances.thickness[i].tolerance * thinning;
    lowest_ -= tolerances.thickness[i].upper_allowance * thinning;
  }
  widths_[2] = 2.0 * tolerances.centre_distance * opening;
  lowest_ += pair.normal_backlash() + opening * widening - 0.5 * widths_[2];
  if (std::abs(lowest_) < 1e-12 * pair.centre_distance()) lowest_ = 0.0;  // rounding
  highest_ = lowest_ + widths_[0] + widths_[1] + widths_[2];
  if (lowest_ < 0.0)
    check.fail("normal_backlash", to_text(lowest_), "m",
               std::string("is the least of what the tolerances allow: the teeth jam; thinner teeth "
                           "(gear_1.upper_allowance, gear_2.upper_allowance) or a ") +
                   (pair.geometry().internal ? "smaller" : "larger") + " centre distance make room");
  stop();
}

/// Sum of independent even distributions of widths c_i: F(x) = sum over subsets S of (-1)^|S| (x - sum_S c)_+^n/(n! prod c).
double Backlash::percentile(double fraction) const {
  std::vector<double> widths;
  for (const double width : widths_)
    if (width > 0.0) widths.push_back(width);
  if (widths.empty() || fraction <= 0.0) return lowest_;
  if (fraction >= 1.0) return highest_;
  const std::size_t n = widths.size();
  const auto below = [&](double x) {
    double sum = 0.0, scale = 1.0;
    for (std::size_t i = 0; i < n; ++i) scale *= widths[i] * static_cast<double>(i + 1);
    for (unsigned set = 0; set < (1U << n); ++set) {
      double rest = x, sign = 1.0;
      for (std::size_t i = 0; i < n; ++i)
        if ((set >> i & 1U) != 0U) rest -= widths[i], sign = -sign;
      if (rest > 0.0) sum += sign * std::pow(rest, static_cast<double>(n));
    }
    return sum / scale;
  };
  double low = 0.0, high = highest_ - lowest_;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (below(middle) < fraction ? low : high) = middle;
  }
  return lowest_ + 0.5 * (low + high);
}

}  // namespace drev
