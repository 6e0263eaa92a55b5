#pragma once
/// GearDrawing: all that a gear mesh is computed from. The element GearMesh that follows from it: gear_element.hpp.
#include <drev/models/gears/load_law.hpp>
#include <drev/models/gears/tooth_backlash.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev {

struct GearDrawing {
  GearGeometry geometry;
  BacklashTolerances tolerances;
  MeshCycleOptions cycle = {.load = kNotGiven, .points = 50};  ///< load: or by torque_1
  double torque_1 = kNotGiven;       ///< mean torque of gear 1, N m, > 0: w = torque_1/(r_b1 b)
  double backlash_percentile = 0.5;  ///< part of all pairs that have no more backlash, 0 to 1
  /// Forces per width between which the stiffness follows the load, N/m, ascending; empty: that of the mean load.
  std::vector<double> loads = {};
  bool tangent = false;  ///< slope at the mean load in place of the secant: for small vibrations about it
};

/// What a drawing gives: the pair, its cycle under the mean load, its backlash.
struct GearMeshData {
  GearPair pair;
  MeshCycle cycle;
  Backlash backlash;
  std::optional<GearLoadLaw> load_law;  ///< where loads are given
};

/// Throws ModelError naming the dimension that is missing or cannot be; needs width and bores of both gears (of a ring
/// its outer diameter) and exactly
/// one of cycle.load and torque_1. `place`: of the pair, in findings.
GearMeshData gear_mesh_data(const GearDrawing& drawing, const std::string& place = "gear pair");

}  // namespace drev
