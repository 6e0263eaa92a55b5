#pragma once
/// Torsional vibration of a whole shaft as a body of revolution, as one sparse system: the reference for lumped models.
///
///   K x = omega^2 M x,  K_ij = 2 pi G int r^3 grad N_i . grad N_j dr dz,  M_ij = 2 pi rho int r^3 N_i N_j dr dz
///
/// Both ends free. Unlike chains of segments it has the sections' warping in the meridian plane, steps and collars as they are,
/// and their inertia where it is. Internal: for comparisons.
#include <drev/core/system.hpp>
#include <drev/models/shafts/shaft_contour.hpp>

#include <vector>

namespace drev {

struct WholeShaft {
  SparseMatrix stiffness;   ///< K [N m/rad]
  Vector mass;              ///< M [kg m^2] on the pattern of K
  double wave_speed = 0.0;  ///< sqrt(G/rho) [m/s]
  double length = 0.0;      ///< [m]
};

/// halvings: how often the cells of the first mesh are halved, 0 to 8; each makes four times as many unknowns. Cams, splines
/// and keyways are as in shaft_sections(). Throws ModelError for contours that cannot be.
WholeShaft whole_shaft(const ShaftContour& contour, int halvings);

struct WholeShaftModes {
  std::vector<double> frequency_Hz;  ///< elastic modes, ascending
  int unknowns = 0, solves = 0;
};
/// The lowest `count` elastic modes by shift-invert Lanczos (solvers/modes) on a Cholesky factor of K - sigma M, sigma < 0 of
/// the size of the first omega^2. Throws SolverError where it fails.
WholeShaftModes whole_shaft_modes(const WholeShaft& shaft, int count);
/// The shift that they take [(rad/s)^2].
double whole_shaft_shift(const WholeShaft& shaft);

}  // namespace drev
