#pragma once
/// Eigenvalues of small dense matrices, by LAPACK.
#include <drev/core/system.hpp>

#include <Eigen/Core>

namespace drev {

struct SymmetricEigen {
  Vector values;            ///< ascending
  Eigen::MatrixXd vectors;  ///< a column each
  bool converged = false;
};

/// A x = lambda x, A symmetric (its lower triangle is read); vectors orthonormal.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);

/// A x = lambda B x, both symmetric, B positive definite; vectors with x' B x = 1.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

struct GeneralEigen {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd
      vectors;  ///< a column each, of length 1; none where it did not converge, or was not asked for
  bool converged = false;
};

/// A x = lambda x, A square. Entries that are not finite: not converged.
GeneralEigen general_eigen(const Eigen::MatrixXd& a);

/// Largest |lambda| of A x = lambda x, A square; NaN where the eigensolver did not converge.
double spectral_radius(const Eigen::MatrixXd& a);

}  // namespace drev
