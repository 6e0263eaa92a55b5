/// Factorisations: what they must refuse, and solutions against a dense solver.
// Covers solvers/linear/cholmod_factor.hpp and low_fill_factor.hpp, between which SparseCholesky chooses.
#include "solvers/linear/sparse_cholesky.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <unistd.h>

#include "core/dense/factorization.hpp"
#include "solvers/linear/sparse_lu.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

SparseMatrix sparse(const Eigen::MatrixXd& dense) {
  SparseMatrix s = dense.sparseView();
  s.makeCompressed();
  return s;
}

Vector values(const SparseMatrix& s) { return Eigen::Map<const Vector>(s.valuePtr(), s.nonZeros()); }

/// Free-free chain: K of n equal springs, singular.
SparseMatrix free_chain(int n, double k) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i + 1 < n; ++i) {
    const double ki = k * (1.0 + 0.3 * std::sin(i));
    entries.insert(entries.end(), {{i, i, ki}, {i + 1, i + 1, ki}, {i, i + 1, -ki}, {i + 1, i, -ki}});
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
        CHECK(c.failed_column() == n / 2);  // where the two ends meet
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

namespace {

/// Diagonally dominant, with an entry for every pair of neighbours.
Eigen::MatrixXd dominant(int n, const std::vector<std::pair<int, int>>& neighbours) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t e = 0; e < neighbours.size(); ++e) {
    const auto& [i, j] = neighbours[e];
    a(i, j) = a(j, i) = -1.0 - 0.5 * std::sin(static_cast<double>(e));
  }
  const Vector sums = a.cwiseAbs().rowwise().sum();
  a.diagonal() = sums + Vector::LinSpaced(n, 0.5, 2.0);
  return a;
}

struct Shape {
  const char* name;
  int n;
  std::vector<std::pair<int, int>> neighbours;
  int fill;  ///< entries of L beyond those of A's triangle; -1: not known by itself
  std::vector<Ordering> orderings;
};

std::vector<Shape> shapes() {
  std::vector<Shape> all;
  const std::vector<Ordering> leaves{Ordering::from_leaves};
  const std::vector<Ordering> looped{Ordering::natural, Ordering::amd};
  for (const int n : {1, 2, 3, 9, 16, 17, 60, 61}) {
    Shape chain{"chain", n, {}, 0, leaves};
    for (int i = 0; i + 1 < n; ++i) chain.neighbours.push_back({i, i + 1});
    all.push_back(chain);
  }
  Shape star{"star", 60, {}, 0, leaves}, tree{"tree", 200, {}, 0, leaves}, parts{"forest", 40, {}, 0, leaves},
      ring{"ring", 30, {}, 27, looped}, ladder{"ladder", 60, {}, -1, looped}, full{"full", 60, {}, 0, looped};
  for (int i = 1; i < 60; ++i) star.neighbours.push_back({0, i});
  for (int i = 1; i < 200; ++i) tree.neighbours.push_back({(i * 7919 + 13) % i, i});
  for (int i = 0; i < 40; ++i)
    if (i % 10 != 9) parts.neighbours.push_back({i, i + 1});
  for (int i = 0; i < 30; ++i) ring.neighbours.push_back({i, (i + 1) % 30});
  for (int i = 0; i < 30; ++i) {
    ladder.neighbours.push_back({i, i + 30});
    if (i < 29) ladder.neighbours.insert(ladder.neighbours.end(), {{i, i + 1}, {i + 30, i + 31}});
  }
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < i; ++j) full.neighbours.push_back({i, j});
  all.insert(all.end(), {star, tree, parts, ring, ladder, full});
  return all;
}

}  // namespace

TEST_CASE("Cholesky solves as a dense solver does, trees without fill", "[SparseCholesky]") {
  for (const Shape& shape : shapes()) {
    INFO(shape.name << ' ' << shape.n);
    const int n = shape.n;
    const Eigen::MatrixXd dense = dominant(n, shape.neighbours);
    const SparseMatrix a = sparse(dense);
    SparseCholesky cholesky(a);
    REQUIRE(cholesky.factorize(a, values(a)) == FactorStatus::success);
    CHECK(std::count(shape.orderings.begin(), shape.orderings.end(), cholesky.ordering()) == 1);
    if (shape.fill >= 0)
      CHECK(cholesky.factor_entries() == n + static_cast<int>(shape.neighbours.size()) + shape.fill);
    const Vector b = Vector::LinSpaced(n, -1.0, 2.0);
    Vector x;
    cholesky.solve(b, x);
    // condition below 100: 14 digits
    CHECK((x - ldlt_solve(dense, b)).norm() < 1e-13 * x.norm());
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
  const SparseMatrix a = sparse(Eigen::MatrixXd(free_chain(5, 1.0)) + Eigen::MatrixXd::Identity(5, 5));
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

TEST_CASE("LU solves unsymmetric matrices and pivots again where it must", "[SparseLu]") {
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
