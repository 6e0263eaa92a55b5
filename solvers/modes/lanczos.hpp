#pragma once
/// The lowest eigenpairs of K x = lambda M x by Lanczos on the shifted and inverted problem of
/// arpack_shift_invert.hpp, without restarts: all vectors are kept, so that far fewer solves are needed.
///
///   M (K - sigma M)^-1 M Q = M Q T + ...,   Q' M Q = I,   T tridiagonal
///
/// The basis is kept orthogonal within sqrt(eps) by reorthogonalising two vectors at a time, only where
/// the recurrence of the errors says so; T is then exact within eps. Repeated eigenvalues come one copy at a
/// time, further ones from rounding: a Sturm count must say whether all are there.
///
/// Source: H. D. Simon, The Lanczos algorithm with partial reorthogonalization, Math. Comp. 42, 1984,
/// doi:10.1090/S0025-5718-1984-0725988-X.
#include <memory>

#include "solvers/modes/arpack_shift_invert.hpp"

namespace drev {

/// Converged: |r| <= tolerance mu; not_converged where the most vectors that may be kept do not suffice
/// (problem.basis; 0: 3 count + 40). Throws what solve and mass throw.
class ShiftInvertLanczos {
 public:
  explicit ShiftInvertLanczos(ShiftInvertProblem problem);
  ~ShiftInvertLanczos();
  int count() const;

  /// The lowest eigenvalues alone, fewer than problem.count; may be called again, and goes on from there.
  ShiftInvertResult values(int count, double tolerance);
  /// problem.count pairs, which end it: those behind the first `sharp` to sqrt(tolerance), which makes their
  /// eigenvalues good to tolerance too.
  ShiftInvertResult pairs(int sharp, double tolerance);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drev
