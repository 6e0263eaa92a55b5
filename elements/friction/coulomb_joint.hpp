#pragma once
/// CoulombJoint: two nodes with dry friction between them that always acts (a slip coupling, a torque limiter);
/// equation, sign and parameters as dry_friction.hpp says.
#include <drev/elements/friction/dry_friction.hpp>

namespace drev {

class CoulombJoint final : public DryFriction {
 public:
  using DryFriction::DryFriction;
  std::string_view type() const override { return "Coulomb joint"; }
  int min_nodes() const override { return 2; }
};

}  // namespace drev
