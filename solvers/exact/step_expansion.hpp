#pragma once
/// StepExpansion: one step of exact propagation from a state, on the pieces of laws that hold there.
///
/// The series of the motion (taylor_series.hpp) and what enters its right side: loads and known motions
/// (load_series.hpp) and smooth laws (projected_laws.hpp), whose projection along the path is repeated until
/// the path settles.
#include <optional>

#include "solvers/exact/friction_series.hpp"
#include "solvers/exact/law_series.hpp"
#include "solvers/exact/load_series.hpp"
#include "solvers/exact/projected_laws.hpp"
#include "solvers/exact/taylor_series.hpp"

namespace drev {

/// omega h of the longest step: bounds degree and growth of rounding.
inline constexpr double kFastestTimesStep = 3.0;

class StepExpansion {
 public:
  explicit StepExpansion(const System& system)
      : series(system), known(system), smooth(system), friction(system) {
    if (!friction.empty()) series.act_through(&friction);
  }
  StepExpansion(const StepExpansion&) = delete;

  struct Limits {
    double share = 0.0;      ///< of the tolerance, for this step
    double tolerance = 0.0;  ///< of the run
    double shortest = 0.0;   ///< s: in shorter steps what is left is an undeclared discontinuity, or rounding
  };
  /// What became of an attempt: the step that the series holds for, <= h [s]; 0 if its terms overflow; or,
  /// where to_knot, the step to try next, just behind the knot of a law.
  struct Attempt {
    double h = 0.0;
    bool to_knot = false;
  };
  /// Expands from `from`, where known was located, over h [s].
  Attempt attempt(const EvaluatedState& from, const LawSeries& laws, double h, const Limits& limits);

  /// Expands from `from`, where `other` was expanded over a step of h, over the part s of that step: at its
  /// end this series is exact where the other, in which kinks of tables are projected, is not. False where
  /// it has no series over that part.
  bool expand_part(const StepExpansion& other, const EvaluatedState& from, const LawSeries& laws, double s,
                   const Limits& limits);

  TaylorSeries series;
  LoadSeries known;
  ProjectedLaws smooth;
  FrictionSeries friction;

 private:
  double contraction_ = 1.0;  // of the last step: how the projection's change came back
};

/// The least tolerance of a step: below it is rounding.
inline constexpr double kLeastShare = 1e-16;

}  // namespace drev
