#pragma once
/// StepExpansion: one step of exact propagation from a state, on the pieces of laws that hold there.
///
/// The series of the motion (taylor_series.hpp) and what enters its right side: loads and known motions
/// (load_series.hpp), laws that are products of series (expanded_laws.hpp) and smooth laws (projected_laws.hpp), whose
/// projection along the path is repeated until the path settles.
#include <drev/solvers/run/observer.hpp>

#include <algorithm>
#include <optional>
#include <utility>

#include "solvers/exact/expanded_laws.hpp"
#include "solvers/exact/friction_series.hpp"
#include "solvers/exact/kink_response.hpp"
#include "solvers/exact/law_offsets.hpp"
#include "solvers/exact/law_series.hpp"
#include "solvers/exact/load_series.hpp"
#include "solvers/exact/projected_laws.hpp"
#include "solvers/exact/step_length.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

class StepExpansion {
 public:
  explicit StepExpansion(const System& system)
      : series(system),
        known(system, series),
        offsets(system),
        smooth(system),
        expanded(system),
        friction(system),
        kinks(series, known, expanded),
        system_(system),
        forces_(system.scalars().size()) {
    if (!known.expanded().loads().empty()) series.act_through(&known.expanded());
    if (!expanded.empty()) series.act_through(&expanded);
    if (!friction.empty()) series.act_through(&friction);  // which counts on all others
  }
  StepExpansion(const StepExpansion&) = delete;

  struct Limits {
    double share = 0.0;      ///< of the tolerance, for this step
    double tolerance = 0.0;  ///< of the run
    double shortest = 0.0;   ///< s: in shorter steps what is left is an undeclared discontinuity, or rounding
    double longest = 0.0;    ///< s: of a step with projected forces
  };
  /// What became of an attempt: the step that the series holds for, <= h [s]; 0 if its terms overflow; or,
  /// where again, the step to try next: one to just behind the knot of a law, or the same with what was learnt.
  struct Attempt {
    double h = 0.0;
    bool again = false;
    double longer =
        StepLength::kUnlimited;  ///< what is projected bears a next step of so many times the length
    bool stands = false;  ///< the series was expanded over h, and makes the step also where h is shorter
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
    for (Force& force : forces_) force.range_known = force.reach_known = false;
    expanded.expand(series);
    laws.expand(series, known, offsets, sweeps_ ? known.row_sizes() : nullptr,
                [this](int law, std::vector<double>& scale) {
                  if (!expanded.scale_of(law, series, scale)) smooth.expand_scale(law, series, scale);
                });
  }
  /// Whether kinks of the step add to the series by their response at each s, in place of a projection.
  bool sweeps() const { return sweeps_; }
  /// The unknowns and their rates at s of the step; not exactly: to 1e-9 of the motion, where it is swept. False: no
  /// response to kinks is found there.
  bool evaluate(double s, Vector& z, Vector& v, bool exactly = true);
  /// Returns to s after a look elsewhere in the step, so that loads stand where they are at s. room: for a state.
  void return_to(double s, State& room) {
    if (sweeps_ && kinks.end() != s) evaluate(s, room.z, room.v);
  }
  /// Whether steps may be swept from here on, or are to have passes in any case.
  void allow_sweeps(bool allowed) { refused_ = !allowed; }

  /// Observer::looks_inside() over the step up to s; jumps: accelerations may jump at an end of it, where nobody knows which one a
  /// point has, so that cubics tell nothing of rates.
  const double* beyond_cubic(double s, bool jumps);
  /// Into how many parts a step up to s is to be cut, so that cubics show what happens in each; angle: of the fastest mode [rad].
  double parts_to_watch(double angle, double s) const;
  /// StepMotion::force_range() up to s: of the series; what kinks add is within the error.
  std::optional<StepMotion::Range> force_range(const LawSeries& laws, int law, double s) {
    Force& force = forces_[idx(law)];
    if (!std::exchange(force.range_known, true)) force.range = find_force_range(laws, law, s);
    return force.range;
  }
  /// StepMotion::force_reach() from the step's start to where it ends, behind beyond_cubic() there.
  std::optional<StepMotion::Range> reach(const LawSeries& laws, int law, const EvaluatedState& from,
                                         const EvaluatedState& to) {
    Force& force = forces_[idx(law)];
    if (!std::exchange(force.reach_known, true)) force.reach = find_force_reach(laws, law, from, to);
    return force.reach;
  }
  /// StepMotion::range() up to s.
  StepMotion::Range range(const std::vector<Entry>& z, const std::vector<Entry>& v, double s);
  /// First s in (0, end] at which the angle of a law passes one of its knots.
  std::optional<double> first_knot(double end);
  /// Time [s] on either side of the knot last found for which rounding of the angle leaves the side open.
  double knot_clearance() const { return knot_clearance_; }
  /// Work of all that acts, from 0 to s; end: what was evaluated at s.
  LawWork work(const LawSeries& laws, double s, const EvaluatedState& end);
  /// First change of a step that is swept, and the s where the step ends. None: passes have to tell. t: time at its start;
  /// `at` is room for a state.
  struct SweptEnd {
    double s = 1.0;
    std::optional<LawSeries::Change> change = {};
    bool at_law_knot = false;
    bool by_kinks = false;  ///< what they do to each other ends the step
  };
  std::optional<SweptEnd> first_swept_change(LawSeries& laws, double t, State& at);

  TaylorSeries series;
  LoadSeries known;
  LawOffsets offsets;
  ProjectedLaws smooth;
  ExpandedLaws expanded;
  FrictionSeries friction;
  KinkResponse kinks;

 private:
  /// A step that the series does not hold for can be shortened to what it does.
  bool shortens() const {
    return !known.projects() && !known.expanded().active() && smooth.empty() && expanded.empty();
  }
  bool attempt_sweep(const EvaluatedState& from, const LawSeries& laws, double h, const Limits& limits,
                     Attempt& made);
  /// How far, at most, what is known of kinks at the step's end leaves the motion along a row inside: itself, and its rate by s.
  struct Inside {
    double value = 0.0, rate = 0.0;
  };
  Inside left_by_kinks(std::span<const Entry> row) const;
  std::optional<StepMotion::Range> find_force_range(const LawSeries& laws, int law, double s);
  std::optional<StepMotion::Range> find_force_reach(const LawSeries& laws, int law,
                                                    const EvaluatedState& from, const EvaluatedState& to);
  bool find_kinks(double s, State& at);
  template <class Later>
  std::optional<double> settle(double s, const Later& later, double t, State& at);

  const System& system_;
  LaneVector beyond_cubic_;
  std::vector<double> ranged_, scale_;  // series of what has a range
  struct Force {                        // of a law in the step at hand
    std::optional<StepMotion::Range> range, reach;
    bool range_known = false, reach_known = false;
  };
  std::vector<Force> forces_;
  bool sweeps_ = false, refused_ = false, expanded_ = false;
  double share_ = 0.0;
  double knot_clearance_ = 0.0;
  double contraction_ = 1.0;  // of the last step: how the projection's change came back
  // Change of the motion by the last step's first projection, relative to the motion.
  double first_change_ = 0.0;
};

/// The least tolerance of a step: below it is rounding.
inline constexpr double kLeastShare = 1e-16;

}  // namespace drev
