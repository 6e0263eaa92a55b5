#include "core/dense/factorization.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "core/dense/lapack.hpp"

namespace drev {

namespace {

/// Below this share of the largest pivot a column depends on those before it.
double rank_tolerance(const Eigen::MatrixXd& a) {
  return std::numeric_limits<double>::epsilon() * static_cast<double>(std::max(a.rows(), a.cols()));
}

/// A P = Q R with column pivoting: all columns of Q, and the rank.
struct PivotedQr {
  Eigen::MatrixXd q;
  Eigen::Index rank = 0;
};

PivotedQr pivoted_qr(const Eigen::MatrixXd& a) {
  const auto m = static_cast<int>(a.rows()), n = static_cast<int>(a.cols()), k = std::min(m, n);
  const int ld = std::max(m, 1);
  PivotedQr found{Eigen::MatrixXd::Zero(m, std::max(m, n)), 0};
  found.q.leftCols(n) = a;
  std::vector<int> pivots(static_cast<std::size_t>(n), 0);
  std::vector<double> tau(static_cast<std::size_t>(std::max(k, 1)));
  int info = 0;
  with_workspace([&](double* work, const int* lwork) {
    dgeqp3_(&m, &n, found.q.data(), &ld, pivots.data(), tau.data(), work, lwork, &info);
  });
  const double least = k > 0 ? rank_tolerance(a) * std::abs(found.q(0, 0)) : 0.0;
  while (found.rank < k && std::abs(found.q(found.rank, found.rank)) > least) ++found.rank;
  with_workspace([&](double* work, const int* lwork) {
    dorgqr_(&m, &m, &k, found.q.data(), &ld, tau.data(), work, lwork, &info);
  });
  found.q.conservativeResize(Eigen::NoChange, m);
  return found;
}

}  // namespace

LuFactor::LuFactor(const Eigen::MatrixXd& a) : factor_(a) {}
Vector LuFactor::solve(const Vector& b) const { return factor_.solve(b); }
Eigen::MatrixXd LuFactor::solve(const Eigen::MatrixXd& b) const { return factor_.solve(b); }

Vector lu_solve(const Eigen::MatrixXd& a, const Vector& b) { return LuFactor(a).solve(b); }
Eigen::MatrixXd lu_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return LuFactor(a).solve(b); }

Eigen::VectorXcd lu_solve(const Eigen::MatrixXcd& a, const Eigen::VectorXcd& b) {
  return Eigen::PartialPivLU<Eigen::MatrixXcd>(a).solve(b);
}

Eigen::MatrixXd ldlt_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return Eigen::LDLT<Eigen::MatrixXd>(a).solve(b);
}

Vector ldlt_solve(const Eigen::MatrixXd& a, const Vector& b) {
  return Eigen::LDLT<Eigen::MatrixXd>(a).solve(b);
}

CholeskyFactor::CholeskyFactor(const Eigen::MatrixXd& a) {
  const Eigen::LLT<Eigen::MatrixXd> factor(a);
  positive_definite_ = factor.info() == Eigen::Success;
  lower_ = factor.matrixL();
}

Eigen::MatrixXd CholeskyFactor::solve(const Eigen::MatrixXd& b) const {
  return solve_lower_transposed(solve_lower(b));
}

Vector CholeskyFactor::solve(const Vector& b) const {
  Vector x = lower_.triangularView<Eigen::Lower>().solve(b);
  lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(x);
  return x;
}

Eigen::MatrixXd CholeskyFactor::inverse() const {
  return solve(Eigen::MatrixXd(Eigen::MatrixXd::Identity(lower_.rows(), lower_.rows())));
}

Eigen::MatrixXd CholeskyFactor::solve_lower(const Eigen::MatrixXd& b) const {
  return lower_.triangularView<Eigen::Lower>().solve(b);
}

Eigen::MatrixXd CholeskyFactor::solve_lower_transposed(const Eigen::MatrixXd& b) const {
  return lower_.triangularView<Eigen::Lower>().transpose().solve(b);
}

Vector least_squares(const Eigen::MatrixXd& a, const Vector& b) {
  Eigen::MatrixXd factored = a;
  const auto m = static_cast<int>(a.rows()), n = static_cast<int>(a.cols());
  const int ld = std::max(m, 1), ldb = std::max({m, n, 1}), one = 1;
  Vector x = Vector::Zero(ldb);
  x.head(m) = b;
  std::vector<int> pivots(static_cast<std::size_t>(n), 0);
  const double tolerance = rank_tolerance(a);
  int rank = 0, info = 0;
  with_workspace([&](double* work, const int* lwork) {
    dgelsy_(&m, &n, &one, factored.data(), &ld, x.data(), &ldb, pivots.data(), &tolerance, &rank, work, lwork,
            &info);
  });
  return x.head(n);
}

Eigen::MatrixXd null_space(const Eigen::MatrixXd& a) {
  const PivotedQr rows = pivoted_qr(a.transpose());
  return rows.q.rightCols(a.cols() - rows.rank);
}

Eigen::MatrixXd pivoted_basis(const Eigen::MatrixXd& a) { return pivoted_qr(a).q; }

Eigen::MatrixXd exponential(const Eigen::MatrixXd& a) { return a.exp(); }

}  // namespace drev
