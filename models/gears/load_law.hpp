#pragma once
/// GearLoadLaw: the force of a mesh over phase AND load as a law that the engine takes without passes.
///
///   f(s, p) = k(s) S(p)          s: mesh phase; p: approach of the gears since they touch, delta - delta_0
///
/// S: straight stretches between the penetrations of the loads asked for, of slope 1 at the mean load; k(s): so that
/// f is the mesh cycle's own force at the mean load's penetration, at every phase. What is neglected: Hertz's contact
/// gives S as p^1.03 to p^1.05 for one pair and less for two, so that the product is right within about a per cent over
/// loads of 1 to 10; pairs that only touch under load (tip relief, contact outside the path) make it worse where
/// they come in. Both are computed, against the cycle's own forces.
#include <drev/models/gears/mesh_cycle.hpp>

#include <vector>

namespace drev {

/// How far a law's forces are from the mesh cycle's over all its phases and the loads between the lowest and the highest,
/// relative to the cycle's.
struct LoadLawError {
  double rms = 0.0, most = 0.0;
};

struct GearLoadLaw {
  std::vector<double> phases,
      stiffness;  ///< k(s), N/m per m of width; of each point of the cycle's first period
  std::vector<double> penetrations,
      slopes;                 ///< of S: slopes[i] from penetrations[i] [m] on, which ascend from 0
  std::vector<double> loads;  ///< N/m, behind the first penetration
  LoadLawError error;         ///< of this law
  LoadLawError constant;      ///< of the cycle's secant at the mean load in its place
};

/// loads: forces per width, ascending, > 0, N/m. Throws ModelError where they are not, or the cycle cannot carry them.
GearLoadLaw gear_load_law(const MeshCycle& cycle, const std::vector<double>& loads);

}  // namespace drev
