#pragma once
/// Permissible torsional vibration stresses of propulsion shafts by IACS UR M68 "Dimensions of propulsion shafts and
/// their permissible torsional vibration stresses" (Rev.2 April 2015, Rev.3 February 2021), clause M68.5, and its
/// barred speed range.
///
/// Stresses are half ranges of the nominal stress of the plain section, from the synthesis of all orders;
/// stress raisers are included in C_K. The rule applies to intermediate and propeller shafts of forged steel.
/// By clause M68.1 it does not apply to crankshafts (UR M53), gearing shafts, shafts of motors, generators
/// and turbines, nor to ice strengthening. The largest tensile strength allowed in the formula (M68.3)
/// depends on shaft and material: 600 MPa for carbon steel and for propeller shafts, 800 MPa for intermediate
/// shafts of alloy steel.
namespace drev::iacs_m68 {

/// Size factor C_D = 0.35 + 0.93 d^-0.2 with the outer diameter d in mm (M68.5) [-]. The argument is in m, >
/// 0.
double size_factor(double diameter);

/// Highest speed ratio for which M68.5 has a value [-].
inline constexpr double kHighestRatio = 1.05;

/// Speed factor C_lambda [-]: 3 - 2 lambda^2 for speed ratios lambda < 0.9; 1.38 for 0.9 <= lambda <= 1.05
/// (M68.5). Not a number above 1.05, for which the rule has no value.
double speed_factor(double speed_ratio);

struct Permissible {
  double continuous = 0.0;  ///< tau_C = (sigma_B + 160) / 18 C_K C_D C_lambda, sigma_B [MPa]
  double transient = 0.0;   ///< tau_T = 1.7 tau_C / sqrt(C_K), while a barred speed range is passed
};

/// Permissible half ranges of stress [Pa]. tensile_strength: sigma_B [Pa], 400 to 800 MPa; shape_factor: C_K
/// in (0, 1]; diameter: outer diameter [m]; speed_ratio: speed over rated speed, >= 0. Not a number for speed
/// ratios above 1.05.
Permissible permissible_stress(double tensile_strength, double shape_factor, double diameter,
                               double speed_ratio);

/// Barred speed range from 16 n_c / (18 - lambda) to (18 - lambda) n_c / 16 around a critical speed n_c, with
/// lambda = n_c / rated speed (M68.5).
struct BarredRange {
  double from = 0.0, to = 0.0;  ///< speeds in the unit of the critical speed
};
BarredRange barred_range(double critical_speed, double speed_ratio);

/// Speed ratio from which on no range may be barred [-]: stresses must be permissible there (M68.5).
inline constexpr double kNoBarredRange = 0.8;

}  // namespace drev::iacs_m68
