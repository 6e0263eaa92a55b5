#include "core/dense_eigen.hpp"

#include <Eigen/Eigenvalues>
#include <limits>

namespace drev {

namespace {

template <class Solver>
SymmetricEigen pairs(const Solver& solver) {
  return {solver.eigenvalues(), solver.eigenvectors(), solver.info() == Eigen::Success};
}

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a) {
  return pairs(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a));
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return pairs(Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(a, b));
}

GeneralEigen general_eigen(const Eigen::MatrixXd& a) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(a);
  GeneralEigen found{solver.eigenvalues(), {}, solver.info() == Eigen::Success};
  if (found.converged) found.vectors = solver.eigenvectors();
  return found;
}

double spectral_radius(const Eigen::MatrixXd& a) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(a, false);
  if (solver.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace drev
