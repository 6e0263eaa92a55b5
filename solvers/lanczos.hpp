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
#include "solvers/arpack_shift_invert.hpp"

namespace drev {

/// Converged: |r| <= tolerance mu for `sharp` pairs, and sqrt(tolerance) mu for the rest of problem.count
/// (whose eigenvalues are then good to tolerance too). problem.basis: most vectors to keep; 0:
/// 3 count + 40. not_converged where these do not suffice. Throws what solve and mass throw.
ShiftInvertResult lanczos_shift_invert(const ShiftInvertProblem& problem, int sharp, double tolerance);

}  // namespace drev
