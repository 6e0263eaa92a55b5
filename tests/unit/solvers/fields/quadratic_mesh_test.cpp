// Covers solvers/fields/quadratic_mesh.hpp.
#include "solvers/fields/quadratic_mesh.hpp"

#include <drev/core/error.hpp>

#include <cmath>
#include <numbers>

#include "tests/catch.hpp"

namespace {

using namespace drev;

/// A quarter of the ring 1 <= r <= 2: its second polar moment is pi/8 (2^4 - 1^4).
double ring_moment_error(int cells) {
  QuadraticMesh mesh;
  add_block(mesh, cells, cells, [](double s, double t) {
    const double angle = 0.5 * std::numbers::pi * t;
    return PlanePoint{(1.0 + s) * std::cos(angle), (1.0 + s) * std::sin(angle)};
  });
  double sum = 0.0;
  for (int cell = 0; cell < static_cast<int>(mesh.cells.size()); ++cell) {
    for (const CellPoint& point : gauss_points(mesh, cell)) {
      sum += point.weight * (point.position[0] * point.position[0] + point.position[1] * point.position[1]);
    }
  }
  return std::abs(sum - std::numbers::pi / 8.0 * 15.0);
}

TEST_CASE("A mesh of curved quadratic cells integrates a ring at its order", "[fields]") {
  // Edges are parabolas through three points of the circle: the area between is of fourth order.
  const double coarse = ring_moment_error(4), fine = ring_moment_error(8);
  CHECK(fine < 1e-4);
  CHECK(std::log2(coarse / fine) > 3.8);
}

TEST_CASE("Gradients of quadratic cells are those of a quadratic field on a skewed cell", "[fields]") {
  QuadraticMesh mesh;
  add_block(mesh, 1, 1, [](double s, double t) { return PlanePoint{2.0 * s + 0.5 * t, 0.3 * s + t}; });
  const auto field = [](const PlanePoint& x) { return 1.0 + x[0] * x[0] - 3.0 * x[0] * x[1] + 2.0 * x[1]; };
  const CellPoint point = cell_point(mesh, 0, 0.3, -0.7);
  double value = 0.0, dx = 0.0, dy = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    const double nodal = field(mesh.nodes[static_cast<std::size_t>(mesh.cells[0][k])]);
    value += point.value[k] * nodal;
    dx += point.gradient[k][0] * nodal;
    dy += point.gradient[k][1] * nodal;
  }
  const auto [x, y] = point.position;
  CHECK(value == Approx(field(point.position)).epsilon(1e-13));
  CHECK(dx == Approx(2.0 * x - 3.0 * y).epsilon(1e-12));
  CHECK(dy == Approx(2.0 - 3.0 * x).epsilon(1e-12));
}

TEST_CASE("Blocks that touch become one mesh", "[fields]") {
  QuadraticMesh mesh;
  const auto shifted = [](double by) {
    return [by](double s, double t) { return PlanePoint{s + by, t - 0.5}; };
  };
  const auto left = add_block(mesh, 2, 3, shifted(-1.0)), right = add_block(mesh, 1, 3, shifted(0.0));
  const auto renumbered = join_nodes(mesh, 1e-6);
  CHECK(mesh.nodes.size() == 5 * 7 + 3 * 7 - 7);
  for (std::size_t j = 0; j < 7; ++j) {
    CHECK(renumbered[static_cast<std::size_t>(left[j * 5 + 4])] ==
          renumbered[static_cast<std::size_t>(right[j * 3])]);
  }
}

TEST_CASE("A mesh that turns over is refused with its place", "[fields]") {
  QuadraticMesh mesh;
  add_block(mesh, 1, 1, [](double s, double t) { return PlanePoint{-s, t}; });
  CHECK_THROWS_AS(gauss_points(mesh, 0), SolverError);
  CHECK(cell_point(mesh, 0, 0.0, 0.0).jacobian < 0.0);
}

}  // namespace
