#pragma once
/// Shared by the factorisations of this folder only: the one place that includes cholmod.h.
/// Holds CHOLMOD's parameters, the analysed factor and the pattern it was analysed for. Silent.
#include <cholmod.h>
#include <vector>

#include "solvers/linear/sparse_cholesky.hpp"

namespace drev {

class CholmodFactor {
 public:
  /// ll: LL' (fails unless positive definite); otherwise LDL' (fails at a pivot that is exactly
  /// zero).
  explicit CholmodFactor(bool ll);
  ~CholmodFactor();
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  FactorStatus analyse(const SparseMatrix& pattern);
  /// Analyses where that was not done yet, then factors. Reads one triangle.
  FactorStatus factorize(const SparseMatrix& pattern, const Vector& values);
  bool solve(const Vector& b, Vector& x);

  int size() const { return size_; }
  cholmod_factor& factor() { return *factor_; }
  cholmod_common& common() { return common_; }
  /// Row of the matrix that stands at place j of the factor.
  int row(int j) const;
  std::vector<int> order() const;
  /// The pivot: L_jj (LL') or D_jj (LDL').
  double diagonal(int j) const;
  /// Column of A that could not be eliminated; -1 where none failed.
  int failed_column() const { return failed_column_; }

 private:
  bool same_pattern(const SparseMatrix& pattern) const;

  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *y_ = nullptr, *e_ = nullptr;  // workspace of cholmod_solve2
  std::vector<int> outer_, inner_;             // the pattern analysed
  int size_ = -1, failed_column_ = -1;
};

}  // namespace drev
