// Covers solvers/fields/scalar_field.hpp and solvers/fields/graded_division.hpp.
#include "solvers/fields/scalar_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/fields/graded_division.hpp"
#include "tests/catch.hpp"

namespace {

using namespace drev;

/// Largest nodal error of div(c grad u) + f = 0 on the unit square, u = sin(pi x) sin(pi y), c = 1 + x.
double field_error(int cells) {
  constexpr double pi = std::numbers::pi;
  QuadraticMesh mesh;
  add_block(mesh, cells, cells, [](double s, double t) { return PlanePoint{s, t}; });
  std::vector<bool> zero;
  for (const auto& [x, y] : mesh.nodes) zero.push_back(x == 0.0 || y == 0.0 || x == 1.0 || y == 1.0);
  const FieldUnknowns unknowns = field_unknowns(mesh, zero);
  const auto exact = [](const PlanePoint& p) { return std::sin(pi * p[0]) * std::sin(pi * p[1]); };
  const FieldMatrices matrices = assemble_field(
      mesh, unknowns, [](const PlanePoint& p) { return 1.0 + p[0]; },
      [&](const PlanePoint& p) {
        return 2.0 * pi * pi * (1.0 + p[0]) * exact(p) - pi * std::cos(pi * p[0]) * std::sin(pi * p[1]);
      });
  const std::vector<double> u = solve_field(matrices, unknowns);
  double error = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) error = std::max(error, std::abs(u[i] - exact(mesh.nodes[i])));
  return error;
}

TEST_CASE("Finite elements of a scalar field converge at the third order or better", "[fields]") {
  const double coarse = field_error(8), fine = field_error(16);
  CHECK(fine < 2e-5);
  CHECK(std::log2(coarse / fine) > 2.9);
}

TEST_CASE("Matrices of a scalar field: constants carry no flux, the mass is the area", "[fields]") {
  QuadraticMesh mesh;
  add_block(mesh, 2, 3, [](double s, double t) {
    return PlanePoint{2.0 * s + 0.1 * t * t, t + 0.2 * s * t};
  });
  FieldUnknowns unknowns = field_unknowns(mesh, std::vector<bool>(mesh.nodes.size(), false));
  const auto one = [](const PlanePoint&) { return 1.0; };
  const FieldMatrices matrices = assemble_field(mesh, unknowns, one, one, one);
  const Vector ones = Vector::Ones(unknowns.count);
  CHECK((matrices.stiffness * ones).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(matrices.mass.sum() == Approx(matrices.load.sum()).epsilon(1e-13));
  CHECK((SparseMatrix(matrices.stiffness.transpose()) - matrices.stiffness).norm() == 0.0);
}

TEST_CASE("A graded division fills its edge and keeps its sizes", "[fields]") {
  const auto ends = graded_division(2.0, {.first = 0.01, .last = 0.05, .growth = 0.5, .largest = 0.3});
  CHECK(ends.front() == 0.0);
  CHECK(ends.back() == 1.0);
  CHECK(2.0 * ends[1] < 0.0135);
  CHECK(2.0 * (1.0 - ends[ends.size() - 2]) < 0.08);
  double largest = 0.0;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    CHECK(ends[i] > ends[i - 1]);
    largest = std::max(largest, 2.0 * (ends[i] - ends[i - 1]));
  }
  CHECK(largest <= 0.3);
  CHECK(graded_division(0.1, {.first = 1.0, .last = 1.0, .growth = 0.5, .largest = 1.0}).size() == 2);
}

}  // namespace
