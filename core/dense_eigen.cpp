#include "core/dense_eigen.hpp"

#include <Eigen/Eigenvalues>

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
  return {solver.eigenvalues(), solver.eigenvectors(), solver.info() == Eigen::Success};
}

double spectral_radius(const Eigen::MatrixXd& a) {
  return general_eigen(a).values.cwiseAbs().maxCoeff();
}

}  // namespace drev
