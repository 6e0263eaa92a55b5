#pragma once
/// What sections of a train may carry: data that stresses are found from and compared with. They do not change the
/// motion. Units: m, Pa, N m, W, rad/s. Not a number: not given.
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace drev {

/// An S-N line: N(range) = cycles (reference / range)^slope cycles to failure at a range (maximum - minimum) of
/// stress. Without a fatigue limit: smaller ranges count by the same line (Miner's elementary rule).
struct SnLine {
  double reference = std::numeric_limits<double>::quiet_NaN();  ///< range of stress [Pa], > 0
  double cycles = 2e6;                                          ///< at that range, > 0
  double slope = 5.0;                                           ///< m, >= 1
  bool given() const { return reference > 0.0; }
};

/// A section: an element whose torque a shaft of this diameter carries.
struct SectionStrength {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::string element;                ///< whose channel ELEMENT.torque_Nm it carries
  double diameter = kNone;            ///< smallest, outer, > 0 [m]
  double bore = 0.0;                  ///< 0 <= bore < diameter [m]
  double stress_concentration = 1.0;  ///< of torsion, >= 1: local over nominal stress
  double tensile_strength = kNone;    ///< 400 to 800 MPa, for IACS UR M68 [Pa]
  double shape_factor = kNone;        ///< C_K of IACS UR M68, > 0, <= 1
  double permissible_stress = kNone;  ///< half range of the local stress in continuous running [Pa]
  double transient_stress = kNone;    ///< the same while a range of speeds is passed [Pa]
  double permissible_torque = kNone;  ///< half range in continuous running [N m]
  double transient_torque = kNone;    ///< while passed [N m]
  double permissible_heat = kNone;    ///< of a damper or coupling [W]
  SnLine sn = {};
};

/// A model's sections, and what it is judged by.
struct Strength {
  double rated_speed =
      SectionStrength::kNone;  ///< of the reference shaft: speed ratios are beside it [rad/s]
  std::vector<SectionStrength> sections;
  std::vector<std::pair<std::string, double>>
      misfire;  ///< parameters of the model that make a cylinder misfire
};

/// Polar section modulus pi (d^4 - b^4) / (16 d) [m^3] of a circular section, outer diameter d > 0, bore 0 <= b < d [m]:
/// nominal shear stress = torque / modulus (S. Timoshenko, Strength of Materials, Part I, 1955, section 61).
double polar_section_modulus(double diameter, double bore = 0.0);

}  // namespace drev
