#include "solvers/fields/scalar_field.hpp"

#include <drev/core/error.hpp>

#include <algorithm>

#include "solvers/linear/sparse_cholesky.hpp"

namespace drev {
namespace {

/// Numbers of the unknowns of a cell; -1: none.
std::array<int, 9> cell_unknowns(const QuadraticMesh& mesh, const FieldUnknowns& unknowns, std::size_t cell) {
  std::array<int, 9> local;
  for (std::size_t k = 0; k < 9; ++k)
    local[k] = unknowns.of_node[static_cast<std::size_t>(mesh.cells[cell][k])];
  return local;
}

/// The pattern of unknowns that share a cell, both triangles, column by column.
SparseMatrix field_pattern(const QuadraticMesh& mesh, const FieldUnknowns& unknowns) {
  const auto n = static_cast<std::size_t>(unknowns.count);
  std::vector<int> start(n + 1, 0);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    for (const int u : cell_unknowns(mesh, unknowns, cell))
      if (u >= 0) ++start[static_cast<std::size_t>(u) + 1];
  for (std::size_t i = 0; i < n; ++i) start[i + 1] += start[i];
  std::vector<int> cells(static_cast<std::size_t>(start[n])), next(start.begin(), start.end() - 1);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    for (const int u : cell_unknowns(mesh, unknowns, cell))
      if (u >= 0)
        cells[static_cast<std::size_t>(next[static_cast<std::size_t>(u)]++)] = static_cast<int>(cell);
  SparseMatrix pattern(unknowns.count, unknowns.count);
  std::vector<int> rows, column;
  std::vector<int> outer{0};
  for (std::size_t i = 0; i < n; ++i) {
    column.clear();
    for (int at = start[i]; at < start[i + 1]; ++at)
      for (const int u :
           cell_unknowns(mesh, unknowns, static_cast<std::size_t>(cells[static_cast<std::size_t>(at)])))
        if (u >= 0) column.push_back(u);
    std::sort(column.begin(), column.end());
    rows.insert(rows.end(), column.begin(), std::unique(column.begin(), column.end()));
    outer.push_back(static_cast<int>(rows.size()));
  }
  pattern.resizeNonZeros(outer.back());
  std::copy(outer.begin(), outer.end(), pattern.outerIndexPtr());
  std::copy(rows.begin(), rows.end(), pattern.innerIndexPtr());
  std::fill_n(pattern.valuePtr(), outer.back(), 0.0);
  return pattern;
}

}  // namespace

FieldUnknowns field_unknowns(const QuadraticMesh& mesh, const std::vector<bool>& zero) {
  FieldUnknowns unknowns;
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
    unknowns.of_node.push_back(zero[node] ? -1 : unknowns.count++);
  return unknowns;
}

FieldMatrices assemble_field(const QuadraticMesh& mesh, const FieldUnknowns& unknowns,
                             const FieldCoefficient& conductivity, const FieldCoefficient& source,
                             const FieldCoefficient& mass) {
  FieldMatrices all;
  all.stiffness = field_pattern(mesh, unknowns);
  all.load = Vector::Zero(unknowns.count);
  if (mass) all.mass = Vector::Zero(all.stiffness.nonZeros());
  const int* outer = all.stiffness.outerIndexPtr();
  const int* inner = all.stiffness.innerIndexPtr();
  double* values = all.stiffness.valuePtr();
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto local = cell_unknowns(mesh, unknowns, cell);
    std::array<std::array<double, 9>, 9> k{}, m{};
    for (const CellPoint& point : gauss_points(mesh, static_cast<int>(cell))) {
      const double c = conductivity(point.position) * point.weight;
      const double f = source ? source(point.position) * point.weight : 0.0;
      const double density = mass ? mass(point.position) * point.weight : 0.0;
      for (std::size_t i = 0; i < 9; ++i) {
        if (local[i] >= 0) all.load[local[i]] += f * point.value[i];
        for (std::size_t j = 0; j <= i; ++j) {
          const PlanePoint &a = point.gradient[i], &b = point.gradient[j];
          k[i][j] += c * (a[0] * b[0] + a[1] * b[1]);
          m[i][j] += density * point.value[i] * point.value[j];
        }
      }
    }
    for (std::size_t j = 0; j < 9; ++j) {
      if (local[j] < 0) continue;
      const int *first = inner + outer[local[j]], *last = inner + outer[local[j] + 1];
      for (std::size_t i = 0; i < 9; ++i) {
        if (local[i] < 0) continue;
        const auto at = std::lower_bound(first, last, local[i]) - inner;
        values[at] += i >= j ? k[i][j] : k[j][i];
        if (mass) all.mass[at] += i >= j ? m[i][j] : m[j][i];
      }
    }
  }
  return all;
}

std::vector<double> solve_field(const FieldMatrices& matrices, const FieldUnknowns& unknowns) {
  SparseCholesky factor(matrices.stiffness);
  const Vector values =
      Eigen::Map<const Vector>(matrices.stiffness.valuePtr(), matrices.stiffness.nonZeros());
  if (factor.factorize(matrices.stiffness, values) != FactorStatus::success)
    throw SolverError("finite elements of a scalar field: the matrix of " + std::to_string(unknowns.count) +
                      " unknowns is " + to_text(factor.status()));
  Vector u;
  factor.solve(matrices.load, u);
  std::vector<double> nodal;
  for (const int unknown : unknowns.of_node) nodal.push_back(unknown < 0 ? 0.0 : u[unknown]);
  return nodal;
}

PlanePoint field_gradient(const QuadraticMesh& mesh, int cell, const CellPoint& point,
                          const std::vector<double>& nodal) {
  PlanePoint gradient{};
  for (std::size_t k = 0; k < 9; ++k) {
    const double u = nodal[static_cast<std::size_t>(mesh.cells[static_cast<std::size_t>(cell)][k])];
    gradient[0] += u * point.gradient[k][0];
    gradient[1] += u * point.gradient[k][1];
  }
  return gradient;
}

}  // namespace drev
