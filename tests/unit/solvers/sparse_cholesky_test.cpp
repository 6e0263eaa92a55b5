/// Factorisations: what they must refuse, and solutions against a dense solver.
#include "solvers/sparse_cholesky.hpp"

#include <unistd.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <limits>

#include "solvers/sparse_lu.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

SparseMatrix sparse(const Eigen::MatrixXd& dense) {
  SparseMatrix s = dense.sparseView();
  s.makeCompressed();
  return s;
}

Vector values(const SparseMatrix& s) {
  return Eigen::Map<const Vector>(s.valuePtr(), s.nonZeros());
}

/// Free-free chain: K of n equal springs, singular.
SparseMatrix free_chain(int n, double k) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i + 1 < n; ++i) {
    const double ki = k * (1.0 + 0.3 * std::sin(i));
    entries.insert(entries.end(),
                   {{i, i, ki}, {i + 1, i + 1, ki}, {i, i + 1, -ki}, {i + 1, i, -ki}});
  }
  SparseMatrix s(n, n);
  s.setFromTriplets(entries.begin(), entries.end());
  return s;
}

/// What is written to a file descriptor while f runs.
template <class F>
long bytes_written_to(int descriptor, F&& f) {
  std::fflush(nullptr);
  std::FILE* file = std::tmpfile();
  const int saved = dup(descriptor);
  dup2(fileno(file), descriptor);
  f();
  std::fflush(nullptr);
  dup2(saved, descriptor);
  close(saved);
  std::fseek(file, 0, SEEK_END);
  const long bytes = std::ftell(file);
  std::fclose(file);
  return bytes;
}

}  // namespace

TEST_CASE("Cholesky refuses what is not positive definite", "[SparseCholesky]") {
  SparseCholesky cholesky;
  CHECK(cholesky.status() == FactorStatus::not_computed);
  CHECK_FALSE(cholesky.ok());
  Vector x;
  CHECK_THROWS_AS(cholesky.solve(Vector::Ones(2), x), SolverError);

  SECTION("diag(1, -1)") {
    const SparseMatrix a = sparse(Eigen::Vector2d(1.0, -1.0).asDiagonal().toDenseMatrix());
    CHECK(cholesky.factorize(a, values(a)) == FactorStatus::not_positive_definite);
    CHECK(cholesky.failed_column() == 1);
    CHECK(cholesky.reciprocal_condition() == 0.0);
    CHECK_THROWS_AS(cholesky.solve(Vector::Ones(2), x), SolverError);
  }
  SECTION("free-free chains, exactly singular: no pivot with a digit is left") {
    for (const int n : {2, 3, 8, 50, 500, 5000})
      for (const double k : {1.0, 0.1, 1e7 / 3.0}) {
        SparseCholesky c;
        const SparseMatrix a = free_chain(n, k);
        const FactorStatus status = c.factorize(a, values(a));
        CHECK((status == FactorStatus::singular || status == FactorStatus::not_positive_definite));
        CHECK(c.failed_column() == n - 1);
      }
  }
  SECTION("the same chain, held by a soft spring, is accepted") {
    const SparseMatrix a = free_chain(50, 1e7);
    Vector v = values(a);
    v[0] += 1.0;  // K(0, 0): 1e-7 of its neighbours
    REQUIRE(cholesky.factorize(a, v) == FactorStatus::success);
    cholesky.solve(Vector::Ones(50), x);
    // 50 torques of 1 N m through the ground spring of 1 N m/rad; a digit count of 16 less 7
    CHECK(x[0] == Approx(50.0).epsilon(1e-7));
  }
  SECTION("units alone make no matrix singular") {
    const SparseMatrix a = sparse(Eigen::Vector2d(1.0, 1e-30).asDiagonal().toDenseMatrix());
    REQUIRE(cholesky.factorize(a, values(a)) == FactorStatus::success);
    CHECK(cholesky.pivot_ratio() == 1.0);
    CHECK(cholesky.reciprocal_condition() == Approx(1e-30));
  }
  SECTION("values that are not finite") {
    const SparseMatrix a = free_chain(5, 1.0);
    Vector v = values(a);
    v[3] = std::numeric_limits<double>::quiet_NaN();
    CHECK(cholesky.factorize(a, v) == FactorStatus::not_finite);
    v[3] = std::numeric_limits<double>::infinity();
    CHECK(cholesky.factorize(a, v) == FactorStatus::not_finite);
  }
}

TEST_CASE("Cholesky solves as a dense solver does, in natural order and with AMD",
          "[SparseCholesky]") {
  const int n = 60;
  Eigen::MatrixXd chain = Eigen::MatrixXd(free_chain(n, 3.0)) + Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd arrow = 70.0 * Eigen::MatrixXd::Identity(n, n);
  arrow.row(0).setOnes();
  arrow.col(0).setOnes();
  arrow(0, 0) = 70.0;
  for (const bool natural : {true, false}) {
    const Eigen::MatrixXd dense = natural ? chain : arrow;
    const SparseMatrix a = sparse(dense);
    SparseCholesky cholesky(a);
    REQUIRE(cholesky.factorize(a, values(a)) == FactorStatus::success);
    CHECK(cholesky.natural_order() == natural);
    CHECK(cholesky.factor_entries() == 2 * n - 1);  // neither fills
    const Vector b = Vector::LinSpaced(n, -1.0, 2.0);
    Vector x;
    cholesky.solve(b, x);
    // condition below 100: 14 digits
    CHECK((x - dense.ldlt().solve(b)).norm() < 1e-13 * x.norm());
    Vector y = b;
    cholesky.solve(y, y);
    CHECK(y == x);
    // other values, same analysis
    REQUIRE(cholesky.factorize(a, 2.0 * values(a)) == FactorStatus::success);
    cholesky.solve(b, y);
    CHECK((2.0 * y - x).norm() < 1e-14 * x.norm());
    // after a failure it works again
    CHECK(cholesky.factorize(a, -values(a)) == FactorStatus::not_positive_definite);
    CHECK(cholesky.factorize(a, values(a)) == FactorStatus::success);
    CHECK(cholesky.failed_column() == -1);
    CHECK_THROWS_AS(cholesky.solve(Vector::Ones(n + 1), y), SolverError);
  }
}

TEST_CASE("Factors insist on the pattern they were analysed for", "[SparseCholesky][SparseLu]") {
  const SparseMatrix a =
      sparse(Eigen::MatrixXd(free_chain(5, 1.0)) + Eigen::MatrixXd::Identity(5, 5));
  Eigen::MatrixXd other = Eigen::MatrixXd(a);
  other(0, 4) = other(4, 0) = 0.1;
  const SparseMatrix b = sparse(other);
  SparseCholesky cholesky(a);
  CHECK(cholesky.factorize(b, values(b)) == FactorStatus::pattern_changed);
  CHECK(cholesky.factorize(a, Vector::Ones(3)) == FactorStatus::pattern_changed);
  CHECK(cholesky.factorize(a, values(a)) == FactorStatus::success);
  SparseLu lu(a);
  CHECK(lu.factorize(b, values(b)) == FactorStatus::pattern_changed);
  CHECK(lu.factorize(a, Vector::Ones(3)) == FactorStatus::pattern_changed);
  CHECK(lu.factorize(a, values(a)) == FactorStatus::success);
}

TEST_CASE("Factors print nothing", "[SparseCholesky][SparseLu]") {
  const auto fail = [] {
    SparseCholesky cholesky;
    const SparseMatrix a = sparse(Eigen::Vector2d(1.0, -1.0).asDiagonal().toDenseMatrix());
    cholesky.factorize(a, values(a));
    SparseLu lu;
    lu.factorize(a, Vector::Zero(2));
  };
  CHECK(bytes_written_to(STDOUT_FILENO, fail) == 0);
  CHECK(bytes_written_to(STDERR_FILENO, fail) == 0);
}

TEST_CASE("A factor can be moved", "[SparseCholesky]") {
  const SparseMatrix a = sparse(Eigen::MatrixXd::Identity(3, 3));
  SparseCholesky first(a);
  first.factorize(a, values(a));
  SparseCholesky second = std::move(first);
  Vector x;
  second.solve(Vector::Ones(3), x);
  CHECK(x == Vector::Ones(3));
}

TEST_CASE("LU solves unsymmetric matrices and pivots anew where it must", "[SparseLu]") {
  Eigen::MatrixXd dense = Eigen::MatrixXd(free_chain(30, 1.0));
  dense(3, 4) = 7.0;
  dense(0, 0) = -2.0;
  const SparseMatrix a = sparse(dense);
  SparseLu lu;
  REQUIRE(lu.factorize(a, values(a)) == FactorStatus::success);
  const Vector b = Vector::LinSpaced(30, -1.0, 2.0);
  Vector x;
  lu.solve(b, x);
  CHECK((dense * x - b).norm() < 1e-12 * x.norm());

  // [tiny 1; 1 1] after a factor that pivoted on the diagonal: x = (1, 1) to 14 digits only with
  // new pivots
  const SparseMatrix two = sparse((Eigen::Matrix2d() << 1.0, 0.5, 0.5, 1.0).finished());
  SparseLu small(two);
  REQUIRE(small.factorize(two, values(two)) == FactorStatus::success);
  REQUIRE(small.factorize(two, Eigen::Vector4d(1e-14, 1.0, 1.0, 1.0)) == FactorStatus::success);
  small.solve(Eigen::Vector2d(1.0, 2.0), x);
  CHECK(x[0] == Approx(1.0).epsilon(1e-13));
  CHECK(x[1] == Approx(1.0).epsilon(1e-13));

  CHECK(small.factorize(two, Vector::Ones(4)) == FactorStatus::singular);
  CHECK_THROWS_AS(small.solve(Vector::Ones(2), x), SolverError);
  CHECK(small.factorize(two, Vector::Constant(4, NAN)) == FactorStatus::not_finite);
}
