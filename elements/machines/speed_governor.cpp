#include <drev/core/element.hpp>
#include <drev/elements/machines/speed_governor.hpp>

namespace drev {

void SpeedGovernor::check(ParameterCheck& check) const {
  const Params& p = params_;
  check.non_negative("integral_gain", p.integral_gain, "N m/rad");
  check.non_negative("actuator_lag", p.actuator_lag, "s");
  if (p.actuator_lag > 0.0 && p.integral_gain == 0.0)
    check.fail("actuator_lag", to_text(p.actuator_lag), "s", "needs an integral_gain > 0");
  if (!std::isnan(p.proportional_gain)) {
    check.non_negative("proportional_gain", p.proportional_gain, "N m s/rad");
    if (!std::isnan(p.droop))
      check.fail("droop", to_text(p.droop), "",
                 "must not be given together with proportional_gain; give one of them");
    return;
  }
  if (std::isnan(p.droop)) {
    check.fail("proportional_gain", "", "", "is missing; or give droop, rated_torque and rated_speed");
    return;
  }
  if (!(p.droop > 0.0 && p.droop <= 1.0)) check.fail("droop", to_text(p.droop), "", "must be > 0 and <= 1");
  const auto beside_droop = [&](const char* parameter, double value, const char* unit) {
    if (std::isnan(value))
      check.fail(parameter, "", "", "is missing: droop needs it");
    else
      check.positive(parameter, value, unit);
  };
  beside_droop("rated_torque", p.rated_torque, "N m");
  beside_droop("rated_speed", p.rated_speed, "rad/s");
}

void SpeedGovernor::describe(int nodes, Terms& terms) const {
  const double k_p = proportional_gain(), k_i = params_.integral_gain;
  LocalRow b = LocalRow::Zero(nodes);
  b[0] = 1.0;
  Eigen::MatrixXd damping = k_p * b * b.transpose();
  terms.stiffness(0, 0) = k_i;
  if (params_.actuator_lag > 0.0) add_lag(params_.actuator_lag, k_p, k_i, damping, terms);
  if (k_i > 0.0) terms.speed_ratio_constraints.push_back({.b = b, .holds_deviation = true});
  terms.outputs.push_back({.suffix = "", .stiffness = terms.stiffness.row(0), .damping = damping.row(0)});
  terms.deviation_damping = std::move(damping);
}

void SpeedGovernor::add_lag(double lag, double k_p, double k_i, Eigen::MatrixXd& damping, Terms& terms) {
  const double k = k_p / lag - k_i, pole = (k > 0.0 ? 2.0 : 0.5) / lag;
  const double a_2 = k / lag / (pole - 1.0 / lag), m = k == 0.0 ? 1.0 : (k + a_2) * lag / pole;
  terms.mass(1, 1) = m;
  damping(0, 0) = 0.0;
  damping(0, 1) = damping(1, 0) = -std::sqrt(a_2 * m);
  damping(1, 1) = m * (1.0 / lag + pole);
  terms.stiffness(0, 0) = k_p / lag + a_2;
  terms.stiffness(0, 1) = terms.stiffness(1, 0) = k == 0.0 ? 0.0 : -m * pole / lag;
  terms.stiffness(1, 1) = m * pole / lag;
  LocalRow alone = LocalRow::Zero(terms.mass.rows());
  alone[1] = 1.0;
  terms.speed_ratio_constraints.push_back({.b = alone});
}

}  // namespace drev
