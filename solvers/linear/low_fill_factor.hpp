#pragma once
/// P A P' = L D L' of a symmetric matrix that hardly fills, in flat arrays in the order of elimination.
/// Internal to sparse_cholesky.cpp and sturm_count.cpp; what fills more is CHOLMOD's.
///
/// Order: a forest is eliminated from its leaves inwards, without any fill; a chain thus from both ends,
/// which gives two recurrences that do not wait for each other. Patterns with loops take CHOLMOD's order
/// (AMD's or their own), sorted by the height in its elimination tree, which changes no entry of L.
///
/// D is diagonal, without pivoting: for definite matrices, or to count signs.
///
/// Source: T. A. Davis, Direct Methods for Sparse Linear Systems, SIAM 2006, chapters 4 and 6,
/// doi:10.1137/1.9780898718881.
#include <memory>
#include <vector>

#include "solvers/linear/sparse_cholesky.hpp"

namespace drev {

/// Where everything stands, found once for a pattern. "Place": position in the order of elimination.
struct LowFillPattern {
  /// Columns of L from `begin` to `end`, not more than stay in the nearest caches. Stride 1, 2: each has one
  /// entry, that many places on, so that what it passes on stays in a register; 0: anything.
  struct Run {
    int begin, end, stride;
    int first_target;  ///< of its first column's products
    int reach;         ///< one beyond the last row that its columns have
  };
  int size = 0;
  Ordering ordering = Ordering::from_leaves;
  std::vector<int> outer, inner;  ///< the matrix's pattern
  std::vector<int> order;         ///< row of the matrix at each place
  std::vector<int> begin, rows;   ///< columns of L below the diagonal, places
  std::vector<int> diagonal;      ///< slots of A's values by place
  std::vector<int> slot;          ///< and by entry of L; -1: fill
  std::vector<int> target;        ///< entry of L that the product of two entries of a column goes to
  std::vector<Run> runs;

  bool same(const SparseMatrix& pattern) const;
};

/// pattern: structurally symmetric, compressed, with its diagonal. Null where L fills too much, or where
/// memory is out.
std::shared_ptr<const LowFillPattern> analyse_low_fill(const SparseMatrix& pattern);

class LowFillFactor {
 public:
  explicit LowFillFactor(std::shared_ptr<const LowFillPattern> pattern);

  const LowFillPattern& pattern() const { return *pattern_; }
  const std::shared_ptr<const LowFillPattern>& shared_pattern() const { return pattern_; }
  /// Factors; false at a pivot that is not > 0 (definite) or is 0 or not a number (otherwise), which is
  /// then at failed_place().
  bool factorize(const Vector& values, bool definite);
  int failed_place() const { return failed_; }
  double failed_pivot() const { return d_[failed_]; }
  /// min_j D_jj / A_jj of a definite matrix and the place of it.
  double pivot_ratio() const { return ratio_; }
  int worst_place() const { return worst_; }
  /// b and x may be the same.
  void solve(const Vector& b, Vector& x);
  /// The same with P A P', or what weigh() made of it.
  void solve_in_order(const double* b, double* x);
  /// Makes the factor that of W P A P' W, W = diag(weight) > 0, until the next factorize().
  void weigh(const Vector& weight);

  const Vector& inverse_pivots() const { return d_; }
  const Vector& entries() const { return l_; }

 private:
  std::shared_ptr<const LowFillPattern> pattern_;
  Vector d_, l_, y_;  // d_: 1/D, and D where it failed
  double ratio_ = 0.0;
  int worst_ = -1, failed_ = -1;
};

}  // namespace drev
