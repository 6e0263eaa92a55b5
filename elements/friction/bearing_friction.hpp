#pragma once
/// BearingFriction: the drag of a bearing on its node, a table of torques over speed (Stribeck) with a break-away
/// ratio; equation, sign and parameters as dry_friction.hpp says. Source: Modelica BearingFriction (tau_pos, peak).
#include <drev/elements/friction/dry_friction.hpp>

namespace drev {

class BearingFriction final : public DryFriction {
 public:
  using DryFriction::DryFriction;
  std::string_view type() const override { return "bearing friction"; }
  int min_nodes() const override { return 1; }
};

}  // namespace drev
