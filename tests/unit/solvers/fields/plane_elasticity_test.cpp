// Plane elasticity: patch test, a thick ring under pressure (Lame), and the field of a force on a half-plane.
// Covers solvers/fields/plane_elasticity.hpp.
#include "solvers/fields/plane_elasticity.hpp"

#include <drev/core/units.hpp>

#include <cmath>

#include "solvers/linear/sparse_cholesky.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

QuadraticMesh quarter_ring(int cells, double inner, double outer) {
  QuadraticMesh mesh;
  add_block(mesh, cells, cells, [&](double s, double t) {
    const double r = inner + t * (outer - inner), angle = 0.5 * kPi * (1.0 - s);
    return PlanePoint{r * std::cos(angle), r * std::sin(angle)};
  });
  return mesh;
}

}  // namespace

TEST_CASE("A linear displacement strains every cell alike", "[fields]") {
  QuadraticMesh mesh;
  add_block(mesh, 3, 2, [](double s, double t) {
    return PlanePoint{s + 0.1 * t * t, t + 0.2 * s * (1 - s)};
  });
  for (const bool plane_stress : {false, true}) {
    const PlaneMaterial material{
        .youngs_modulus = 3.0, .poisson_ratio = 0.3, .thickness = 2.0, .plane_stress = plane_stress};
    const SparseMatrix k = plane_stiffness(mesh, {material});
    CHECK((SparseMatrix(k.transpose()) - k).norm() < 1e-13 * k.norm());
    Vector u(k.rows()), turned(k.rows());
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const auto [x, y] = mesh.nodes[n];
      const auto i = static_cast<Eigen::Index>(2 * n);
      u[i] = 0.4 * x + 0.3 * y;
      u[i + 1] = -0.1 * x + 0.2 * y;
      turned[i] = -y + 1.0;
      turned[i + 1] = x - 2.0;
    }
    CHECK((k * turned).norm() < 1e-12 * k.norm());
    double area = 0.0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      for (const CellPoint& p : gauss_points(mesh, static_cast<int>(c))) area += p.weight;
    // Energy of the strains .4, .2 and shear .3 - .1 by Hooke's law in closed form.
    const double nu = 0.3, mu = 3.0 / 2.6;
    const double lambda = plane_stress ? 3.0 * nu / (1.0 - nu * nu) : 3.0 * nu / (1.3 * 0.4);
    const double density = lambda * 0.36 + 2.0 * mu * (0.16 + 0.04) + mu * 0.04;
    CHECK(std::abs(u.dot(k * u) / (2.0 * area * density) - 1.0) < 1e-12);
  }
}

TEST_CASE("A thick ring under inner pressure widens as Lame says, at third order and better", "[fields]") {
  // Plane strain, E 1, pressure 1, radii 1 and 2: u(1) = (1 + nu)(1/3)[(1 - 2 nu) + 4]. Quarter, held by symmetry.
  const double nu = 0.3, exact = (1.0 + nu) / 3.0 * ((1.0 - 2.0 * nu) + 4.0);
  std::vector<double> errors;
  for (const int cells : {1, 2, 4}) {
    const QuadraticMesh mesh = quarter_ring(cells, 1.0, 2.0);
    SparseMatrix k = plane_stiffness(mesh, {{.poisson_ratio = nu}});
    const int row = 2 * cells + 1;
    Vector force = Vector::Zero(k.rows()), u;
    // Pressure on the parabolas of the inner edge, by Simpson's weights of n dl = (dy, -dx) turned outwards.
    for (int i = 0; i < 2 * cells; i += 2)
      for (int q = 0; q < 3; ++q) {
        const double at = std::sqrt(0.6) * (q - 1), weight = q == 1 ? 8.0 / 9.0 : 5.0 / 9.0;
        const std::array<double, 3> n{0.5 * at * (at - 1), 1 - at * at, 0.5 * at * (at + 1)},
            d{at - 0.5, -2 * at, at + 0.5};
        double dx = 0.0, dy = 0.0;
        for (int a = 0; a < 3; ++a) {
          dx += d[static_cast<std::size_t>(a)] * mesh.nodes[static_cast<std::size_t>(i + a)][0];
          dy += d[static_cast<std::size_t>(a)] * mesh.nodes[static_cast<std::size_t>(i + a)][1];
        }
        for (int a = 0; a < 3; ++a) {
          force[2 * (i + a)] -= weight * n[static_cast<std::size_t>(a)] * dy;
          force[2 * (i + a) + 1] += weight * n[static_cast<std::size_t>(a)] * dx;
        }
      }
    for (int j = 0; j < row;
         ++j) {  // x = 0 at the first column of nodes, y = 0 at the last: held by stiff springs
      k.coeffRef(2 * (j * row), 2 * (j * row)) += 1e9;
      k.coeffRef(2 * (j * row + 2 * cells) + 1, 2 * (j * row + 2 * cells) + 1) += 1e9;
    }
    SparseCholesky factor;
    REQUIRE(factor.factorize(k, Eigen::Map<const Vector>(k.valuePtr(), k.nonZeros())) ==
            FactorStatus::success);
    factor.solve(force, u);
    errors.push_back(std::abs(std::abs(u[1]) - exact));
  }
  CHECK(errors.back() < 2e-4 * exact);
  CHECK(std::log2(errors[1] / errors[2]) > 3.0);
}

TEST_CASE("The field of a force on a half-plane is in equilibrium and obeys Hooke's law", "[fields]") {
  const double nu = 0.3;
  const FlamantField field({0.5, 1.0}, {0.6, -0.8}, nu);
  // On the force's line 2 (1 - nu^2)/pi ln(1/r).
  const PlanePoint at = field.displacement({0.5 + 0.6 * 0.2, 1.0 - 0.8 * 0.2});
  CHECK(std::abs(at[0] * 0.6 - at[1] * 0.8 + 2.0 * (1.0 - nu * nu) / kPi * std::log(0.2)) < 1e-14);
  // Tractions of a circle around the origin balance the unit force.
  double fx = 0.0, fy = 0.0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = std::atan2(-0.8, 0.6) + kPi * ((i + 0.5) / kSteps - 0.5);
    const PlanePoint normal{std::cos(angle), std::sin(angle)};
    const PlanePoint t = field.traction({0.5 + 0.3 * normal[0], 1.0 + 0.3 * normal[1]}, normal);
    fx += t[0] * 0.3 * kPi / kSteps;
    fy += t[1] * 0.3 * kPi / kSteps;
  }
  CHECK(std::abs(fx + 0.6) < 1e-5);
  CHECK(std::abs(fy - 0.8) < 1e-5);
  // Strains by differences give the traction by Hooke's law.
  const double h = 1e-5, x = 0.9, y = 0.4, mu = 0.5 / (1.0 + nu),
               lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  const auto slope = [&](int axis, double dx, double dy) {
    return (field.displacement({x + dx, y + dy})[static_cast<std::size_t>(axis)] -
            field.displacement({x - dx, y - dy})[static_cast<std::size_t>(axis)]) /
           (2.0 * h);
  };
  const double exx = slope(0, h, 0), eyy = slope(1, 0, h), gxy = slope(0, 0, h) + slope(1, h, 0);
  const PlanePoint n{0.28, 0.96}, t = field.traction({x, y}, n);
  CHECK(std::abs(t[0] - ((lambda * (exx + eyy) + 2.0 * mu * exx) * n[0] + mu * gxy * n[1])) < 1e-8);
  CHECK(std::abs(t[1] - (mu * gxy * n[0] + (lambda * (exx + eyy) + 2.0 * mu * eyy) * n[1])) < 1e-8);
}
