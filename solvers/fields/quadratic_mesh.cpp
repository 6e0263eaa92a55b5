#include "solvers/fields/quadratic_mesh.hpp"

#include <drev/core/error.hpp>

#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace drev {
namespace {

std::array<double, 3> lagrange(double u) { return {0.5 * u * (u - 1.0), 1.0 - u * u, 0.5 * u * (u + 1.0)}; }
std::array<double, 3> lagrange_slope(double u) { return {u - 0.5, -2.0 * u, u + 0.5}; }

/// Key of the square (i, j) of a grid.
std::uint64_t square_key(std::int64_t i, std::int64_t j) {
  return static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15ULL ^
         static_cast<std::uint64_t>(j) * 0xc2b2ae3d27d4eb4fULL;
}

}  // namespace

CellPoint cell_point(const QuadraticMesh& mesh, int cell, double u, double v) {
  const auto a = lagrange(u), b = lagrange(v), da = lagrange_slope(u), db = lagrange_slope(v);
  const auto& nodes = mesh.cells[static_cast<std::size_t>(cell)];
  CellPoint point;
  std::array<PlanePoint, 9> local;  // dN/du, dN/dv
  PlanePoint xu{}, xv{};
  for (std::size_t k = 0; k < 9; ++k) {
    const std::size_t i = k % 3, j = k / 3;
    point.value[k] = a[i] * b[j];
    local[k] = {da[i] * b[j], a[i] * db[j]};
    const PlanePoint& x = mesh.nodes[static_cast<std::size_t>(nodes[k])];
    for (std::size_t d = 0; d < 2; ++d) {
      point.position[d] += point.value[k] * x[d];
      xu[d] += local[k][0] * x[d];
      xv[d] += local[k][1] * x[d];
    }
  }
  point.jacobian = xu[0] * xv[1] - xu[1] * xv[0];
  if (!(point.jacobian > 0.0)) return point;
  for (std::size_t k = 0; k < 9; ++k) {
    point.gradient[k] = {(xv[1] * local[k][0] - xu[1] * local[k][1]) / point.jacobian,
                         (xu[0] * local[k][1] - xv[0] * local[k][0]) / point.jacobian};
  }
  return point;
}

std::array<CellPoint, 9> gauss_points(const QuadraticMesh& mesh, int cell) {
  static const double place = std::sqrt(0.6);
  static const std::array<double, 3> at{-place, 0.0, place}, weight{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  std::array<CellPoint, 9> points;
  for (std::size_t k = 0; k < 9; ++k) {
    points[k] = cell_point(mesh, cell, at[k % 3], at[k / 3]);
    if (!(points[k].jacobian > 0.0)) {
      throw SolverError("the finite-element mesh turns over near (" + to_text(points[k].position[0]) + ", " +
                        to_text(points[k].position[1]) + ")");
    }
    points[k].weight = weight[k % 3] * weight[k / 3] * points[k].jacobian;
  }
  return points;
}

std::vector<int> add_block(QuadraticMesh& mesh, int columns, int rows,
                           const std::function<PlanePoint(double, double)>& map) {
  std::vector<int> numbers;
  for (int j = 0; j <= 2 * rows; ++j) {
    for (int i = 0; i <= 2 * columns; ++i) {
      numbers.push_back(static_cast<int>(mesh.nodes.size()));
      mesh.nodes.push_back(map(0.5 * i / columns, 0.5 * j / rows));
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      auto& cell = mesh.cells.emplace_back();
      for (int k = 0; k < 9; ++k) {
        const int node = (2 * j + k / 3) * (2 * columns + 1) + 2 * i + k % 3;
        cell[static_cast<std::size_t>(k)] = numbers[static_cast<std::size_t>(node)];
      }
    }
  }
  return numbers;
}

std::vector<int> join_nodes(QuadraticMesh& mesh, double distance) {
  // For each node search its square of the grid and the eight around it.
  std::unordered_multimap<std::uint64_t, int> squares;
  std::vector<PlanePoint> kept;
  std::vector<int> renumbered;
  for (const PlanePoint& node : mesh.nodes) {
    const auto i = static_cast<std::int64_t>(std::floor(node[0] / distance));
    const auto j = static_cast<std::int64_t>(std::floor(node[1] / distance));
    int same = -1;
    for (std::int64_t square = 0; square < 9 && same < 0; ++square) {
      const auto [first, last] = squares.equal_range(square_key(i + square % 3 - 1, j + square / 3 - 1));
      for (auto at = first; at != last && same < 0; ++at) {
        const PlanePoint& other = kept[static_cast<std::size_t>(at->second)];
        if (std::hypot(other[0] - node[0], other[1] - node[1]) < distance) same = at->second;
      }
    }
    if (same < 0) {
      same = static_cast<int>(kept.size());
      kept.push_back(node);
      squares.emplace(square_key(i, j), same);
    }
    renumbered.push_back(same);
  }
  mesh.nodes = std::move(kept);
  for (auto& cell : mesh.cells) {
    for (int& node : cell) node = renumbered[static_cast<std::size_t>(node)];
  }
  return renumbered;
}

}  // namespace drev
