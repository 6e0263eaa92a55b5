#pragma once
/// Stiffness of one pair of teeth by the field's analytical methods, for comparison with MeshCycle: each tooth a beam of
/// varying section on a body, plus the contact. They do not know the coupling of pairs through the bodies.
///
///   1/k = sum over both gears (tooth + body) + contact,     per width, along the line of action
///   potential energy: int [M^2/(E I) + 1.2 cos^2(a')/(G A) + sin^2(a')/(E A)] dy, M = cos(a')(y_p - y)
///   Sainsot's body: cos^2(a')/E [L (u/S)^2 + M u/S + P (1 + Q tan^2(a'))]
///   Weber-Banaschek: (1 - nu^2) cos^2(a')/E {12 int (y_p - y)^2/(2x)^3 dy + [2.4/(1 - nu) + tan^2(a')] int dy/(2x)
///     + 5.2 (y_p/s)^2 + y_p/s + 1.4 [1 + 0.294 tan^2(a')]}      (the body's figures for nu = 0.3)
///   contact: sum (1 - nu^2)/(pi E) [2 ln(2 h/a) - nu/(1 - nu)], h = depth to the tooth's middle on the load's line
///   Yang and Sun's contact: sum 2 (1 - nu^2)/(pi E), which does not depend on the load: a third to a quarter of it
///
/// y along the tooth's middle from the root circle, x half its thickness there, true fillet included; the load's line meets
/// the middle at y_p under the angle a'. A ring's tooth is the same beam on its root circle, y inwards; Sainsot's body is a
/// disc, so that potential energy has no value for it. Sources: Yang & Lin, J. Mech. Trans. Autom. Des. 109 (1987) 189-196,
/// doi:10.1115/1.3267437 (potential energy); Yang & Sun, J. Mech. Trans. Autom. Des. 107 (1985) 529-535 (contact); Sainsot, Velex & Duverger, J. Mech. Des. 126 (2004) 748-752,
/// doi:10.1115/1.1758252 (body); Weber & Banaschek, Schriftenreihe Antriebstechnik 11, 1953.
///
/// ISO 6336-1:2006 method B for steel discs: q' = c_1 + c_2/z_n1 + ..., c'_th = 1/q', c' = c'_th C_M C_R C_B cos(beta),
/// c_gamma_alpha = c' (0.75 eps_alpha + 0.25), c_gamma_beta = 0.85 c_gamma_alpha. A ring: approximately, with z_n2 infinite.
#include <drev/models/gears/gear_geometry.hpp>

#include <string>

namespace drev {

enum class AnalyticMethod {
  potential_energy,           ///< with Sainsot's body and the contact above
  potential_energy_yang_sun,  ///< the same with Yang and Sun's contact, as most published curves have it
  weber_banaschek
};

/// One pair alone at t of gear 1 (m) under the force w (N/m), secant, N/m per m of width. Potential energy needs the bores
/// of both gears and throws ModelError without. Sainsot's fit holds for 1.4 <= r_f/r_bore <= 7: outside of it, and for a
/// ring, NaN.
double analytic_pair_stiffness(const GearPair& pair, AnalyticMethod method, double t, double load);

/// What ISO's fit takes.
struct IsoStiffnessInput {
  double virtual_teeth_1 = 0.0, virtual_teeth_2 = 0.0;  ///< z_n = z/(cos^2(beta_b) cos(beta))
  double profile_shift_1 = 0.0, profile_shift_2 = 0.0;
  double dedendum = 1.25;                     ///< h_fP/m_n
  double pressure_angle = 0.349065850398866;  ///< of the rack, normal, rad
  double helix_angle = 0.0;                   ///< rad
  double contact_ratio = 1.0;                 ///< eps_alpha
  /// F_t/b, tangential at the reference circle, N/m; below 100 N/mm c' falls with (F_t/b/(100 N/mm))^0.25.
  double load = 100e3;
};
struct IsoStiffness {
  double theoretical = 0.0;  ///< c'_th, N/m per m
  double single = 0.0;       ///< c'
  double mesh = 0.0;         ///< c_gamma_alpha
  double crowned = 0.0;      ///< c_gamma_beta
  std::string outside;       ///< why the fit does not hold; empty: it does
};
/// Outside the validity (x_1 >= x_2, -0.5 <= x_1 + x_2 <= 2) figures are given all the same, and `outside` says so.
IsoStiffness iso_mesh_stiffness(const IsoStiffnessInput& input);
/// `load`: w along the transverse line of action, as for the other methods; F_t/b = w cos(alpha_t), with a helix too.
IsoStiffness iso_mesh_stiffness(const GearPair& pair, double load);

}  // namespace drev
