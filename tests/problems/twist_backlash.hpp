#pragma once
/// BacklashLaw between two nodes or to ground: k [N m/rad], c [N m s/rad], gap [rad] (or N/m ...).
#include <drev/core/law_element.hpp>
#include <drev/elements/backlash_law.hpp>

struct TwistBacklash {
  drev::BacklashLaw law;
  double stiffness;
  drev::ScalarResponse operator()(const drev::ScalarInput& in) const {
    return law.evaluate(in.x, in.x_dot, {stiffness, 0.0});
  }
  std::span<const double> kinks() const { return law.kinks(); }
  std::optional<drev::Gap> gap() const { return law.gap(); }
  double closed_stiffness() const { return stiffness; }
  std::vector<drev::LawPiece> pieces() const { return law.pieces(stiffness); }
};
