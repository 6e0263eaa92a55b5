#pragma once
/// Saint-Venant torsion of a section by finite elements (Prandtl's stress function):
///
///   div grad psi = -2,  psi = 0 on the outside, one value on a hole;   T = G J theta',  tau = G theta' |grad psi|
///   J = 2 int psi dA + 2 psi_hole A_hole
///
/// theta': twist over length. Plane sections may warp; a section that is held against warping is stiffer. The
/// finite elements approach J from below. Source: S. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed. 1970,
/// sections 104 to 115.
#include <drev/solvers/run/estimate.hpp>

#include "models/shafts/section_outline.hpp"

namespace drev {

struct SectionTorsion {
  Estimate constant;     ///< J [m^4], with its error from two meshes
  Estimate peak_stress;  ///< max tau/(G theta') [m]
  PlanePoint peak_at{};  ///< where, on the outline [m]
  double area = 0.0;     ///< A [m^2]
  double polar =
      0.0;  ///< int x^2 + y^2 dA about the axis [m^4]: rho times it is inertia over length. It is not J
  PlanePoint centroid{};  ///< from the axis [m]; NaN of an outline that symmetry repeats
  int unknowns = 0;       ///< of the finest mesh
  /// Torque over largest stress [m^3].
  double modulus() const { return constant.value / peak_stress.value; }
};

/// Refines, halving every cell, until the errors of J and of the peak stress are below accuracy (relative, 1e-7 to 0.1) and ten
/// times that, or the mesh has kLargestSection unknowns: errors then say what is left. Throws ModelError for an outline that
/// is not visible from one point.
SectionTorsion solve_section(const SectionOutline& outline, double accuracy = 1e-4);
inline constexpr int kLargestSection = 200000;

}  // namespace drev
