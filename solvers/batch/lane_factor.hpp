#pragma once
/// A = L D L' for kLanes symmetric positive definite matrices of one pattern at once, each in its lane. Not
/// LL': without square roots a step has no division, and a pivot that is not positive is seen all the same.
/// Ordered from both ends of the unknowns' own order, in that order, or by AMD: the first that fills least.
#include <drev/core/lanes.hpp>
#include <drev/core/system.hpp>

#include <vector>

namespace drev {

class LaneFactor {
 public:
  LaneFactor() = default;
  /// pattern: compressed, structurally symmetric, with its diagonal. chain: it is the diagonal and both its
  /// neighbours, whole, of three rows at least.
  LaneFactor(const SparseMatrix& pattern, bool chain);

  /// values: on the pattern's slots. Lanes whose matrix is not positive definite, or singular except for
  /// rounding, are not ok().
  void factorize(const LaneArray& values);
  bool ok(int lane) const { return ok_[lane]; }

  /// x = A^-1 (b + factor c); x may be b or c.
  void solve(const LaneRow* b, double factor, const LaneRow* c, LaneRow* x) const;

  /// A row's or column's entries off the diagonal. near: one or two places from it stands its nearest entry,
  /// a row's last or a column's first; 0: none there.
  struct Step {
    int unknown, others, near;  // others: but that one
    void take_near(int places) {
      near = places <= 2 ? places : 0;
      others -= near != 0;
    }
  };

 private:
  std::vector<std::vector<int>> columns(const SparseMatrix& pattern, const std::vector<int>& order) const;

  int n_ = 0;
  std::vector<int> column_begin_, row_of_, unknown_of_;  // L by columns: places below the diagonal
  std::vector<int> row_slot_, left_unknown_;             // by rows: slots, unknowns to the left
  std::vector<Step> rows_, columns_;
  std::vector<int> pattern_slot_, pattern_target_;  // where A's lower triangle enters L; < 0: -1 - row of D
  std::vector<int> update_target_;                  // of every pair of rows of every column
  LaneValues lower_, by_rows_, inverse_;
  LaneArray pivot_;
  bool common_ = false;  // all lanes have one factor
  bool chain_ = false;
  bool ok_[kLanes] = {};
};

}  // namespace drev
