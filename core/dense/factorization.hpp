#pragma once
/// Linear equations with small dense matrices. Eigen's factorisations are compiled here once: their templates take seconds
/// of compilation wherever they are used. Those with reflections and that of complex matrices are LAPACK's. Sizes that do
/// not fit are errors of the caller, asserted by Eigen.
#include <drev/core/system.hpp>

#include <Eigen/LU>

namespace drev {

/// x of A x = b by elimination with row pivoting; a column of x for each column of b. A is square; where it is singular, x
/// is not finite.
Vector lu_solve(const Eigen::MatrixXd& a, const Vector& b);
Eigen::MatrixXd lu_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXcd lu_solve(const Eigen::MatrixXcd& a, const Eigen::VectorXcd& b);

/// A = P L U of a square A, for several right-hand sides.
class LuFactor {
 public:
  explicit LuFactor(const Eigen::MatrixXd& a);
  Vector solve(const Vector& b) const;  ///< as lu_solve
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
};

/// x of A x = b, A symmetric and positive or negative semidefinite (its lower triangle is read), by A = P' L D L' P.
Vector ldlt_solve(const Eigen::MatrixXd& a, const Vector& b);
Eigen::MatrixXd ldlt_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// A = L L', A symmetric and positive definite (its lower triangle is read).
class CholeskyFactor {
 public:
  explicit CholeskyFactor(const Eigen::MatrixXd& a);

  bool positive_definite() const { return positive_definite_; }
  const Eigen::MatrixXd& lower() const { return lower_; }  ///< L
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;   ///< A^-1 b
  Vector solve(const Vector& b) const;
  Eigen::MatrixXd inverse() const;                                         ///< A^-1
  Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& b) const;             ///< L^-1 b
  Eigen::MatrixXd solve_lower_transposed(const Eigen::MatrixXd& b) const;  ///< L^-T b

 private:
  Eigen::MatrixXd lower_;
  bool positive_definite_ = false;
};

/// The shortest x of those that make |A x - b| least, A of any shape and rank (complete orthogonal decomposition: Golub
/// and Van Loan, Matrix Computations, 2013, section 5.4.7). Condition numbers above 1/tolerance count as dependence;
/// tolerance 0: above 1/(n eps).
Vector least_squares(const Eigen::MatrixXd& a, const Vector& b, double tolerance = 0.0);

/// Orthonormal columns that span the x of A x = 0, by A' P = Q R with column pivoting; none: a matrix of no columns.
/// Pivots below n eps of the largest count as zero.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& a);

/// Q of A P = Q R by Householder's reflections with column pivoting, A square: orthonormal columns, of which the last span
/// what the columns of A do not.
Eigen::MatrixXd pivoted_basis(const Eigen::MatrixXd& a);

/// e^A of a square A, by scaling and squaring (Higham 2005, DOI 10.1137/04061101X).
Eigen::MatrixXd exponential(const Eigen::MatrixXd& a);

}  // namespace drev
