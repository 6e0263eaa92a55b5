#pragma once
/// A shaft as it stands on a drawing: stations from its left end to its right one, and what follows from them for a
/// torsional model. Lengths in m.
#include <drev/elements/not_given.hpp>
#include <drev/elements/periodic_curve.hpp>
#include <drev/elements/segment_count.hpp>
#include <drev/solvers/run/estimate.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev {

/// A round groove around the shaft: bottom of radius r, sides at right angles where it is deeper than r.
struct ShaftGroove {
  double position = kNotGiven;  ///< of its middle, from the station's start
  double depth = kNotGiven;     ///< > 0
  double radius = kNotGiven;    ///< > 0
};
struct ShaftKeyway {
  double width = kNotGiven;          ///< > 0
  double depth = kNotGiven;          ///< from the crown, > 0
  double corner_radius = kNotGiven;  ///< of the corners at its bottom, > 0
};
/// Straight-sided (ISO 14); the station's outer diameter is the major diameter.
struct ShaftSpline {
  int teeth = 0;                      ///< 4 to 200
  double minor_diameter = kNotGiven;  ///< > 0
  double tooth_width = kNotGiven;     ///< > 0
  double root_radius = kNotGiven;     ///< > 0
};
/// A cam by its profile, radius = half the station's outer diameter (base circle) + lift.
struct ShaftCam {
  PeriodicTable lift;  ///< over the angle [rad], a period of one turn
  Interpolation interpolation = Interpolation::cubic;
};

struct ShaftStation {
  std::string name = {};              ///< for people; empty: its number
  double length = kNotGiven;          ///< > 0
  double outer_diameter = kNotGiven;  ///< > 0; at the start of a taper; base circle of a cam
  double end_diameter = kNotGiven;    ///< of a taper, > 0; not given: none
  double inner_diameter = 0.0;        ///< bore, >= 0
  double fillet_start = 0.0;          ///< radius of the fillet where the neighbour is thicker, >= 0; 0: sharp
  double fillet_end = 0.0;
  double hub_diameter = kNotGiven;  ///< of a hub shrunk on over its length, > outer_diameter; not given: none
  std::optional<ShaftGroove> groove = {};
  std::optional<ShaftKeyway> keyway = {};
  std::optional<ShaftSpline> spline = {};
  std::optional<ShaftCam> cam = {};
};

struct ShaftContour {
  double shear_modulus = kNotGiven;  ///< G [Pa], > 0; steel 8e10
  double density = kNotGiven;        ///< rho [kg/m^3], > 0; steel 7850
  std::vector<ShaftStation> stations = {};
  double accuracy = 1e-3;  ///< of the flexibility, relative, 1e-6 to 0.1; of peak stresses ten times it
  double up_to_frequency = kNotGiven;  ///< [Hz]; not given: a segment each station
  double frequency_accuracy =
      1e-3;  ///< of waves up to that frequency, relative, 1e-12 to 0.1 (segments_for())
  SegmentMass mass = SegmentMass::averaged;

  static constexpr std::size_t kMostStations = 200;
  /// Everything that cannot be: values out of range, fillets and grooves that do not fit, features that exclude each
  /// other.
  void check(ParameterCheck& check) const;
};

/// What follows for one station.
struct ShaftSection {
  std::string name;
  double from = 0.0, length = 0.0;    ///< z [m]
  double diameter = 0.0, bore = 0.0;  ///< smallest outer one, on which nominal stress stands, and bore [m]
  double torsion_constant =
      0.0;               ///< J of its own section (of a taper: the one that gives its own twist) [m^4]
  double inertia = 0.0;  ///< about the axis [kg m^2]
  double naive_flexibility = 0.0;  ///< length/J [1/m^3]
  double flexibility = 0.0;        ///< G theta/T of its share in the whole [1/m^3]
  /// Largest over nominal shear stress, T/polar_section_modulus(diameter, bore); infinite at a sharp shoulder, and at
  /// the corner of a taper.
  Estimate stress_factor;
  std::string stress_place;  ///< "fillet", "groove", "keyway", ...
};

/// What follows for the shaft.
struct ShaftSections {
  double shear_modulus = 0.0, density = 0.0;
  std::vector<ShaftSection> sections;
  Estimate flexibility;                     ///< G theta/T of the whole [1/m^3], with the error of the mesh
  double naive_flexibility = 0.0;           ///< sum of length/J
  std::vector<double> planes;               ///< where nodes are, both ends among them [m]
  std::vector<double> segment_flexibility;  ///< G theta/T between them [1/m^3]
  std::vector<double> segment_inertia;      ///< [kg m^2]
  std::vector<int> segment_station;
  std::vector<double> outline_z, outline_r,
      outline_stress;  ///< half contour for drawing [m], tau/T there [1/m^3]
  int unknowns = 0;    ///< of the finest mesh

  double stiffness() const { return shear_modulus / flexibility.value; }  ///< of the whole [N m/rad]
  double inertia() const;                                                 ///< of the whole [kg m^2]
  /// By how much the sum of stations, each with its own J over its length, is too stiff: 0.05 is 5 %.
  double naive_excess() const { return flexibility.value / naive_flexibility - 1.0; }
};

/// Stiffness [N m/rad] of the whole with cams and splines as their inscribed and circumscribed circles, hubs loose and as
/// one with the shaft. Material that is added makes a shaft stiffer, so that the truth lies between. Equal without any.
struct ShaftBounds {
  double softest = 0.0, stiffest = 0.0;
};
ShaftBounds shaft_bounds(const ShaftContour& contour);

/// Torsion of sections (section_torsion.hpp) for keyways, splines and cams; torsion of the whole as a body of
/// revolution (revolved_torsion.hpp), in which a keyed station has a conductivity by J and a cam or spline is the
/// circle of the same J. Throws ModelError with everything that cannot be (place: "shaft").
ShaftSections shaft_sections(const ShaftContour& contour);

}  // namespace drev
