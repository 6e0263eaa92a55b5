#pragma once
/// Sturm count: how many eigenvalues of K x = lambda M x lie below s. By Sylvester's law of inertia
/// that is the number of negative pivots of
///
///   P (K - s M) P' = L D L'        M positive definite
///
/// It needs no eigenvector, so it checks any eigensolver: modes below s found = modes below s there
/// are. D is diagonal (no 2 x 2 pivots); a tiny pivot makes the factor grow, and then the count is
/// not trusted: take another s.
///
/// Source: B. N. Parlett, The Symmetric Eigenvalue Problem, SIAM 1998, section 3.3,
/// doi:10.1137/1.9781611971163.
#include <drev/core/system.hpp>

#include <memory>

namespace drev {

struct LowFillPattern;

struct SturmCount {
  bool trusted = false;  ///< false: do not use below; take another s
  int below = 0;         ///< eigenvalues < s
  /// max_i (|L| |D| |L'|)_ii / (|K| + |s| M)_ii: how much larger than the matrix its factor became.
  /// Trusted up to 1e6: s is then off by no more than about 1e-10 of the largest eigenvalue.
  double growth = 0.0;
};

class InertiaCounter {
 public:
  /// stiffness, mass: symmetric, values on the pattern, kept by reference. analysed: what a factorisation of
  /// the same pattern found (SparseCholesky::low_fill()), or null.
  InertiaCounter(const SparseMatrix& pattern, const Vector& stiffness, const Vector& mass,
                 std::shared_ptr<const LowFillPattern> analysed = nullptr);
  ~InertiaCounter();
  InertiaCounter(const InertiaCounter&) = delete;
  InertiaCounter& operator=(const InertiaCounter&) = delete;

  /// s in (rad/s)^2. A zero pivot is not trusted; throws SolverError where values are not finite or
  /// memory is out.
  SturmCount count_below(double s);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drev
