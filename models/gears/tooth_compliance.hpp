#pragma once
/// ToothCompliance: how much the loaded flank of a gear gives way, by plane finite elements of the whole gear.
///
///   E q(t) = g(t) + (1 - nu^2)/pi [2 ln(2 m_n/a) - nu/(1 - nu)]       own flank, per force and width
///   E q_d(t, t') = displacement at t' on the tooth d further on by a unit force at t
///
/// along the line of action, t = length of the tangent to the base circle. g: the part that does not depend on the load,
/// found without the singularity under the force (solvers/fields/plane_elasticity.hpp: what a half-plane does is known,
/// the smooth rest is solved for); a: half width of the Hertzian contact. Body: all z teeth with their fillets on the rim,
/// web and hub, plane strain (a web: plane stress of its own thickness), held at the bore: windup of the disc is in it.
/// One tooth's sector is meshed and factored once; the ring of z sectors is joined through their borders by condensation
/// (doubling), and the compliance by forces at any place is interpolated between Chebyshev places.
///
/// A ring is held at its outside. Its teeth follow in the other sense: t falls towards the other border.
///
/// Limits: rigid shaft in the bore, no friction; the half-plane of the contact is cut off within about 0.1 m_n of the tip
/// (3 % there). Figures of two levels give the error (mesh_cycle.hpp): halving the cells divides it by four to ten, since
/// what a curved flank leaves under the force behaves as r^2 ln(r).
/// Sources: Weber & Banaschek 1953 (separation of the contact); Vijayakar, Int. J. Numer. Meth. Eng. 31 (1991) 525-545,
/// doi:10.1002/nme.1620310308 (finite elements with a surface integral under the load); the formulas in docs/gears.md.
#include <drev/models/gears/gear_geometry.hpp>

#include <array>
#include <vector>

namespace drev {

class ToothCompliance {
 public:
  static constexpr int kNeighbours = 3;  ///< most teeth further on that are coupled
  /// For contacts with low <= t <= high [m]; level >= 1: of the mesh. Throws ModelError where the gear's drawing lacks
  /// what is needed (bore_diameter, of a ring outer_diameter) or leaves no room for a mesh.
  ToothCompliance(const GearPair& pair, int gear, double low, double high, int level = kLevel);

  double own(double t) const;  ///< g, without unit; t in m
  /// E q_d, 0 < d, of the tooth d further on in the sense in which t falls by one base pitch a tooth; 0 further on than
  /// the contact ratio reaches.
  double coupling(int d, double t_load, double t_response) const;
  int unknowns() const { return unknowns_; }
  static constexpr int kLevel = 2;

  /// g at one place and mesh, for convergence studies.
  static double own_at(const GearPair& pair, int gear, double t, int level);

 private:
  std::vector<double> weights_at(double t) const;

  double low_, high_;
  std::vector<double> own_;                                // at the Chebyshev places
  std::array<std::vector<double>, kNeighbours> coupling_;  // [d - 1][load * places + response]
  int neighbours_ = 0, unknowns_ = 0;
};

}  // namespace drev
