#pragma once
/// The largest eigenvalue of a matrix that is known by its products, by power iteration:
///
///   y = A x_k,   lambda = |y|,   x_(k+1) = y / |y|;   x_0: 1 + ripple sin(1 + 2 i), no rigid motion
///
/// For A = M^-1 K and the like, whose eigenvalues are real and not negative, lambda grows from step to step
/// towards the largest: what some steps lack is the caller's to allow for.
#include <drev/core/system.hpp>

#include <cmath>

namespace drev {

struct PowerIteration {
  int steps = 60;       ///< >= 1: products with the matrix
  double ripple = 0.5;  ///< of the start vector [-]
};

/// Size of the eigenvalue of A that is largest in size, from below; 0 where a product is zero or not finite.
/// apply(x, y): y = A x, for vectors of length n.
template <class Apply>
double extreme_eigenvalue(Eigen::Index n, const Apply& apply, const PowerIteration& iteration = {}) {
  Vector x(n), y(n);
  for (Eigen::Index i = 0; i < n; ++i)
    x[i] = 1.0 + iteration.ripple * std::sin(1.0 + 2.0 * static_cast<double>(i));
  double size = 0.0;
  for (int k = 0; k < iteration.steps; ++k) {
    apply(x, y);
    size = y.norm();
    if (!(size > 0.0)) return 0.0;
    x = y / size;
  }
  return size;
}

}  // namespace drev
