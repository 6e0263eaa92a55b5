#pragma once
/// StepExpansion: one step of exact propagation from a state, on the pieces of laws that hold there.
///
/// The series of the motion (taylor_series.hpp) and what enters its right side: loads and known motions
/// (load_series.hpp), laws that are products of series (expanded_laws.hpp) and smooth laws (projected_laws.hpp), whose
/// projection along the path is repeated until the path settles.
#include <optional>

#include "solvers/exact/expanded_laws.hpp"
#include "solvers/exact/friction_series.hpp"
#include "solvers/exact/law_offsets.hpp"
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
      : series(system), known(system), offsets(system), smooth(system), expanded(system), friction(system) {
    if (!expanded.empty()) series.act_through(&expanded);
    if (!friction.empty()) series.act_through(&friction);  // which counts on all others
  }
  StepExpansion(const StepExpansion&) = delete;

  struct Limits {
    double share = 0.0;      ///< of the tolerance, for this step
    double tolerance = 0.0;  ///< of the run
    double shortest = 0.0;   ///< s: in shorter steps what is left is an undeclared discontinuity, or rounding
  };
  /// What became of an attempt: the step that the series holds for, <= h [s]; 0 if its terms overflow; or,
  /// where to_knot, the step to try next, as just behind the knot of a law.
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

  /// The laws' deflections and bounds along the step.
  void expand_laws(LawSeries& laws) {
    expanded.expand(series);
    laws.expand(series, known, offsets, [this](int law, std::vector<double>& scale) {
      if (!expanded.scale_of(law, series, scale)) smooth.expand_scale(law, series, scale);
    });
  }
  /// First s in (0, end] at which the angle of a law passes one of its knots.
  std::optional<double> first_knot(double end);
  /// Time [s] on either side of the knot last found for which rounding of the angle leaves the side open.
  double knot_clearance() const { return knot_clearance_; }
  /// A step that the series does not hold for can be shortened to what it does.
  bool shortens() const { return !known.projects() && smooth.empty() && expanded.empty(); }
  /// Of all laws but linear pieces, from 0 to s; end: what was evaluated at s.
  LawWork work(double s, const EvaluatedState& end) {
    LawWork sum = smooth.work(series, s, end);
    return sum += expanded.work(series, s, end);
  }

  TaylorSeries series;
  LoadSeries known;
  LawOffsets offsets;
  ProjectedLaws smooth;
  ExpandedLaws expanded;
  FrictionSeries friction;

 private:
  double knot_clearance_ = 0.0;
  double contraction_ = 1.0;  // of the last step: how the projection's change came back
};

/// The least tolerance of a step: below it is rounding.
inline constexpr double kLeastShare = 1e-16;

}  // namespace drev
