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
/// quotients).
#include <drev/core/system.hpp>

#include <complex>

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

 private:
  const SparseMatrix& pattern_;
  Vector mass_, damping_, stiffness_;
  ComplexElimination elimination_;
};

}  // namespace drev
