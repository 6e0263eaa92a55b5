#include <drev/core/error.hpp>
#include <drev/core/motion.hpp>

#include <cmath>

namespace drev {

Motion constant_speed(double omega, double phi_0) {
  std::vector<Finding> findings;
  ParameterCheck check("constant_speed", findings);
  check.finite("omega", omega, "rad/s");
  check.finite("phi_0", phi_0, "rad");
  if (!findings.empty()) throw ModelError(findings);
  return {[omega, phi_0](double t) { return MotionPoint{phi_0 + omega * t, omega, 0.0}; }, {}, true};
}

Motion run_up(double omega_0, double omega_1, double time_0, double time_1) {
  std::vector<Finding> findings;
  ParameterCheck check("run_up", findings);
  check.finite("omega_0", omega_0, "rad/s");
  check.finite("omega_1", omega_1, "rad/s");
  check.finite("time_0", time_0, "s");
  if (!(time_1 > time_0) || !std::isfinite(time_1))
    check.fail("time_1", to_text(time_1), "s", "must be greater than time_0 = " + to_text(time_0));
  if (!findings.empty()) throw ModelError(findings);
  const double acceleration = (omega_1 - omega_0) / (time_1 - time_0);
  const auto at = [=](double t) {
    if (t < time_0) return MotionPoint{omega_0 * t, omega_0, 0.0};
    const double s = std::min(t, time_1) - time_0;
    MotionPoint p{omega_0 * (time_0 + s) + 0.5 * acceleration * s * s, omega_0 + acceleration * s,
                  acceleration};
    if (t >= time_1) p = {p.value + omega_1 * (t - time_1), omega_1, 0.0};
    return p;
  };
  return {at, {time_0, time_1}, true};
}

}  // namespace drev
