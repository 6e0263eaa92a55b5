#pragma once
/// The half contour of a body of revolution, as plateaus with steps and rounds between them, and its mesh of quadratic
/// cells. Coordinates z along the axis from the left end, r from the axis [m]. Internal to revolved_torsion.hpp.
///
/// A column of cells runs straight from the surface to the bore or axis. Each point of the surface and of the bore has
/// a mark, a number that grows along the contour; the column begins and ends at points of one mark. Marks are z on
/// plain plateaus and run ahead on the thicker side of a step, so that columns from its face lean into the material
/// and no two cross. Cells get thicker with the distance from the surface, from rounds and from corners:
///
///   x(s) = p + (2 s (1 - s) l/|f - p| + s^2) (f - p)      p on the surface, f on the bore, l about a round's radius
///
/// Where a bore begins at the plane of a step of the surface, no straight columns fit. Bent ones do: straight from the
/// surface to a line r_m(z) inside the material, at z = the mark, and from there to the bore. Bores with steps get them.
#include <functional>
#include <vector>

#include "solvers/fields/quadratic_mesh.hpp"

namespace drev {

/// A part of the shaft between two planes. Radii in m; those of a cone change linearly.
struct RevolvedStation {
  double length = 0.0;
  double left = 0.0, right = 0.0;  ///< outer radii at its ends
  double bore = 0.0;               ///< 0: solid
  double round_left = 0.0,
         round_right = 0.0;  ///< radii of the fillets where the neighbour is thicker; 0: sharp
  double factor = 1.0;       ///< of the conductivity r^3: J of a keyed section over that of the round one
};

/// One smooth piece of the surface or bore.
struct ContourEdge {
  std::function<PlanePoint(double)> at;  ///< over 0 to 1
  double length = 0.0;
  int round_cells = 0;  ///< > 0: a fillet of so many equal cells
  double round = 0.0;   ///< its radius
  double mark_from = 0.0, mark_to = 0.0;
  int station = 0;    ///< that it belongs to
  bool face = false;  ///< of a step, at right angles to the axis
};

struct RevolvedContour {
  std::vector<ContourEdge> surface, bore;
};
/// lean: how far marks run ahead, 0 to 1.
RevolvedContour revolved_contour(const std::vector<RevolvedStation>& stations, double lean);

/// Where the surface of a station turns outwards without a round, elastic stress has no limit. corner: towards another slope,
/// or away from an end, which turns as a whole; shoulder: at the face of a step.
enum class SharpEdge { none, corner, shoulder };
/// Of each station.
std::vector<SharpEdge> sharp_edges(const std::vector<RevolvedStation>& stations);

/// Columns of cells as a grid: cell column * rows + row, rows from the surface (0) to the bore, u = -1 on the surface.
struct RevolvedMesh {
  QuadraticMesh mesh;
  int columns = 0, rows = 0;
  std::vector<int> station;  ///< of each column's edge of the surface; -1: the face of a step
  /// Where columns begin and end, and their middles, so that column c is from 2 c to 2 c + 2: z where they are a fifth of
  /// the way to their marks. A leaning column divides the shaft as the plane does at this mean of its r^3, and what a neck
  /// twists inside a thicker part is the neck's.
  std::vector<double> place;
};
class RevolvedMesher {
 public:
  /// bent: columns go by way of a line in the material.
  explicit RevolvedMesher(const std::vector<RevolvedStation>& stations, double lean = 1.0, bool bent = false);
  /// halvings: every cell of the first mesh is cut into 2^halvings by 2^halvings.
  RevolvedMesh mesh(int halvings) const;
  /// Nodes of it.
  double nodes(int halvings) const;

 private:
  struct Cell {
    std::size_t edge;
    double from, to;
  };
  void corners(const std::vector<RevolvedStation>& stations);
  void divide(const std::vector<RevolvedStation>& stations);
  PlanePoint foot(double mark) const;
  PlanePoint bend(double mark) const;
  int rows() const;
  double share(const Cell& cell, double t, double length) const;

  RevolvedContour contour_;
  std::vector<PlanePoint>
      corner_normal_;  // at the start of each edge of the surface, and at the end of the last
  std::vector<double> corner_size_, corner_reach_;  // sizes of cells there, lengths l there
  std::vector<Cell> cells_;
  std::vector<double> layers_;
  std::vector<PlanePoint> middle_;  // r_m(z) by its knots; empty: columns are straight
};

}  // namespace drev
