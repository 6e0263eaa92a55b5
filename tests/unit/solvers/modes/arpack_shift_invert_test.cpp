// Lowest eigenpairs of a fixed-free chain of equal masses and springs, by ARPACK and by Lanczos' method
// without restarts (modes.hpp takes it; modal_problem.hpp prepares it), beside the closed form
//   omega_k = 2 sqrt(k/m) sin((2k - 1) pi / (2 (2n + 1))).
// Covers solvers/modes/lanczos.hpp and solvers/modes/modal_problem.hpp through solve_modes().
#include "solvers/modes/arpack_shift_invert.hpp"

#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "core/dense/factorization.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr int kMasses = 60, kWanted = 6;

double closed_form(int k) {  // k = 0 is the lowest, (rad/s)^2
  const double s = std::sin((2 * k + 1) * std::numbers::pi / (2 * (2 * kMasses + 1)));
  return 4.0 * s * s;
}

}  // namespace

TEST_CASE("ARPACK finds the lowest eigenpairs of a chain") {
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(kMasses, kMasses);
  for (int i = 0; i < kMasses; ++i) {
    k(i, i) = i + 1 < kMasses ? 2.0 : 1.0;
    if (i > 0) k(i, i - 1) = k(i - 1, i) = -1.0;
  }
  ShiftInvertProblem problem;
  problem.size = kMasses;
  problem.count = kWanted;
  problem.solve = [&](const double* b, double* x) {
    Eigen::Map<Vector>(x, kMasses) = ldlt_solve(k, Vector(Eigen::Map<const Vector>(b, kMasses)));
  };
  const ShiftInvertResult found = arpack_shift_invert(problem);
  REQUIRE(found.status == ArpackStatus::success);
  REQUIRE(found.lambda.size() == kWanted);
  for (int i = 0; i < kWanted; ++i) {
    CAPTURE(i);
    CHECK(found.lambda[i] == Approx(closed_form(i)).epsilon(1e-11));
    const Vector x = found.vectors.col(i);
    CHECK(x.squaredNorm() == Approx(1.0).epsilon(1e-12));
    CHECK((k * x - found.lambda[i] * x).norm() <= 1e-11);
  }

  Model model("chain");
  for (int i = 0; i < kMasses; ++i) {
    const std::string name = std::to_string(i);
    model.add_node("n" + name);
    model.add<Inertia>("J" + name, {"n" + name}, {.inertia = 1.0});
    if (i > 0)
      model.add<ShaftSpring>("k" + name, {"n" + std::to_string(i - 1), "n" + name}, {.stiffness = 1.0});
    else
      model.add<GroundSpring>("k0", {"n0"}, {.stiffness = 1.0});
  }
  const ModeSet modes = solve_modes(model.build(), {.count = kWanted});
  REQUIRE(modes.count() == kWanted);
  for (int i = 0; i < kWanted; ++i)
    CHECK(modes.omega(i) * modes.omega(i) == Approx(found.lambda[i]).epsilon(1e-10));
}
