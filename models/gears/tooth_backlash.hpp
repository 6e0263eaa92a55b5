#pragma once
/// Backlash of a gear pair from tolerances of tooth thickness and centre distance, at working temperature.
///
///   j_bn = play + cos(alpha_t)/cos(beta) sum over both gears (-A_s) + 2 sin(alpha_wt) (da + th)
///   th   = a alpha_h dT_h - r_w1 alpha_1 dT_1 - r_w2 alpha_2 dT_2,   A_sne - T_sn <= A_s <= A_sne,   -A_a <= da <= A_a
///   ring: th = -a alpha_h dT_h - r_w1 alpha_1 dT_1 + r_w2 alpha_2 dT_2
///
/// play: what centre distance and shifts leave without tolerances (GearPair). A_s: deviation of the normal tooth thickness
/// on the reference cylinder from its value without backlash, negative where the tooth is thinner. Widening by temperature:
/// to first order.
/// Percentiles: the two thicknesses and the centre distance are independent and evenly distributed over their ranges.
/// Allowances and tolerances by class (e.g. DIN 3967:1978, centre distances DIN 3964:1980) are entered as numbers: the tables
/// of the standards are under copyright. Source: DIN 3967:1978 (relations); ISO/TR 10064-2:1996.
#include <drev/models/gears/gear_geometry.hpp>

#include <array>

namespace drev {

struct ThicknessTolerance {
  double upper_allowance = 0.0;  ///< A_sne, m, <= 0
  double tolerance = 0.0;        ///< T_sn, m, >= 0
};

struct BacklashTolerances {
  std::array<ThicknessTolerance, 2> thickness = {};      ///< of gears 1 and 2
  double centre_distance = 0.0;                          ///< A_a, m, >= 0
  std::array<double, 2> temperature_rise = {};           ///< of the gears above that of the drawing, K
  double housing_temperature_rise = 0.0;                 ///< K
  std::array<double, 2> expansion = {11.5e-6, 11.5e-6};  ///< alpha of the gears, 1/K, >= 0
  double housing_expansion = 11.5e-6;                    ///< 1/K, >= 0
};

/// Total gap along the transverse line of action, j_bn, m: what GearMesh takes as normal_backlash.
class Backlash {
 public:
  /// Throws ModelError for tolerances out of range and where the teeth can jam (lowest < 0).
  Backlash(const GearPair& pair, const BacklashTolerances& tolerances);
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }
  double mean() const { return 0.5 * (lowest_ + highest_); }
  /// The backlash that the part `fraction` (0 to 1) of all pairs stays below.
  double percentile(double fraction) const;

 private:
  double lowest_ = 0.0, highest_ = 0.0;
  std::array<double, 3> widths_{};  // of what varies, as normal backlash
};

}  // namespace drev
