#pragma once
/// Strength of the sections of a train: data from which stresses follow and limits for them. They do not
/// change the motion. Units: m, Pa, N m, W, rad/s. Not a number: not given.
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace drev {

/// An S-N line: N(range) = cycles (reference / range)^slope cycles to failure at a range (maximum - minimum) of
/// stress. There is no fatigue limit: smaller ranges count by the same line (Miner's elementary rule).
struct SnLine {
  double reference = std::numeric_limits<double>::quiet_NaN();  ///< reference range of stress [Pa], > 0
  double cycles = 2e6;                                          ///< cycles to failure at that range [-], > 0
  double slope = 5.0;                                           ///< slope of the line [-], >= 1
  bool given() const { return reference > 0.0; }
};

/// A section: an element whose torque a shaft of this diameter carries.
struct SectionStrength {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::string element;                ///< name of the element whose torque, ELEMENT.torque_Nm, it carries
  double diameter = kNone;            ///< smallest outer diameter [m], > 0
  double bore = 0.0;                  ///< diameter of the bore [m], 0 <= bore < diameter
  double stress_concentration = 1.0;  ///< local over nominal stress in torsion [-], >= 1
  double tensile_strength = kNone;    ///< tensile strength for IACS UR M68 [Pa], 400 to 800 MPa
  double shape_factor = kNone;        ///< shape factor C_K of IACS UR M68 [-], > 0, <= 1
  double permissible_stress = kNone;  ///< permissible half range of the local stress, continuous running [Pa]
  double transient_stress = kNone;    ///< the same while a speed range is passed [Pa]
  double permissible_torque = kNone;  ///< permissible half range of the torque in continuous running [N m]
  double transient_torque = kNone;    ///< the same while a speed range is passed [N m]
  double permissible_heat = kNone;    ///< permissible heat of a damper or coupling [W]
  SnLine sn = {};
};

/// The sections of a model, and further data for their judgement.
struct Strength {
  /// Rated speed of the reference shaft [rad/s], to which speed ratios refer.
  double rated_speed = SectionStrength::kNone;
  std::vector<SectionStrength> sections;
  /// Parameters of the model, with their values, that make a cylinder misfire.
  std::vector<std::pair<std::string, double>> misfire;
};

/// Polar section modulus pi (d^4 - b^4) / (16 d) [m^3] of a circular section with outer diameter d > 0 and
/// bore b [m], 0 <= b < d: nominal shear stress = torque / modulus (S. Timoshenko, Strength of Materials,
/// Part I, 1955, section 61).
double polar_section_modulus(double diameter, double bore = 0.0);

}  // namespace drev
