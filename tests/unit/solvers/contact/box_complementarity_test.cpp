// Covers solvers/contact/box_complementarity.hpp: its conditions hold at random problems, singular ones too.
#include "solvers/contact/box_complementarity.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Complementarity between bounds: the conditions hold, with W singular and bounds infinite") {
  std::mt19937 random(7);
  const auto even = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 1 + trial % 6, rank = 1 + trial % 4;
    Eigen::MatrixXd b(rank, n);
    Eigen::VectorXd f(rank);
    for (double& x : b.reshaped()) x = even();
    for (double& x : f) x = 5.0 * even();
    BoxComplementarity p{.w = b.transpose() * b,
                         .r = b.transpose() * f,
                         .low = Eigen::VectorXd(n),
                         .high = Eigen::VectorXd(n),
                         .rounding = Eigen::VectorXd::Constant(n, 1e-11)};
    for (int i = 0; i < n; ++i) {
      const double most = trial % 5 == 0 ? 0.0 : std::abs(even()) * 3.0;
      p.low[i] = i % 3 == 2 ? -std::numeric_limits<double>::infinity() : -most;
      p.high[i] = i % 3 == 2 ? 0.0 : most;
    }
    const BoxSolution s = solve(p);
    INFO("trial " << trial);
    CHECK((s.a - (p.r - p.w * s.lambda)).cwiseAbs().maxCoeff() < 1e-12);
    for (int i = 0; i < n; ++i) {
      CHECK(s.lambda[i] <= p.high[i] + 1e-12);
      CHECK(s.lambda[i] >= p.low[i] - 1e-12);
      if (s.a[i] > 1e-9) CHECK(s.lambda[i] == p.high[i]);
      if (s.a[i] < -1e-9) CHECK(s.lambda[i] == p.low[i]);
    }
  }
}
