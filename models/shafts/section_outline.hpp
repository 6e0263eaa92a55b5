#pragma once
/// Outlines of sections in torsion: a closed curve of smooth edges, or the part of one that symmetry repeats.
///
/// Coordinates x, y [m] about the shaft's axis. Edges go round counter-clockwise, the material to their left, and
/// join end to end. A section must be visible from one point inside it, or from the hole that it has: the
/// finite elements are a fan from there.
#include <drev/elements/periodic_curve.hpp>

#include <functional>
#include <string>
#include <vector>

#include "solvers/fields/quadratic_mesh.hpp"

namespace drev {

struct OutlineEdge {
  std::function<PlanePoint(double)> at;  ///< over 0 to 1, at a speed that does not vanish
  bool free = true;  ///< surface; false: a line of symmetry, which carries no shear across
  int cells = 0;     ///< > 0: a round of which so many equal cells are made; 0: as the neighbours ask
};

struct SectionOutline {
  std::string name = {};
  std::vector<OutlineEdge> edges = {};
  int copies = 1;            ///< how often symmetry repeats it
  double size = 0.0;         ///< radius of the circle about the axis that holds it [m], > 0
  PlanePoint hole{};         ///< centre of a round hole [m]
  double hole_radius = 0.0;  ///< 0: none [m]
};

/// All throw ModelError with every dimension that cannot be. Lengths in m, angles in rad.
/// Semi-axes a, b > 0.
SectionOutline ellipse_outline(double a, double b);
/// Corners counter-clockwise about the axis, convex; at least 3.
SectionOutline polygon_outline(const std::vector<PlanePoint>& corners);
/// Sides a, b > 0 about their centre.
SectionOutline rectangle_outline(double a, double b);
/// A circle of radius R with a hole of radius r, 0 < r, r + offset < R.
SectionOutline ring_outline(double radius, double hole_radius, double offset);
/// A circle of radius a with a groove that is a circle of radius b < 0.8 a about a point of its edge.
SectionOutline grooved_outline(double radius, double groove_radius);
/// A shaft of diameter d with one keyway: width b < 0.8 d, depth from the crown, rounds of radius r > 0 at the bottom, at most
/// b/2 and the depth of the sides; depth + r < 0.45 d.
SectionOutline keyway_outline(double diameter, double width, double depth, double corner_radius);
/// Straight-sided spline (ISO 14 and the like): n teeth of parallel sides b wide between minor and major diameter, rounds of
/// radius r > 0 at their roots.
SectionOutline spline_outline(int teeth, double minor_diameter, double major_diameter, double tooth_width,
                              double root_radius);
/// A cam of the profile r(angle) = base radius + lift, as seen from the shaft's axis; smooth between the points of the
/// lift where it is a cubic curve. bore: radius of a concentric bore, 0: none.
SectionOutline cam_outline(double base_radius, const PeriodicCurve& lift, double bore_radius = 0.0);

}  // namespace drev
