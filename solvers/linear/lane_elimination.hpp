#pragma once
/// LaneElimination: ComplexElimination for kLanes circular frequencies at once, in a processor's widest vectors
/// (core/lanes.hpp), each with one right side:
///
///   (K + i w C - w^2 M) x = b        by L D L', places of all updates as ComplexElimination found them
///
/// No lane seeks pivots. Those that lose one to cancellation (ComplexElimination::kLostPivot) are told, and are solved
/// by ComplexElimination. Accuracy: as there.
#include <drev/core/lanes.hpp>

#include "solvers/linear/complex_elimination.hpp"

namespace drev {

class LaneElimination {
 public:
  /// plan: outlives this.
  explicit LaneElimination(const ComplexElimination& plan);

  /// m, c, k: values of symmetric matrices on the plan's pattern; re, im: b -> x, a row an unknown. lost: 1 in the
  /// lanes whose x is not usable: a lost pivot, or values that are not finite; else 0.
  void solve(const double* m, const double* c, const double* k, const Lanes& w, LaneArray& re, LaneArray& im,
             Lanes& lost);
  /// The same with a C and a K for each lane.
  void solve(const double* m, const LaneRow* c, const LaneRow* k, const Lanes& w, LaneArray& re,
             LaneArray& im, Lanes& lost);
  struct Work;  // arrays of its loops

 private:
  Work work(LaneArray& re, LaneArray& im);

  const ComplexElimination& plan_;
  LaneArray d_re_, d_im_, l_re_, l_im_, w_re_, w_im_, x_re_, x_im_;
};

}  // namespace drev
