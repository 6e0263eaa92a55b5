// Linear complementarity problems by Lemke's method, and those of friction with gears, against every combination.
// Covers: solvers/contact/linear_complementarity.hpp solvers/contact/friction_complementarity.hpp
// solvers/modes/tied_system.hpp (through solve_modes in lossy_gear_test.cpp)
#include <Eigen/Core>
#include <random>

#include "core/dense/factorization.hpp"
#include "solvers/contact/friction_complementarity.hpp"
#include "solvers/contact/linear_complementarity.hpp"
#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Lemke's method finds the one solution that trying every set of variables finds") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Index n = 1 + trial % 6;
    Eigen::MatrixXd m = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return even(random); });
    // Positive definite, not symmetric: one solution.
    m = (m * m.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n) + (m - m.transpose())).eval();
    Eigen::VectorXd q = Eigen::VectorXd::NullaryExpr(n, [&] { return even(random); });
    if (trial % 5 == 0) q[0] = 0.0;
    const auto found = solve_complementarity(m, q);
    REQUIRE(found);
    int solutions = 0;
    for (int code = 0; code < (1 << n); ++code) {
      std::vector<Eigen::Index> basic;
      for (Eigen::Index i = 0; i < n; ++i)
        if (code >> i & 1) basic.push_back(i);
      Eigen::VectorXd z = Eigen::VectorXd::Zero(n);
      if (!basic.empty()) {
        const Eigen::MatrixXd part = m(basic, basic);
        const Eigen::VectorXd right = -q(basic);
        z(basic) = lu_solve(part, right);
      }
      if (z.minCoeff() < -1e-12 || (m * z + q).minCoeff() < -1e-10) continue;
      ++solutions;
      CHECK((z - found->z).norm() < 1e-9);
    }
    CHECK(solutions >= 1);
  }
  CHECK(solve_complementarity(Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2))->z.norm() == 0.0);
  CHECK(!solve_complementarity(-Eigen::MatrixXd::Identity(1, 1), -Eigen::VectorXd::Ones(1)));
}

TEST_CASE("Every set of variables: a solution of any matrix that has one, with what is wanted first") {
  const Eigen::MatrixXd negative = -Eigen::MatrixXd::Identity(2, 2);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(2);  // w = 1 - z: each of z is 0 or 1
  CHECK(try_every_set(negative, ones, {1, 0})->z == Eigen::Vector2d(1.0, 0.0));
  CHECK(try_every_set(negative, ones, {0, 1})->z == Eigen::Vector2d(0.0, 1.0));
  CHECK(try_every_set(negative, ones, {1, 0})->basic == std::vector<char>{1, 0});
  CHECK(!try_every_set(negative, -ones, {1, 0}));
  // Rows that are the same within rounding: one of them carries the load, though both are wanted.
  const Eigen::Matrix2d same{{1.0, 1.0}, {1.0, 1.0 + 1e-15}};
  CHECK(try_every_set(same, -ones, {1, 1})->basic == std::vector<char>{1, 0});
  const Eigen::Index many = kMostTried + 1;
  CHECK(!try_every_set(Eigen::MatrixXd::Identity(many, many), Eigen::VectorXd::Ones(many), {}));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Index n = 1 + trial % 5;
    const Eigen::MatrixXd m = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return even(random); });
    Eigen::VectorXd z = Eigen::VectorXd::NullaryExpr(n, [&] { return even(random); });
    const Eigen::VectorXd w = (-z).cwiseMax(0.0);
    z = z.cwiseMax(0.0);
    const Eigen::VectorXd q = w - m * z;
    const auto found = try_every_set(m, q, std::vector<char>(static_cast<std::size_t>(n), 0));
    REQUIRE(found);
    CHECK((m * found->z + q).minCoeff() > -1e-10);
    CHECK(std::abs(found->z.dot(m * found->z + q)) < 1e-9);
  }
}

TEST_CASE("A gear's loss stands on the greater of its two lines") {
  // Tie and loss of a gear between inertias of 1 and 1, ratio 1; efficiencies 0.5.
  const auto solved = [](double on_a, double on_b, int turns) {
    BoxComplementarity p;
    p.w.resize(2, 2);
    p.r.resize(2);
    p.w << 2.0, 1.0, 1.0, 1.0;
    p.r << on_a - on_b, on_a;
    p.low = Eigen::VectorXd::Constant(2, -INFINITY);
    p.high = -p.low;
    p.rounding = Eigen::VectorXd::Zero(2);
    GearLossRow gear{.loss = 1, .tie = 0};
    gear.high = {{1.0, 0.0, 0}, {-0.5, 0.0, 1}};
    gear.low = gear.high;
    gear.turns = turns;
    return solve(p, {gear});
  };
  const FrictionSolution drives = solved(3.0, 0.0, 1), driven = solved(0.0, 3.0, 1),
                         rest = solved(3.0, -2.0, 0);
  CHECK(drives.line == std::vector<int>{0});
  CHECK(drives.a[1] == Approx(3.0 / (1.0 + 1.0 / 0.5)));  // (J_a + J_b/eta) a = T
  CHECK(driven.line == std::vector<int>{1});
  CHECK(driven.a[1] == Approx(0.5 * 3.0 / (1.0 + 0.5)));
  CHECK(rest.side[1] == 0);  // 3 in, 2 out: less than 2/0.5 turns nothing
  CHECK(rest.lambda[1] == Approx(1.0));
}
