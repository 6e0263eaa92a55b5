#include "core/dense/factorization.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
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
  eigen_assert(a.rows() == a.cols() && a.rows() == b.size());
  const auto n = static_cast<int>(a.rows());
  const int one = 1, ld = std::max(n, 1);
  Eigen::MatrixXcd factored = a;
  Eigen::VectorXcd x = b;
  std::vector<int> pivots(static_cast<std::size_t>(n));
  int info = 0;
  zgesv_(&n, &one, factored.data(), &ld, pivots.data(), x.data(), &ld, &info);
  if (info != 0) x.setConstant(std::numeric_limits<double>::quiet_NaN());
  return x;
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

Vector least_squares(const Eigen::MatrixXd& a, const Vector& b, double tolerance) {
  Eigen::MatrixXd factored = a;
  const auto m = static_cast<int>(a.rows()), n = static_cast<int>(a.cols());
  const int ld = std::max(m, 1), ldb = std::max({m, n, 1}), one = 1;
  Vector x = Vector::Zero(ldb);
  x.head(m) = b;
  std::vector<int> pivots(static_cast<std::size_t>(n), 0);
  if (tolerance == 0.0) tolerance = rank_tolerance(a);
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

Eigen::MatrixXd exponential(const Eigen::MatrixXd& a) {
  const double norm = a.size() > 0 ? a.cwiseAbs().colwise().sum().maxCoeff() : 0.0;
  if (!std::isfinite(norm)) return a * std::numeric_limits<double>::quiet_NaN();
  // Degree m of Pade's approximant, and the largest norm at which it is exact to rounding (Higham's table 2.3).
  constexpr std::pair<int, double> kDegrees[] = {{3, 1.495585217958292e-2},
                                                 {5, 2.539398330063230e-1},
                                                 {7, 9.504178996162932e-1},
                                                 {9, 2.097847961257068}};
  constexpr double kMost = 5.371920351148152;
  int degree = 13;
  for (const auto& [m, most] : kDegrees)
    if (norm <= most) {
      degree = m;
      break;
    }
  const int halvings = norm > kMost ? static_cast<int>(std::ceil(std::log2(norm / kMost))) : 0;
  const Eigen::MatrixXd scaled = a * std::ldexp(1.0, -halvings), square = scaled * scaled;
  // p(A) = sum c_j A^j in even and odd powers, e^A = p(A)/p(-A).
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(a.rows(), a.cols());
  Eigen::MatrixXd even = power, odd = 0.5 * power;
  double c = 0.5;
  for (int j = 2; j <= degree; j += 2) {
    power = power * square;
    const auto next = [&](int k) { return c *= double(degree - k + 1) / (k * (2 * degree - k + 1)); };
    even += next(j) * power;
    if (j < degree) odd += next(j + 1) * power;
  }
  odd = scaled * odd;
  Eigen::MatrixXd result = lu_solve(even - odd, Eigen::MatrixXd(even + odd));
  for (int i = 0; i < halvings; ++i) result = result * result;
  return result;
}

}  // namespace drev
