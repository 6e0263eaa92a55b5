#include "core/dense/eigenvalues.hpp"

#include <algorithm>
#include <complex>
#include <limits>
#include <vector>

#include "core/dense/factorization.hpp"
#include "core/dense/lapack.hpp"

namespace drev {

namespace {

/// Eigenvectors only where `with_vectors`.
GeneralEigen solve_general(Eigen::MatrixXd a, bool with_vectors) {
  const auto n = static_cast<int>(a.rows());
  GeneralEigen found;
  if (!a.allFinite()) return found;
  Eigen::VectorXd real(n), imaginary(n);
  Eigen::MatrixXd vectors(n, with_vectors ? n : 0);
  const char* const right = with_vectors ? "V" : "N";
  const int one = 1, ld = n > 0 ? n : 1;
  int info = 0;
  with_workspace([&](double* work, const int* lwork) {
    dgeev_("N", right, &n, a.data(), &ld, real.data(), imaginary.data(), nullptr, &one, vectors.data(), &ld,
           work, lwork, &info, 1, 1);
  });
  found.converged = info == 0;
  if (!found.converged) return found;
  found.values.resize(n);
  for (int j = 0; j < n; ++j) found.values[j] = {real[j], imaginary[j]};
  if (!with_vectors) return found;
  found.vectors.resize(n, n);
  for (int j = 0; j < n; ++j) {
    if (imaginary[j] == 0.0) {
      found.vectors.col(j) = vectors.col(j).cast<std::complex<double>>();
      continue;
    }
    // A pair: the real and the imaginary part of the first's vector.
    for (int i = 0; i < n; ++i) {
      found.vectors(i, j) = {vectors(i, j), vectors(i, j + 1)};
      found.vectors(i, j + 1) = std::conj(found.vectors(i, j));
    }
    ++j;
  }
  return found;
}

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a) {
  eigen_assert(a.rows() == a.cols());
  const auto n = static_cast<int>(a.rows());
  SymmetricEigen found{Vector(n), a, false};
  if (!a.allFinite()) return found;
  const int ld = std::max(n, 1), liwork = 5 * n + 3;  // as much as vectors want
  std::vector<int> iwork(static_cast<std::size_t>(liwork));
  int info = 0;
  with_workspace([&](double* work, const int* lwork) {
    dsyevd_("V", "L", &n, found.vectors.data(), &ld, found.values.data(), work, lwork, iwork.data(), &liwork,
            &info, 1, 1);
  });
  found.converged = info == 0;
  return found;
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  // B = L L': L^-1 A L^-T y = lambda y, x = L^-T y.
  const CholeskyFactor factor(b);
  if (!factor.positive_definite()) return {};
  const Eigen::MatrixXd whole = a.selfadjointView<Eigen::Lower>();
  SymmetricEigen found = symmetric_eigen(factor.solve_lower(factor.solve_lower(whole).transpose()));
  found.vectors = factor.solve_lower_transposed(found.vectors);
  return found;
}

GeneralEigen general_eigen(const Eigen::MatrixXd& a) { return solve_general(a, true); }

double spectral_radius(const Eigen::MatrixXd& a) {
  const GeneralEigen found = solve_general(a, false);
  if (!found.converged) return std::numeric_limits<double>::quiet_NaN();
  return found.values.cwiseAbs().maxCoeff();
}

}  // namespace drev
