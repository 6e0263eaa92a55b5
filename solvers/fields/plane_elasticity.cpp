#include "solvers/fields/plane_elasticity.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace drev {
namespace {

struct Moduli {
  double lambda, mu;
};

Moduli moduli(const PlaneMaterial& m) {
  const double nu = m.poisson_ratio, e = m.youngs_modulus * m.thickness;
  return {e * nu / (m.plane_stress ? 1.0 - nu * nu : (1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 * e / (1.0 + nu)};
}

using CellMatrix = std::array<double, 81 * 4>;  // a block of 2 x 2 for each pair of nodes

/// Stiffness of a cell: K_ij = integral of lambda g_i g_j' + mu (g_j g_i' + (g_i . g_j) I), with the
/// gradients g.
CellMatrix cell_stiffness(const QuadraticMesh& mesh, int cell, const Moduli& m) {
  CellMatrix k{};
  for (const CellPoint& p : gauss_points(mesh, cell)) {
    const double lambda = m.lambda * p.weight, mu = m.mu * p.weight;
    for (std::size_t i = 0; i < 9; ++i) {
      const auto [ax, ay] = p.gradient[i];
      for (std::size_t j = 0; j < 9; ++j) {
        const auto [bx, by] = p.gradient[j];
        double* at = &k[4 * (9 * i + j)];
        const double xx = ax * bx, yy = ay * by, dot = mu * (xx + yy);
        at[0] += (lambda + mu) * xx + dot;
        at[1] += lambda * ax * by + mu * bx * ay;
        at[2] += lambda * ay * bx + mu * by * ax;
        at[3] += (lambda + mu) * yy + dot;
      }
    }
  }
  return k;
}

}  // namespace

SparseMatrix plane_stiffness(const QuadraticMesh& mesh, const std::vector<PlaneMaterial>& material) {
  const int nodes = static_cast<int>(mesh.nodes.size());
  // Neighbours of each node in ascending order: the cells at the node, then their nodes without repetition.
  std::vector<int> begin(mesh.nodes.size() + 1, 0), cells;
  for (const auto& cell : mesh.cells)
    for (const int node : cell) ++begin[static_cast<std::size_t>(node) + 1];
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) begin[n + 1] += begin[n];
  cells.resize(static_cast<std::size_t>(begin.back()));
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const int node : mesh.cells[c])
      cells[static_cast<std::size_t>(next[static_cast<std::size_t>(node)]++)] = static_cast<int>(c);
  std::vector<int> first(mesh.nodes.size() + 1, 0), neighbours, seen(mesh.nodes.size(), -1);
  for (int n = 0; n < nodes; ++n) {
    const auto from = neighbours.size(), at = static_cast<std::size_t>(n);
    for (int s = begin[at]; s < begin[at + 1]; ++s)
      for (const int other : mesh.cells[static_cast<std::size_t>(cells[static_cast<std::size_t>(s)])])
        if (seen[static_cast<std::size_t>(other)] != n) {
          seen[static_cast<std::size_t>(other)] = n;
          neighbours.push_back(other);
        }
    std::sort(neighbours.begin() + static_cast<std::ptrdiff_t>(from), neighbours.end());
    first[at + 1] = static_cast<int>(neighbours.size());
  }
  SparseMatrix k(2 * nodes, 2 * nodes);
  k.resizeNonZeros(4 * first.back());
  int* outer = k.outerIndexPtr();
  int* inner = k.innerIndexPtr();
  double* values = k.valuePtr();
  for (int n = 0, slot = 0; n < nodes; ++n) {
    for (int d = 0; d < 2; ++d) {
      outer[2 * n + d] = slot;
      for (int s = first[static_cast<std::size_t>(n)]; s < first[static_cast<std::size_t>(n) + 1]; ++s) {
        inner[slot++] = 2 * neighbours[static_cast<std::size_t>(s)];
        inner[slot++] = 2 * neighbours[static_cast<std::size_t>(s)] + 1;
      }
    }
    outer[2 * n + 2] = slot;
  }
  std::fill(values, values + k.nonZeros(), 0.0);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const CellMatrix local =
        cell_stiffness(mesh, static_cast<int>(c), moduli(material[material.size() > 1 ? c : 0]));
    for (std::size_t j = 0; j < 9; ++j) {
      const int column = mesh.cells[c][j];
      const auto low = neighbours.begin() + first[static_cast<std::size_t>(column)];
      const auto high = neighbours.begin() + first[static_cast<std::size_t>(column) + 1];
      for (std::size_t i = 0; i < 9; ++i) {
        const auto place = 2 * (std::lower_bound(low, high, mesh.cells[c][i]) - low);
        const double* block = &local[4 * (9 * i + j)];
        for (int d = 0; d < 2; ++d) {
          values[outer[2 * column + d] + place] += block[d];
          values[outer[2 * column + d] + place + 1] += block[2 + d];
        }
      }
    }
  }
  return k;
}

FlamantField::FlamantField(PlanePoint origin, PlanePoint direction, double poisson_ratio)
    : origin_(origin),
      direction_(direction),
      modulus_(1.0 / (1.0 - poisson_ratio * poisson_ratio)),
      poisson_(poisson_ratio / (1.0 - poisson_ratio)) {}

PlanePoint FlamantField::displacement(PlanePoint at) const {
  const double dx = at[0] - origin_[0], dy = at[1] - origin_[1], r = std::hypot(dx, dy);
  const double c = (dx * direction_[0] + dy * direction_[1]) / r;
  const double s = (dy * direction_[0] - dx * direction_[1]) / r;
  const double angle = std::atan2(s, c), scale = 1.0 / (kPi * modulus_), log_r = 2.0 * std::log(r);
  const double radial = scale * (-c * log_r - (1.0 - poisson_) * angle * s);
  const double around = scale * (s * log_r + (1.0 + poisson_) * s - (1.0 - poisson_) * angle * c);
  return {(radial * dx - around * dy) / r, (radial * dy + around * dx) / r};
}

PlanePoint FlamantField::traction(PlanePoint at, PlanePoint normal) const {
  const double dx = at[0] - origin_[0], dy = at[1] - origin_[1], square = dx * dx + dy * dy;
  if (!(square > 0.0)) return {0.0, 0.0};
  const double along = dx * direction_[0] + dy * direction_[1];  // r cos(th)
  const double size = -2.0 * along / (kPi * square * square) * (dx * normal[0] + dy * normal[1]);
  return {size * dx, size * dy};
}

}  // namespace drev
