#pragma once
/// Clutch: two nodes that dry friction joins, with an engagement over time; equation, sign and parameters as
/// dry_friction.hpp says. A stuck clutch turns its nodes as one; an open one (engagement 0) does nothing.
#include <drev/elements/friction/dry_friction.hpp>

namespace drev {

class Clutch final : public DryFriction {
 public:
  using DryFriction::DryFriction;
  std::string_view type() const override { return "clutch"; }
  int min_nodes() const override { return 2; }
};

}  // namespace drev
