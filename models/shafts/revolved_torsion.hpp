#pragma once
/// Torsion of a stepped shaft as a body of revolution, by finite elements over its half contour:
///
///   div(r^3 grad theta) = 0,  tau = G r |grad theta|,  T = 2 pi G int r^3 dtheta/dz dr      at any section
///
/// theta: angle by which a ring of the shaft turns, over r and z. Surfaces and bore are free; end faces turn without
/// warping, as in a flange. Finite elements in theta make the shaft too stiff, less so with each refinement. Steps
/// without a fillet have a singular stress: their peak grows with each refinement, their stiffness does not.
/// Source: S. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed. 1970, section 119 (shafts of variable diameter).
#include <drev/solvers/run/estimate.hpp>

#include <vector>

#include "models/shafts/revolved_body.hpp"

namespace drev {

struct RevolvedTorsion {
  Estimate flexibility;         ///< G theta/T of the whole [1/m^3]: a uniform round shaft has 32 L/(pi d^4)
  std::vector<Estimate> spans;  ///< the same between the planes; they add up to the whole
  std::vector<Estimate> peak;   ///< largest tau/T on the surface of each station [1/m^3]
  std::vector<double> peak_at;  ///< z of it [m]
  int unknowns = 0;             ///< of the finest mesh
  double order = 0.0;  ///< at which the flexibility converged over the last three meshes; 0: two meshes only
};

struct RevolvedOptions {
  double accuracy = 1e-3;  ///< relative, of the flexibility (1e-7 to 0.1); peaks are refined to ten times it
  std::vector<bool> judge = {};  ///< stations whose peak is refined; empty: none
  int largest = 400000;          ///< unknowns at most; errors then say what is left
};

/// planes: ascending z strictly between the ends. Stations are taken as sound: see ShaftContour. Throws SolverError where
/// the contour cannot be meshed.
RevolvedTorsion solve_revolved(const std::vector<RevolvedStation>& stations,
                               const std::vector<double>& planes, const RevolvedOptions& options = {});

}  // namespace drev
