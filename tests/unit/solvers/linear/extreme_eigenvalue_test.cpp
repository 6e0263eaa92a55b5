// The largest eigenvalue by power iteration, beside the closed form of a chain.
#include "solvers/linear/extreme_eigenvalue.hpp"

#include <drev/core/units.hpp>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Power iteration: the largest eigenvalue of a chain, from below") {
  // tridiag(-1, 2, -1) of n rows: 2 + 2 cos(pi / (n + 1)) at most.
  constexpr Eigen::Index kRows = 6;
  const double exact = 2.0 + 2.0 * std::cos(kPi / (kRows + 1));
  const auto chain = [](const Vector& x, Vector& y) {
    for (Eigen::Index i = 0; i < kRows; ++i)
      y[i] = 2.0 * x[i] - (i > 0 ? x[i - 1] : 0.0) - (i + 1 < kRows ? x[i + 1] : 0.0);
  };
  double last = 0.0;
  for (const int steps : {5, 20, 60, 200}) {
    const double size = extreme_eigenvalue(kRows, chain, {.steps = steps});
    CHECK(size > last * (1.0 - 1e-14));
    CHECK(size <= exact * (1.0 + 1e-14));
    last = size;
  }
  CHECK(last == Approx(exact).epsilon(1e-9));
}

TEST_CASE("Power iteration: a matrix of zeros, and products that are not finite") {
  CHECK(extreme_eigenvalue(3, [](const Vector&, Vector& y) { y.setZero(); }) == 0.0);
  CHECK(extreme_eigenvalue(3, [](const Vector& x, Vector& y) { y = x / 0.0 - x / 0.0; }) == 0.0);
}
