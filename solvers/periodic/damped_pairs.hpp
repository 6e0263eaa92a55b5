#pragma once
/// DampedPairs: damped modes of large systems, one by one, each from a guess (the undamped mode, or the same
/// mode at a neighbouring speed):
///
///   S(s) x = 0,  S(s) = K + s C + s^2 M
///   x <- S(s)^-1 (C + 2 s M) x,   s <- the root of x' S(s) x = 0 next to s       (x' without conjugation)
///
/// Each step takes one complex elimination, whose cost on chains and trees of shafts is proportional to the
/// number of nodes. Since the matrices are symmetric, x' S x is stationary at a mode and s converges
/// cubically. Where damping is light, the mode found is that of the guess; strong damping between modes may
/// lead two guesses to one mode, which the caller detects by lambda. Complex stiffnesses are those of their
/// Maxwell chains, as in damped_modes.hpp.
/// Source: P. Lancaster, Lambda-matrices and Vibrating Systems, Pergamon, 1966, section 7.3 (generalised Rayleigh
/// quotients), section 4.3 (residues).
#include <drev/core/system.hpp>

#include <complex>
#include <vector>

#include "solvers/linear/complex_elimination.hpp"

namespace drev {

class DampedPairs {
 public:
  /// The matrices are those with every contact closed.
  explicit DampedPairs(const System& system);
  /// damping: values on System::pattern(). lambda [1/s] and shape over the unknowns: a guess in, the mode
  /// out. False: no convergence, and both are as the last step left them.
  bool refine(const Vector& damping, std::complex<double>& lambda, Eigen::VectorXcd& shape);
  const Vector& damping() const { return damping_; }
  /// Of the response z(s) to forces p that grow as exp(s t), the residue at s = lambda[mode], with the damping at which these are
  /// damped modes. The matrices are symmetric: of a mode of its own x x' p / x' (2 lambda M + C) x, of modes X that coincide
  /// X N^-1 X' p, N_ij = x_i' ((lambda_i + lambda_j) M + C) x_j. A lambda of 0 is none.
  Eigen::VectorXcd residue(const Vector& damping, const Eigen::VectorXcd& lambda,
                           const Eigen::MatrixXcd& shapes, Eigen::Index mode,
                           const Eigen::VectorXcd& p) const;

 private:
  const SparseMatrix& pattern_;
  Vector mass_, damping_, stiffness_;
  ComplexElimination elimination_;
};

/// What residues at damped modes take, for each speed at which these are known.
struct DampedPoles {
  DampedPairs pairs;
  std::vector<Vector> damping = {};
  std::vector<Eigen::VectorXcd> lambda = {};  ///< of modes that coincide all; 0: not known
  std::vector<Eigen::MatrixXcd> shapes = {};  ///< over the unknowns
  Eigen::VectorXcd residue(std::size_t speed, int mode, const Eigen::VectorXcd& p) const {
    return pairs.residue(damping[speed], lambda[speed], shapes[speed], mode, p);
  }
};

}  // namespace drev
