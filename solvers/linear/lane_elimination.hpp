#pragma once
/// LaneElimination: ComplexElimination for several sets of kLanes circular frequencies at once, in a processor's widest
/// vectors (core/lanes.hpp), each frequency with one right side:
///
///   (K + i (w C + H) - w^2 M) x = b      by L D L', places of all updates as ComplexElimination found them
///
/// H: imaginary parts of complex stiffnesses, with the sign of w. The sets are eliminated side by side: along a chain
/// each pivot waits for the one before, and the other sets fill that time. Row i of set s is at i kLaneSets + s.
///
/// No lane seeks pivots. Those that lose one to cancellation (ComplexElimination::kLostPivot) are told, and are solved
/// by ComplexElimination. Accuracy: as there.
#include <drev/core/lanes.hpp>

#include "solvers/linear/complex_elimination.hpp"

namespace drev {

inline constexpr int kLaneSets = 4;  ///< largest number of sets

/// Values of symmetric matrices on a pattern. Those of K and H are common to all lanes (Value double), or a row of
/// kLaneSets each (LaneRow).
template <class Value>
struct LaneDynamics {
  const double *m, *c;
  const Value *k, *h;
};

/// The value of a slot for a set of lanes.
[[gnu::always_inline]] inline const double& of_set(const double* values, int slot, int /*set*/) {
  return values[slot];
}
[[gnu::always_inline]] inline const LaneRow& of_set(const LaneRow* values, int slot, int set) {
  return values[slot * kLaneSets + set];
}

class LaneElimination {
 public:
  /// plan: outlives this.
  explicit LaneElimination(const ComplexElimination& plan);

  /// sets: number of them in use. w: frequencies of each set. b, x: a row for each unknown of the pattern; those of x
  /// that are held are left as they are. lost: for each set, 1 in the lanes whose x is not usable: a lost pivot, or
  /// values that are not finite; else 0.
  template <class Value>
  void solve(int sets, const LaneDynamics<Value>& dynamics, const LaneRow* w, const LaneRow* b_re,
             const LaneRow* b_im, LaneRow* x_re, LaneRow* x_im, LaneRow* lost);
  struct Work;  // arrays of its loops

 private:
  const ComplexElimination& plan_;
  LaneArray d_re_, d_im_, d_least_, l_re_, l_im_;
};

}  // namespace drev
