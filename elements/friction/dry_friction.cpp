#include <drev/core/element.hpp>
#include <drev/elements/friction/dry_friction.hpp>

#include <cmath>

namespace drev {

DryFriction::DryFriction(Params params) : params_(std::move(params)) {
  const Params& p = params_;
  speeds_ = p.slip_speeds;
  torques_ = p.sliding_torques;
  const double factor = p.normal_force * p.geometry;
  for (const double mu : p.friction_coefficients) torques_.push_back(factor * mu);
  if (!speeds_.empty()) return;
  speeds_ = {0.0};
  torques_ = {std::isnan(p.torque) ? factor * p.friction_coefficient : p.torque};
}

void DryFriction::check(ParameterCheck& check) const {
  const Params& p = params_;
  const bool force = !std::isnan(p.normal_force) || !std::isnan(p.geometry);
  const bool coefficient = !std::isnan(p.friction_coefficient);
  const int given = int(!std::isnan(p.torque)) + int(!p.sliding_torques.empty()) + int(coefficient) +
                    int(!p.friction_coefficients.empty());
  if (given != 1)
    check.fail(
        "torque", given == 0 ? "nothing" : "several", "",
        "exactly one of torque, sliding_torques, friction_coefficient and friction_coefficients must be "
        "given");
  if (!std::isnan(p.torque)) check.non_negative("torque", p.torque, "N m");
  const bool by_coefficient = coefficient || !p.friction_coefficients.empty();
  if (by_coefficient) {
    check.non_negative("normal_force", p.normal_force, "N");
    check.positive("geometry", p.geometry, "m");
  } else if (force) {
    check.fail("normal_force", to_text(p.normal_force), "N", "needs a friction_coefficient");
  }
  if (coefficient) check.non_negative("friction_coefficient", p.friction_coefficient, "");
  const std::size_t points = p.sliding_torques.size() + p.friction_coefficients.size();
  if (points > 0 || !p.slip_speeds.empty()) {
    if (points != p.slip_speeds.size() && given == 1)
      check.fail("slip_speeds", std::to_string(p.slip_speeds.size()) + " points", "",
                 "must be as many as torques or coefficients, " + std::to_string(points));
    check.increasing("slip_speeds", p.slip_speeds, "rad/s");
    if (!p.slip_speeds.empty() && p.slip_speeds.front() != 0.0)
      check.fail("slip_speeds", to_text(p.slip_speeds.front()), "rad/s", "must begin at 0");
    for (const double torque : p.sliding_torques) check.non_negative("sliding_torques", torque, "N m");
    for (const double mu : p.friction_coefficients) check.non_negative("friction_coefficients", mu, "");
  }
  if (!(p.break_away_ratio >= 1.0) || std::isinf(p.break_away_ratio))
    check.fail("break_away_ratio", to_text(p.break_away_ratio), "", "must be finite and >= 1");
  if (p.engagement && p.engagement_formula)
    check.fail("engagement_formula", "given", "",
               "must not be given together with engagement; give one of them");
  if (p.engagement_formula) {
    p.engagement_formula->check(check, "engagement_formula");
    if (const double least = p.engagement_formula->smallest(); least < 0.0)
      check.fail("engagement_formula", to_text(least), "", "must be >= 0 at all times");
  }
  if (!p.engagement) return;
  p.engagement->check(check, "engagement", "");
  for (const double g : p.engagement->values())
    if (g < 0.0) check.fail("engagement", to_text(g), "", "must be >= 0");
}

void DryFriction::describe(int nodes, Terms& terms) const {
  terms.frictions.push_back({.b = relative_motion(nodes), .friction = this});
}

}  // namespace drev
