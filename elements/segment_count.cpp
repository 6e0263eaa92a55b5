#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/distributed_shaft.hpp>
#include <drev/elements/segment_count.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

double torsional_wave_speed(double shear_modulus, double density) {
  return std::sqrt(shear_modulus / density);
}

double segment_frequency_error(SegmentMass mass, double theta, double ends) {
  if (theta == 0.0) return 0.0;
  const double of_ends = ends * theta * theta / 24.0;
  // 1 - cos theta = 2 sin^2(theta/2)
  const double lumped = 2.0 * std::sin(0.5 * theta) / theta;
  switch (mass) {
    case SegmentMass::lumped:
      return lumped - 1.0 - of_ends;
    case SegmentMass::consistent:
      return lumped * std::sqrt(3.0 / (2.0 + std::cos(theta))) - 1.0 - of_ends;
    case SegmentMass::averaged:
      return lumped * std::sqrt(6.0 / (5.0 + std::cos(theta))) - 1.0 - of_ends;
  }
  return 0.0;
}

int segments_for(double length, double wave_speed, double accuracy, double up_to_Hz, SegmentMass mass,
                 double ends) {
  std::vector<Finding> findings;
  ParameterCheck check("segments_for", findings);
  check.positive("length", length, "m");
  check.positive("wave_speed", wave_speed, "m/s");
  check.within("accuracy", accuracy, 1e-12, 0.1, "");
  check.positive("up_to_Hz", up_to_Hz, "Hz");
  check.within("ends", ends, 0.0, 1.0, "");
  if (!findings.empty()) throw ModelError(findings);
  const double phase = hz(up_to_Hz) * length / wave_speed;  // phase of a wave along the whole shaft [rad]
  const auto enough = [&](double n) {
    const double theta = phase / n;
    return theta <= kPi && std::abs(segment_frequency_error(mass, theta)) <= accuracy &&
           std::abs(segment_frequency_error(mass, theta, ends)) <= accuracy;
  };
  // |error| grows with theta up to pi: bisection between too few and enough.
  double few = 0.0, many = 1.0;
  while (!enough(many)) {
    few = many;
    many *= 2.0;
    if (few > DistributedShaft::kMaxSegments) break;
  }
  while (many - few > 1.0) {
    const double middle = std::floor(0.5 * (few + many));
    (enough(middle) ? many : few) = middle;
  }
  if (many > DistributedShaft::kMaxSegments)
    check.fail("segments", to_text(many), "",
               "must be at most " + std::to_string(DistributedShaft::kMaxSegments) +
                   ": ask for a larger accuracy or a lower frequency");
  if (!findings.empty()) throw ModelError(findings);
  return static_cast<int>(many);
}

}  // namespace drev
