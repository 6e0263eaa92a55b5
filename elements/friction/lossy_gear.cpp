#include <drev/core/element.hpp>
#include <drev/elements/friction/lossy_gear.hpp>

#include <cmath>
#include <utility>

namespace drev {

LossyGear::LossyGear(Params params) : params_(std::move(params)) {
  const Params& p = params_;
  if (p.speeds.empty())
    loss_ = {{0.0},
             {p.efficiency_forward},
             {p.efficiency_backward},
             {p.bearing_torque_forward},
             {p.bearing_torque_backward}};
  else
    loss_ = {p.speeds, p.efficiencies_forward, p.efficiencies_backward, p.bearing_torques_forward,
             p.bearing_torques_backward};
  for (std::vector<double>* none : {&loss_.bearing_forward, &loss_.bearing_backward})
    if (none->empty()) none->assign(loss_.speeds.size(), 0.0);
}

void LossyGear::check(ParameterCheck& check) const {
  const Params& p = params_;
  check.finite("ratio", p.ratio, "");
  if (p.ratio == 0.0) check.fail("ratio", "0", "", "must not be 0");
  const bool table = !p.speeds.empty() || !p.efficiencies_forward.empty();
  if (table && !(std::isnan(p.efficiency_forward) && std::isnan(p.efficiency_backward)))
    check.fail("efficiency_forward", to_text(p.efficiency_forward), "",
               "is given together with a table of losses: give one of them");
  if (table) {
    check.increasing("speeds", p.speeds, "rad/s");
    if (!p.speeds.empty() && p.speeds.front() != 0.0)
      check.fail("speeds", to_text(p.speeds.front()), "rad/s", "must begin at 0");
    bool fit = true;
    for (const auto& [name, values] : {std::pair{"efficiencies_forward", &loss_.forward},
                                       std::pair{"efficiencies_backward", &loss_.backward},
                                       std::pair{"bearing_torques_forward", &loss_.bearing_forward},
                                       std::pair{"bearing_torques_backward", &loss_.bearing_backward}}) {
      if (values->size() == p.speeds.size()) continue;
      fit = false;
      check.fail(name, std::to_string(values->size()) + " points", "",
                 "must be as many as speeds, " + std::to_string(p.speeds.size()));
    }
    if (!fit) return;
  }
  for (std::size_t i = 0; i < loss_.speeds.size(); ++i) {
    const double f = loss_.forward[i], b = loss_.backward[i];
    if (!(f > 0.0 && f <= 1.0)) check.fail("efficiency_forward", to_text(f), "", "must be > 0 and <= 1");
    if (!(b <= 1.0) || std::isinf(b))
      check.fail("efficiency_backward", to_text(b), "", "must be finite and <= 1; <= 0: self-locking");
    check.non_negative("bearing_torque_forward", loss_.bearing_forward[i], "N m");
    check.non_negative("bearing_torque_backward", loss_.bearing_backward[i], "N m");
    const double forward = (1.0 - b) * loss_.bearing_forward[i],
                 backward = (1.0 - f) * b * loss_.bearing_backward[i];
    if (forward + backward < -1e-12 * std::abs(backward))
      check.fail("bearing_torque_backward", to_text(loss_.bearing_backward[i]), "N m",
                 "would make the gear give power where its direction changes: (1 - efficiency_backward) "
                 "bearing_torque_forward + (1 - efficiency_forward) efficiency_backward "
                 "bearing_torque_backward must "
                 "be >= 0");
  }
}

void LossyGear::describe(int nodes, Terms& terms) const {
  LocalRow tie(nodes), shaft_1(nodes);
  tie << 1.0, -1.0 / params_.ratio;
  shaft_1 << 1.0, 0.0;
  terms.speed_ratio_constraints.push_back({tie});
  terms.frictions.push_back({.b = tie, .friction = &tie_});
  terms.frictions.push_back({.b = shaft_1, .friction = this});
}

}  // namespace drev
