#pragma once
/// Geometry of involute spur gears (for helical ones: in the transverse plane). Lengths in m,
/// angles in rad. Source: ISO 21771 and any textbook on gears.
namespace drev {

/// Base radius r_b = m z cos(alpha)/2.
double involute_base_radius(double module, int teeth, double pressure_angle);

/// Transverse contact ratio of an external pair,
///   eps = (sqrt(r_a1^2 - r_b1^2) + sqrt(r_a2^2 - r_b2^2) - a sin(alpha_w))/p_b,
///   cos(alpha_w) = (r_b1 + r_b2)/a,   p_b = 2 pi r_b1/z_1,
/// with tip radii r_a and centre distance a. Throws ModelError for radii that cannot mesh.
struct InvolutePair {
  double base_radius_1 = 0.0, tip_radius_1 = 0.0;  ///< m
  double base_radius_2 = 0.0, tip_radius_2 = 0.0;  ///< m
  double centre_distance = 0.0;                    ///< m
  int teeth_1 = 0;                                 ///< sets the base pitch
};
double involute_contact_ratio(const InvolutePair& pair);

/// The same for an external pair without profile shift, with addendum = `addendum` modules.
double involute_contact_ratio(double module, int teeth_1, int teeth_2, double pressure_angle,
                              double addendum = 1.0);

}  // namespace drev
