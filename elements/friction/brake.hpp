#pragma once
/// Brake: a node that dry friction holds to ground, with an engagement over time; equation, sign and parameters as
/// dry_friction.hpp says.
#include <drev/elements/friction/dry_friction.hpp>

namespace drev {

class Brake final : public DryFriction {
 public:
  using DryFriction::DryFriction;
  std::string_view type() const override { return "brake"; }
  int min_nodes() const override { return 1; }
};

}  // namespace drev
