#pragma once
/// Plane linear elasticity on meshes of nine-node quadrilaterals.
///
///   integral of eps(v)' D eps(u) s dA = integral of v' t s dl,    eps = (du_x/dx, du_y/dy, du_x/dy + du_y/dx)
///
/// D = lambda + 2 mu on the normal strains' diagonal, lambda beside it, mu for shear; plane strain
/// lambda = E nu/((1 + nu)(1 - 2 nu)), plane stress lambda = E nu/(1 - nu^2); mu = E/(2 (1 + nu)). s: thickness relative to
/// that of the unit of width. Unknowns: u_x and u_y of node n at 2 n and 2 n + 1. The displacement converges with the third
/// power of the cells' size where the solution is smooth, functionals of loads with the fourth.
/// Source: Zienkiewicz & Taylor, The Finite Element Method, vol. 1, 5th ed. 2000, chapter 4.
///
/// FlamantField: a force on the edge of a half-plane, by which the singularity under a concentrated load is taken out of the
/// finite-element problem: only the smooth rest is solved for.
///
///   u_r = -(2 P/(pi E')) cos(th) ln(r) - ((1 - nu')P/(pi E')) th sin(th),   sigma_r = -2 P cos(th)/(pi r)
///   u_th = (2 P/(pi E')) sin(th) ln(r) + ((1 + nu')P/(pi E')) sin(th) - ((1 - nu')P/(pi E')) th cos(th)
///
/// th from the force's direction; plane strain E' = E/(1 - nu^2), nu' = nu/(1 - nu). On the force's own line
/// u_r = -(2 P/(pi E')) ln(r), r in the mesh's unit of length.
/// Source: Timoshenko & Goodier, Theory of Elasticity, 3rd ed. 1970, articles 36 and 37.
#include <drev/core/system.hpp>

#include <vector>

#include "solvers/fields/quadratic_mesh.hpp"

namespace drev {

struct PlaneMaterial {
  double youngs_modulus = 1.0;  ///< E, > 0
  double poisson_ratio = 0.3;   ///< nu, 0 <= nu < 0.5
  double thickness = 1.0;       ///< s, > 0
  bool plane_stress = false;
};

/// The stiffness matrix with both triangles; material[i] of cell i, or one for all. Throws SolverError where a cell
/// turns over.
SparseMatrix plane_stiffness(const QuadraticMesh& mesh, const std::vector<PlaneMaterial>& material);

class FlamantField {
 public:
  /// Unit force at `origin` in `direction` (a unit vector into the body), E = 1, plane strain.
  FlamantField(PlanePoint origin, PlanePoint direction, double poisson_ratio);

  PlanePoint displacement(PlanePoint at) const;  ///< at another place than the origin
  PlanePoint traction(PlanePoint at,
                      PlanePoint normal) const;  ///< on a surface with this outward unit normal

 private:
  PlanePoint origin_, direction_;
  double modulus_, poisson_;  // E', nu'
};

}  // namespace drev
