#pragma once
/// A scalar field u over a plane mesh:
///
///   div(c grad u) + f = 0,   u = 0 or c du/dn = 0 on the boundary, or one unknown value on a part of it
///
/// by Galerkin's method on biquadratic cells: K u = p, K_ij = int c grad N_i . grad N_j, p_i = int f N_i. Torsion of a
/// section by Prandtl's stress function has c = 1, f = 2; torsion of a body of revolution has c = r^3, f = 0.
/// Source: Zienkiewicz & Taylor, The Finite Element Method, vol. 1, 5th ed. 2000, chapter 7.
#include <drev/core/system.hpp>

#include <functional>
#include <vector>

#include "solvers/fields/quadratic_mesh.hpp"

namespace drev {

using FieldCoefficient = std::function<double(const PlanePoint&)>;

/// Unknown of each node: its number from 0 on, or -1 where u = 0. Nodes with the same number share one value.
struct FieldUnknowns {
  std::vector<int> of_node;
  int count = 0;
};
/// One unknown for each node in the order of nodes, except where `zero` is true.
FieldUnknowns field_unknowns(const QuadraticMesh& mesh, const std::vector<bool>& zero);

/// The matrices over the unknowns, with one pattern, and the load vector.
struct FieldMatrices {
  SparseMatrix stiffness;  ///< int c grad N_i . grad N_j
  Vector mass;             ///< int m N_i N_j, values on the pattern of stiffness; empty without m
  Vector load;             ///< int f N_i
};
/// source (f) and mass (m) may be empty. Throws SolverError for inverted cells (Jacobian <= 0).
FieldMatrices assemble_field(const QuadraticMesh& mesh, const FieldUnknowns& unknowns,
                             const FieldCoefficient& conductivity, const FieldCoefficient& source,
                             const FieldCoefficient& mass = {});

/// Nodal values of K u = load. Throws SolverError where the factorisation fails, with its reason.
std::vector<double> solve_field(const FieldMatrices& matrices, const FieldUnknowns& unknowns);

/// grad u [unit of u over unit of length] at a point of a cell.
PlanePoint field_gradient(const QuadraticMesh& mesh, int cell, const CellPoint& point,
                          const std::vector<double>& nodal);

}  // namespace drev
