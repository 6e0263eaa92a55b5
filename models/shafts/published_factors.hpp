#pragma once
/// Published and closed formulas for stepped shafts in torsion, beside which the finite elements of
/// revolved_torsion.hpp stand. All throw ModelError outside their range. Lengths in m.
///
/// Stress concentration K_t: largest over nominal shear stress 16 T/(pi d^3) of the smaller diameter d.

namespace drev {

/// Shoulder D > d with a fillet of radius r: W. D. Pilkey, D. F. Pilkey, Peterson's Stress Concentration Factors, 3rd ed.
/// 2008, and R. G. Budynas, A. M. Sadegh, Roark's Formulas for Stress and Strain, table 17.1:
///
///   K_t = sum_i C_i (2 h/D)^(i-1),  h = (D - d)/2,  C_i = a_i + b_i sqrt(h/r) + c_i h/r
///
/// for 0.25 <= h/r <= 4 alone: beyond it is up to 90 % too high. Within it, 1 to 3 % above finite elements.
double shoulder_factor(double large_diameter, double small_diameter, double fillet_radius);

/// Circumferential groove of depth h and radius r in a shaft of diameter D, on d = D - 2 h: Roark, table 17.1. For
/// 0.25 <= h/r <= 50 and 2 h < D; -6 to +4 % from finite elements.
double groove_factor(double diameter, double depth, double radius);

/// Deep hyperbolic groove of net diameter d and radius r > 0: H. Neuber, Kerbspannungslehre, 2nd ed. 1958:
///
///   K_t = 3 (1 + A)^2/(4 (1 + 2 A)),  A = sqrt(1 + d/(2 r))
double neuber_groove_factor(double net_diameter, double radius);

/// G theta/T of a solid cone between d and D over a length L, by the torsion of thin slices [1/m^3]:
///   32 L/(3 pi (D - d)) (1/d^3 - 1/D^3);  32 L/(pi d^4) where D = d.
double cone_flexibility(double small_diameter, double large_diameter, double length);

/// The same of a cone of half angle a (0 < a < pi/2) between spheres R_1 < R_2 about its tip, exact:
///   (1/R_1^3 - 1/R_2^3)/(6 pi f),  f = 2/3 - cos a + cos^3 a/3.
/// Source: Timoshenko & Goodier, Theory of Elasticity, 3rd ed. 1970, section 119.
double exact_cone_flexibility(double half_angle, double inner_sphere, double outer_sphere);

}  // namespace drev
