#pragma once
/// Plane linear elasticity on meshes of nine-node quadrilaterals.
///
///   integral of eps(v)' D eps(u) s dA = integral of v' t s dl,    eps = (du_x/dx, du_y/dy, du_x/dy + du_y/dx)
///
/// D: lambda + 2 mu on the diagonal of the normal strains, lambda off it, mu for shear; plane strain
/// lambda = E nu/((1 + nu)(1 - 2 nu)), plane stress lambda = E nu/(1 - nu^2); mu = E/(2 (1 + nu)). s:
/// thickness relative to the unit of width. Unknowns: u_x and u_y of node n at 2 n and 2 n + 1. Where the
/// solution is smooth, displacements converge with the third power of the cell size, functionals of loads
/// with the fourth.
/// Source: Zienkiewicz & Taylor, The Finite Element Method, vol. 1, 5th ed. 2000, chapter 4.
///
/// FlamantField: the field of a force on the edge of a half-plane. Subtracting it removes the singularity
/// under a concentrated load from the finite-element problem, so that only the smooth remainder is solved
/// for.
///
///   u_r = -(2 P/(pi E')) cos(th) ln(r) - ((1 - nu')P/(pi E')) th sin(th),   sigma_r = -2 P cos(th)/(pi r)
///   u_th = (2 P/(pi E')) sin(th) ln(r) + ((1 + nu')P/(pi E')) sin(th) - ((1 - nu')P/(pi E')) th cos(th)
///
/// th: angle from the direction of the force; plane strain E' = E/(1 - nu^2), nu' = nu/(1 - nu). On the line
/// of the force u_r = -(2 P/(pi E')) ln(r), with r in the mesh's unit of length.
/// Source: Timoshenko & Goodier, Theory of Elasticity, 3rd ed. 1970, articles 36 and 37.
#include <drev/core/system.hpp>

#include <vector>

#include "solvers/fields/quadratic_mesh.hpp"

namespace drev {

struct PlaneMaterial {
  double youngs_modulus = 1.0;  ///< Young's modulus E, > 0
  double poisson_ratio = 0.3;   ///< Poisson's ratio nu [-], 0 <= nu < 0.5
  double thickness = 1.0;       ///< relative thickness s [-], > 0
  bool plane_stress = false;
};

/// The stiffness matrix with both triangles. material: material of each cell, or one for all. Throws
/// SolverError where a cell is inverted (Jacobian <= 0).
SparseMatrix plane_stiffness(const QuadraticMesh& mesh, const std::vector<PlaneMaterial>& material);

class FlamantField {
 public:
  /// Unit force at `origin` in `direction` (a unit vector into the body), E = 1, plane strain.
  FlamantField(PlanePoint origin, PlanePoint direction, double poisson_ratio);

  PlanePoint displacement(PlanePoint at) const;  ///< displacement at a place other than the origin
  PlanePoint traction(PlanePoint at,
                      PlanePoint normal) const;  ///< on a surface with this outward unit normal

 private:
  PlanePoint origin_, direction_;
  double modulus_, poisson_;  // E', nu'
};

}  // namespace drev
