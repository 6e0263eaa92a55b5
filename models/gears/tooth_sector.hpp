#pragma once
/// ToothSector: the finite-element mesh of one tooth and its share of the gear's body, 1/z of the whole, in modules.
///
/// Half of it: the tooth between its centre line and the contour from B on the fillet up to the tip; the fillet from B to
/// the middle C of the space over the line D-E; the rim below as rings down to the bore. The other half is its mirror
/// image. A ring's tooth points up all the same: its axis is the origin, its body lies at y < 0. Internal: tooth_compliance.hpp is what computes with it.
#include <drev/models/gears/gear_geometry.hpp>

#include <array>
#include <vector>

#include "solvers/fields/plane_elasticity.hpp"

namespace drev {

struct ToothSector {
  using Edge = std::array<int, 3>;  ///< nodes; the body lies on the left
  QuadraticMesh mesh;
  std::vector<PlaneMaterial> material;  ///< of each cell, E = 1
  std::vector<int> right,
      left;                 ///< nodes on the borders to the next sectors, outside first, without the bore's
  std::vector<int> bore;    ///< nodes that are held: on the bore, of a ring on its outside
  std::vector<Edge> edges;  ///< of the whole border but the bore
  std::vector<Edge> flank;  ///< of the right flank, from the fillet to the tip
  std::vector<double> flank_lengths;  ///< t at their ends, modules; one more than edges; of a ring t falls
};

/// `level` >= 1 halves, thirds ... the cells. Throws ModelError naming the dimension where the body leaves no room.
ToothSector tooth_sector(const GearPair& pair, int gear, int level);

}  // namespace drev
