#pragma once
/// GearGeometry: a gear pair as its drawing gives it. GearPair: what follows from it, in the transverse section.
///
///   tan(alpha_t) = tan(alpha_n)/cos(beta), m_t = m_n/cos(beta)      r = m_t z/2, r_b = r cos(alpha_t)
///   inv(alpha_w) = inv(alpha_t) + 2 tan(alpha_n) (x_1 + x_2)/(z_1 + z_2)       without backlash
///   a = (z_1 + z_2) m_t cos(alpha_t)/(2 cos(alpha_w)),   p_b = pi m_t cos(alpha_t),   T = a sin(alpha_w)
///   t_A = T - sqrt(r_a2^2 - r_b2^2),  t_E = sqrt(r_a1^2 - r_b1^2),  eps_alpha = (t_E - t_A)/p_b
///   eps_beta = b tan(beta_b)/p_b,   j_wt = 2 pi r_w1/z_1 - s_w1 - s_w2,   j_bn = j_wt cos(alpha_w)
///
/// t: distance of a contact from the point where the line of action touches base circle 1. An internal pair has its ring
/// as gear 2: z_2 enters as -z_2 (ISO 21771), shifts with ISO's signs, T + t_1 = t_2, t_A = sqrt(r_a2^2 - r_b2^2) - T.
///
/// Refused, each by the dimension that is wrong: undercut (t_F < 0), pointed teeth, tips that run into fillets
/// (t_A < t_F1, T - t_E < t_F2; ring: T + t_E > t_F2) or roots, contact ratios below 1, a centre distance that jams the
/// teeth, tips of a ring and its pinion that meet outside the path of contact:
///
///   (z_1/z_2) (xi_1 + inv(alpha_a1) - inv(alpha_w)) + inv(alpha_w) - inv(alpha_a2) >= xi_2
///   cos(xi_1) = (r_a2^2 - r_a1^2 - a^2)/(2 a r_a1),   cos(xi_2) = (r_a2^2 - r_a1^2 + a^2)/(2 a r_a2)
///
/// Source: ISO 21771:2007; Litvin & Fuentes, Gear Geometry and Applied Theory, 2nd ed. 2004, chapter 11 (tips).
#include <drev/elements/not_given.hpp>
#include <drev/models/gears/tooth_contour.hpp>

#include <string>

namespace drev {

/// Linear elastic, isotropic.
struct GearMaterial {
  double youngs_modulus = 210e9;  ///< E, Pa, > 0
  double poisson_ratio = 0.3;     ///< nu, 0 <= nu < 0.5
  double density = 7850.0;        ///< rho, kg/m^3, > 0
};

/// One gear of a pair.
struct GearData {
  int teeth = 0;  ///< z
  double profile_shift =
      kNotGiven;  ///< x, in modules; not given: of gear 1 0, of gear 2 from the centre distance
  double tip_diameter = kNotGiven;        ///< d_a, m; not given: m (z + 2 x + 2 h_aP + 2 k)
  double tip_alteration = 0.0;            ///< k, in modules; < 0 shortens the tip
  double tip_chamfer = 0.0;               ///< radial height of a chamfer of 45 degrees, m, >= 0
  double width = kNotGiven;               ///< b, m, > 0
  double bore_diameter = kNotGiven;       ///< where the body is held, m; 0: solid (inertia alone)
  double outer_diameter = kNotGiven;      ///< of a ring: its outside, where it is held, m
  double rim_inner_diameter = kNotGiven;  ///< web from here, m
  double hub_diameter = kNotGiven;        ///< to here, m
  double web_thickness = kNotGiven;       ///< m, > 0, <= width
  GearMaterial material = {};
};

struct GearGeometry {
  double module = kNotGiven;                   ///< m_n, normal, m
  double pressure_angle = 0.3490658503988659;  ///< alpha_n, rad; 20 degrees
  double helix_angle = 0.0;                    ///< beta at the pitch circle, rad, 0 <= beta < 45 degrees
  double centre_distance = kNotGiven;          ///< a, m; not given: without backlash
  bool internal = false;                       ///< gear 2 is a ring
  RackProfile rack = {};
  GearData gear_1 = {}, gear_2 = {};
};

class GearPair {
 public:
  /// Throws ModelError with all that cannot be; `place` names the pair in it.
  explicit GearPair(GearGeometry geometry, const std::string& place = "gear pair");

  const GearGeometry& geometry() const { return geometry_; }  ///< with shifts and tip diameters filled in
  const ToothContour& contour(int gear) const { return gear == 0 ? contour_1_ : contour_2_; }
  const GearData& gear(int gear) const { return gear == 0 ? geometry_.gear_1 : geometry_.gear_2; }
  double centre_distance() const { return geometry_.centre_distance; }       ///< a, m
  double zero_backlash_distance() const { return zero_backlash_distance_; }  ///< m
  double transverse_angle() const { return contour_1_.transverse_angle(); }  ///< alpha_t, rad
  double operating_angle() const { return operating_angle_; }                ///< alpha_wt, rad
  double base_helix_angle() const { return base_helix_; }                    ///< beta_b, rad
  double base_pitch() const { return base_pitch_; }                          ///< p_b, transverse, m
  double tangent_length() const { return tangent_; }                         ///< T, m
  double start_of_contact() const { return start_; }                         ///< t_A, m
  double end_of_contact() const { return end_; }                             ///< t_E, m
  double pitch_point() const { return contour_1_.base_radius() * tangent_ / base_sum_; }  ///< t_C, m
  double contact_ratio() const { return (end_ - start_) / base_pitch_; }                  ///< eps_alpha
  double overlap_ratio() const { return overlap_; }                                       ///< eps_beta
  double face_width() const { return width_; }  ///< common width b, m
  /// Length of the second gear's tangent at the contact t of the first, m.
  double second_length(double t) const { return geometry_.internal ? tangent_ + t : tangent_ - t; }
  /// Contact ratio that the involute flanks allow, whatever the tips: (T - t_F2 - t_F1)/p_b; ring (t_F2 - T - t_F1)/p_b.
  double flank_contact_ratio() const;
  /// Play on the working pitch circle, transverse, that the centre distance and the shifts leave, m.
  double circumferential_backlash() const { return play_; }
  double normal_backlash() const;  ///< the same along the transverse line of action, m
  bool is_ring(int gear) const { return geometry_.internal && gear == 1; }
  /// Radius where a gear's body is held: bore, of a ring its outside; m.
  double held_radius(int gear_number) const {
    return 0.5 * (is_ring(gear_number) ? gear(gear_number).outer_diameter : gear(gear_number).bore_diameter);
  }
  /// Moment of inertia of a gear with its teeth, rim, web, hub and bore, kg m^2.
  double inertia(int gear) const;

 private:
  void check_numbers(class ParameterCheck& check) const;
  void find_shifts(class ParameterCheck& check);
  void check_teeth(class ParameterCheck& check) const;
  void check_tooth(class ParameterCheck& check, int gear) const;
  void check_tips(class ParameterCheck& check) const;
  void check_ring(class ParameterCheck& check) const;

  GearGeometry geometry_;
  ToothContour contour_1_, contour_2_;
  double zero_backlash_distance_ = 0.0, operating_angle_ = 0.0, base_helix_ = 0.0, base_pitch_ = 0.0,
         tangent_ = 0.0;
  double start_ = 0.0, end_ = 0.0, overlap_ = 0.0, width_ = 0.0, play_ = 0.0, base_sum_ = 0.0;
};

/// Angle of an involute function, inv(a) = tan(a) - a = value, value >= 0.
double inverse_involute(double value);

}  // namespace drev
