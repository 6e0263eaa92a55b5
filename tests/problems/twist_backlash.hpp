#pragma once
/// BacklashLaw between two nodes or to ground: k [N m/rad], c [N m s/rad], gap [rad] (or N/m ...).
#include <drev/core/law_element.hpp>
#include <drev/elements/backlash_law.hpp>

struct TwistBacklash {
  drev::BacklashLaw law;
  double stiffness;
  std::vector<drev::LawPiece> pieces() const { return law.pieces(stiffness); }
};
