#pragma once
/// Plane meshes of biquadratic Lagrange quadrilaterals (nine nodes), the finite elements with which gear bodies
/// (plane elasticity) and shaft sections and contours (torsion) are solved.
///
/// Nodes of a cell in its local coordinates -1 <= u, v <= 1, with node 3 j + i at (i - 1, j - 1):
///
///   6 7 8
///   3 4 5      v up, u to the right
///   0 1 2
///
/// x(u, v) = sum_k N_k(u, v) x_k with N_(3j+i) = L_i(u) L_j(v), L_i the quadratic Lagrange polynomials on -1, 0, 1:
/// curved edges are parabolas through three nodes. Source: Zienkiewicz & Taylor, The Finite Element Method, vol. 1,
/// 5th ed. 2000, sections 8.6 and 9.5.
#include <array>
#include <functional>
#include <vector>

namespace drev {

using PlanePoint = std::array<double, 2>;

struct QuadraticMesh {
  std::vector<PlanePoint> nodes;
  std::vector<std::array<int, 9>> cells;
};

/// Values of one cell at one place: shape functions N_k, their gradients [1/unit of length] and the place
/// itself.
struct CellPoint {
  PlanePoint position{};
  std::array<double, 9> value{};         ///< N_k
  std::array<PlanePoint, 9> gradient{};  ///< dN_k/dx, dN_k/dy
  double jacobian = 0.0;                 ///< det d(x, y)/d(u, v), > 0 in a valid cell
  double weight = 0.0;                   ///< weight of the Gauss rule times the Jacobian; 0 from cell_point()
};

/// Values at the cell's local coordinates u, v in [-1, 1]. A degenerate place has a Jacobian <= 0 and
/// gradients of 0.
CellPoint cell_point(const QuadraticMesh& mesh, int cell, double u, double v);

/// The nine points of the Gauss rule that integrates polynomials of degree 5 in u and v exactly: sum of weight
/// times f is the integral of f over the cell. Throws SolverError, naming the place, where a Jacobian is <= 0.
std::array<CellPoint, 9> gauss_points(const QuadraticMesh& mesh, int cell);

/// Adds columns x rows cells over the map of (s, t) in [0, 1]^2 to the plane, whose Jacobian must be > 0. The
/// map is called at multiples of half a cell and contains any grading. Returns the nodes of the block row by
/// row in t: node (i, j), 0 <= i <= 2 columns, 0 <= j <= 2 rows, is at [j * (2 columns + 1) + i]. Blocks that
/// touch have separate nodes there until join_nodes().
std::vector<int> add_block(QuadraticMesh& mesh, int columns, int rows,
                           const std::function<PlanePoint(double s, double t)>& map);

/// Joins nodes closer than `distance` (in the unit of the coordinates, > 0, below half of the smallest
/// distance of different nodes) and returns the new number for each old one.
std::vector<int> join_nodes(QuadraticMesh& mesh, double distance);

}  // namespace drev
