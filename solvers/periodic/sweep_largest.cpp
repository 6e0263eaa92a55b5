#include <drev/solvers/periodic/linear_sweep.hpp>

#include <cmath>

namespace drev {

namespace {

void take(SweepLargest& largest, double value, double speed) {
  if (value > largest.value || (std::isnan(largest.value) && !std::isnan(value))) largest = {value, speed};
}

/// Of the values at the speeds and of one value of the section's peaks.
SweepLargest largest_of(const LinearSweep& sweep, int section, const Vector& values,
                        double SweepPeak::*at_peak) {
  SweepLargest largest;
  for (std::size_t i = 0; i < sweep.speeds.size() && static_cast<Eigen::Index>(i) < values.size(); ++i)
    take(largest, values[static_cast<Eigen::Index>(i)], sweep.speeds[i]);
  for (const SweepPeak& peak : sweep.peaks)
    if (peak.section == section) take(largest, peak.*at_peak, peak.speed);
  return largest;
}

const SweepSection& section_of(const LinearSweep& sweep, int section) {
  return sweep.sections[static_cast<std::size_t>(section)];
}

}  // namespace

SweepLargest largest_half_range(const LinearSweep& sweep, int section) {
  return largest_of(sweep, section, section_of(sweep, section).half_range(), &SweepPeak::half_range);
}

SweepLargest largest_twist(const LinearSweep& sweep, int section) {
  return largest_of(sweep, section, section_of(sweep, section).twist_half_range,
                    &SweepPeak::twist_half_range);
}

SweepLargest largest_heat(const LinearSweep& sweep, int section) {
  const SweepSection& s = section_of(sweep, section);
  SweepLargest largest = largest_of(sweep, section, s.heat, &SweepPeak::heat);
  for (const SweepPoint& point : sweep.points) take(largest, point.heat[section], point.speed);
  take(largest, s.heat_peak, s.heat_peak_speed);
  return largest;
}

}  // namespace drev
