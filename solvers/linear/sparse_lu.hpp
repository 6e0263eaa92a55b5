#pragma once
/// Sparse LU factorisation with partial pivoting of an unsymmetric (or indefinite) matrix whose
/// pattern stays the same: analysed once, factored often, solved without allocating.
///
///   P R A Q = L U,  A x = b       (R: row scaling by the largest entry)
///
/// For tangents that are not symmetric and for shifts inside the spectrum; what must be positive
/// definite goes to SparseCholesky, which notices if it is not.
///
/// Source: T. A. Davis, E. Palamadai Natarajan, Algorithm 907: KLU, ACM TOMS 37(3), 2010,
/// doi:10.1145/1824801.1824814.
#include "solvers/linear/sparse_cholesky.hpp"

namespace drev {

class SparseLu {
 public:
  SparseLu();
  /// Analyses at once; a pattern that cannot be analysed is reported by factorize().
  explicit SparseLu(const SparseMatrix& pattern);
  ~SparseLu();
  SparseLu(SparseLu&&) noexcept;
  SparseLu& operator=(SparseLu&&) noexcept;

  /// Factors A. pattern: compressed, square; values: of A on that pattern, both triangles read. The
  /// first call analyses; later calls must bring the same pattern. They keep the pivot order of the
  /// first as long as pivot growth allows, and pivot again where it does not. Prints nothing, throws
  /// nothing.
  FactorStatus factorize(const SparseMatrix& pattern, const Vector& values);
  FactorStatus status() const;
  bool ok() const { return status() == FactorStatus::success; }

  /// x = A^-1 b; b and x may be the same vector. Allocates nothing after the first call. Throws
  /// SolverError without a factor and where b has another size.
  void solve(const Vector& b, Vector& x);

  /// Column (unknown) at which the factorisation failed, for the message; -1 where it did not or
  /// where the singularity belongs to no single column.
  int failed_column() const;
  /// min |U_jj| / max |U_jj| after row scaling, KLU's cheap estimate of 1 / cond(A); below 10 eps
  /// the status is singular. 0 without a factor.
  double reciprocal_condition() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drev
