#pragma once
/// A load on a row of a series, whose angle turns with the row and with the nominal motion.
#include "solvers/exact/tangent_load.hpp"

namespace drev {

inline PlacedLoad load_on(int row, double angle = 0.0, double coeff = 1.0) {
  PlacedLoad load;
  load.row = row;
  load.coeff = load.turn = coeff;
  load.per_turn = 1.0 / coeff;
  load.ratio = 1.0;
  load.feedback = true;
  load.angle = angle;
  return load;
}

}  // namespace drev
