#include <drev/core/error.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>

#include <algorithm>
#include <map>

#include "solvers/periodic/bracketed_search.hpp"

namespace drev {

namespace {
constexpr double kWidth = 1e-4;  // tolerance of the search relative to its interval [-]
}

SpeedSweep sweep_speeds(const std::function<System(double)>& build, const std::vector<double>& speeds,
                        const PeriodicOptions& options) {
  std::vector<Finding> findings;
  ParameterCheck check("speed sweep", findings);
  check.increasing("speeds", speeds, "");
  if (speeds.empty()) check.fail("speeds", "none", "", "must be at least one");
  if (options.channels.empty()) check.fail("channels", "none", "", "must be at least one");
  if (options.period != 0.0)
    check.fail("period", to_text(options.period), "s", "must be 0: it changes with the speed");
  if (!findings.empty()) throw ModelError(findings);

  SpeedSweep sweep;
  std::map<double, std::vector<double>> amplitudes;  // of all channels by speed; empty: no response
  const auto solve = [&](double speed) {
    PeriodicResponse response = solve_periodic(build(speed), options);
    std::vector<double>& here = amplitudes[speed];
    for (const Peak& peak : response.peaks) here.push_back(peak.amplitude());
    return response;
  };
  for (const double speed : speeds) sweep.curve.push_back({speed, solve(speed)});
  sweep.worst.resize(options.channels.size());
  for (std::size_t c = 0; c < options.channels.size(); ++c) {
    SpeedSweep::Worst& worst = sweep.worst[c];
    const auto at_speed = [&](double speed) {
      if (!amplitudes.contains(speed)) solve(speed);
      const std::vector<double>& here = amplitudes[speed];
      const double amplitude = here.empty() ? 0.0 : here[c];
      if (amplitude > worst.amplitude) worst = {speed, amplitude};
      return amplitude;
    };
    std::size_t top = 0;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      const double before = worst.amplitude;
      if (at_speed(speeds[i]) > before) top = i;
    }
    const double low = speeds[top > 0 ? top - 1 : 0], high = speeds[std::min(top + 1, speeds.size() - 1)];
    if (high > low) bracketed_maximum(low, speeds[top], high, kWidth * (high - low), at_speed);
  }
  return sweep;
}

}  // namespace drev
