#pragma once
/// LoadSeries: loads, nominal motion and prescribed motions as polynomials over a step, for
/// TaylorSeries.
///
/// A load in its stretch is linear in t and theta: its constant goes to the right side, its slope
/// against the deviation to the stiffness's diagonal. Smooth loads that state themselves are series (expanded_loads.hpp).
/// Knots that theta(s) passes in the step add kinks, and loads that can only be called what they differ from their
/// tangent: both are projected on polynomials (legendre_projection.hpp) along the path that the series gives, and the series
/// is expanded anew until the path settles. Motions are polynomials of degree 2 between their breakpoints.
#include <optional>

#include "solvers/exact/expanded_loads.hpp"
#include "solvers/exact/kink_moments.hpp"
#include "solvers/exact/kink_sizes.hpp"
#include "solvers/exact/projected_laws.hpp"
#include "solvers/exact/smooth_loads.hpp"
#include "solvers/exact/straight_loads.hpp"
#include "solvers/series/legendre_projection.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

class LoadSeries {
 public:
  LoadSeries(const System& system, TaylorSeries& series);
  LoadSeries(const LoadSeries&) = delete;
  /// Loads that are series themselves.
  ExpandedLoads& expanded() { return expanded_; }
  const ExpandedLoads& expanded() const { return expanded_; }

  /// Moves to a state: known motions at t, and each load's stretch ahead of its angle. At the start
  /// and after breakpoints.
  void locate(double t, const Vector& z, const Vector& v);
  /// Moves to a state further on in the step; not to where they stand: there, loads at rest on a knot keep the side to which
  /// pass_knot() has put them. whole: it is the end of what was projected last, where loads are on the stretch that they
  /// came to.
  void advance(double t, const Vector& z, const Vector& v, bool whole);

  /// Takes over where loads of the same system were located, for a part of their step: of kinks, it ends at none.
  void locate_as(const LoadSeries& other);

  /// Adds the right side over a step of h seconds and the loads' tangents.
  void add_to(TaylorSeries& series, double h);
  /// Whether some are known only where they are called.
  bool called() const { return smooth_.called(); }
  /// False: no load can differ from what add_to() adds.
  bool projects() const { return !straight_.empty() || !smooth_.empty() || expanded_.knotted(); }
  /// The part of the step for which the loads' polynomials hold, <= 1; and whether, along the series, some angle came
  /// further than was reckoned with: then the step is to be expanded anew.
  double part_held() const { return expanded_.part_held(); }
  bool came_further(const TaylorSeries& series) { return expanded_.came_further(series); }

  /// One pass of the fixed-point iteration between the forces' projection and the path that they lead to.
  /// Relative to the largest deflection and speed [-].
  struct Pass {
    /// Change of the motion by what this pass changed of the forces' projection; 0: nothing to project.
    double change = 0.0;
    /// Contraction factor: of a change of the motion, the part that the next pass changes again, estimated
    /// from the forces' slopes, h^2/2 |df/dx| / m. The iteration settles where it is below 1.
    double contraction = 0.0;
    /// Error of the motion at the step's end by what no polynomial of the projection's degree holds of the forces.
    double residual = 0.0;
    /// The same inside the step, of smooth forces; and at the end, by what changes faster than nodes show.
    double inside = 0.0, unseen = 0.0;
    /// s of a knot that leaves too much of the motion inside the step: the step should end there.
    std::optional<double> cut = {};
    /// Where friction holds: what the projection lacks of a force, relative to the largest force on its row so far. It tells when
    /// a contact lets go, also where nothing moves.
    double torque = 0.0;
    bool follows = false;  ///< some load that is called follows the motion
  };
  /// Projects the forces, those of smooth laws too, along the series' path and puts them on its right side.
  /// first: the step is new. held: some friction contact is stuck; carried: the largest torque of one.
  Pass project(TaylorSeries& series, ProjectedLaws& laws, bool first, bool held, double carried);
  /// Where the path has settled: Pass::unseen of what loads and laws do between the nodes. most: what may be left unseen.
  double unseen_between(const TaylorSeries& series, ProjectedLaws& laws, bool held, double most);
  /// After a pass over a step that leaves too much: where that is rounding of forces, since a longer step from the same start
  /// left no more, the length of that one [s]. Passes leave as much out of account from then on.
  std::optional<double> find_rounding(const ProjectedLaws& laws);
  /// For a sweep (kink_response.hpp) in place of passes: lists the kinks that loads pass up to s = end of the step, where
  /// the series stands at z_end; the loads are then on the stretches behind them. The whole step first. False: some
  /// angle may turn back, or its load has a kink in time.
  bool list_sweep_kinks(TaylorSeries& series, double end, const double* z_end);
  /// Gives each kink listed the terms of its load's angle, no more than so many, which are three at least: those of the nominal
  /// motion.
  void expand_kinks(const TaylorSeries& series, std::size_t most);
  /// By row of the series over a whole step that was listed, TaylorSeries::ranges()' bounds.
  const double* row_sizes() const { return ranges_.data() + stride_; }
  KinkMoments& kinks() { return kinks_; }
  const KinkMoments& kinks() const { return kinks_; }
  /// Puts the loads' slopes at s, behind the kinks listed, in place of those at the step's start; and those back.
  void use_slopes(TaylorSeries& series, double s) {
    series.add_row_stiffness(kinks_.count(), kinks_.rows(), kinks_.slopes(), -1.0);
    expanded_.use_slopes(series, s);
  }
  void return_slopes(TaylorSeries& series) {
    expanded_.return_slopes(series);
    series.add_row_stiffness(kinks_.count(), kinks_.rows(), kinks_.slopes(), 1.0);
  }
  /// Some of them are on one row.
  bool kinks_share_rows() const { return shared_rows_; }
  const KinkSizes& kink_sizes() const { return kink_sizes_; }
  /// Work up to s of the kinks' forces, and of all others on the motion that they add [J].
  double kink_work(const TaylorSeries& series, double s) const;
  /// Kinks are all that bends loads beyond the series.
  bool kinks_alone() const { return (!straight_.empty() || expanded_.knotted()) && smooth_.empty(); }
  /// Whether the right side holds a projection, for this step and no shorter one.
  bool projected() const { return projected_; }
  /// Whether kinks were projected: the series is exact at the step's end, but inside it is off by what no
  /// polynomial holds of them, up to 1e-6 of the motion.
  bool kinked() const { return kinks_.count() > 0 || smooth_.kinked(); }
  /// How far slopes of curved forces behind knots come from those at the knots, as ExpandedLoads::SlopeChange::by_angle.
  double slope_behind() const { return slope_behind_; }
  /// Bound of what kinks leave inside the step, relative to the motion.
  double kinks_inside() const { return smooth_.kinked() ? kMostInside : kinks_inside_; }
  /// Appends every s in (0, end) at which a load passes a knot inside the step, loads on prescribed nodes too.
  void append_knots(double end, std::vector<double>& s) const;
  /// The step became r h; only where nothing was projected.
  void shorten(double r);

  /// Prescribed motion k as a polynomial over the step.
  const std::array<double, 3>& prescribed(int k) const { return u_[idx(k)]; }

  /// The reference shaft's angle as one.
  const std::array<double, 3>& nominal() const { return phi_; }

  /// First s in (0, end] (0 for a load about to leave backwards) at which a load whose angle may turn back
  /// leaves its stretch: the step must end there.
  std::optional<double> first_knot(const TaylorSeries& series, double end);
  /// The load found by first_knot() goes on to the next stretch, once advance() has come to the knot.
  void pass_knot();
  ElementId knot_element() const { return leaving_->term->element; }

  /// Work of all these forces on the unknowns from 0 to s of the step, where they stand at `end` [J].
  double work(TaylorSeries& series, double s, const Vector& end);

 private:
  void move(double t, const Vector& z, const Vector& v);
  double angle_term(const PlacedLoad& load, const TaylorSeries& series, int k) const;
  double find_kinks(TaylorSeries& series);
  double given_kink_work(const TaylorSeries& series, int kink, double end) const;
  void find_ranges(TaylorSeries& series);
  bool list_kinks(const TaylorSeries& series, double to, bool projected);
  template <class Way>
  bool list_kinks_of(PlacedLoad& load, Way& way, double rate, double end, const TaylorSeries& series,
                     bool projected);
  /// Calls with every load that says knots, and the bounds that hold for it.
  template <class Each>
  void for_knotted(const Each& each) {
    for (StraightLoads::Load& l : straight_.loads()) each(l, l.stretch.low, l.stretch.high);
    for (ExpandedLoads::Load& l : expanded_.loads())
      if (l.acts && l.knots != nullptr) each(l, l.piece.low, l.piece.high);
  }
  /// Of the motion, by a force of 1 N m (or N) on the row over the step, relative to the largest; not
  /// finite where nothing has moved yet.
  double relative_move(const TaylorSeries& series, int row) const {
    return series.reach(row) * per_reach_[idx(row < series.size() ? series.kind(row) : 0)];
  }
  /// What the projection lacks of a force on a row [N m]: of a smooth one, and of one that changes faster than its nodes show.
  struct Rest {
    double smooth = 0.0, rough = 0.0;
  };
  Rest rest_of_force(int row, double off_at_ends) const;
  double measured(const TaylorSeries& series, int row, double force, bool held) const;
  double unseen_of(const TaylorSeries& series, int row, double rough, bool held) const;
  double size_of_force(int row) const;

  const System& system_;
  Assembler assembler_;
  StraightLoads straight_;
  ExpandedLoads expanded_;
  SmoothLoads smooth_;
  std::vector<const LoadTerm*> on_prescribed_;  // with stretches; they move no unknown
  int stride_;
  LaneVector p_;     // by powers of s, without the loads' slopes: kProjectionTerms columns
  LaneVector base_;  // the series' right side, degrees 0 to 2, before projection
  int degree_ = 2;   // of p_
  LegendreProjection projection_, last_;  // projection of this pass, and of the pass before
  LegendreProjection of_loads_;           // of this pass, where there are laws too
  LegendreProjection of_kinks_;           // of this pass: of tables' kinks in the step
  std::vector<double> largest_force_;     // by row, of steps in which friction held
  std::vector<double> changes_;           // by row, of the projection in this pass
  std::vector<double> rounding_;          // of forces by row, as far as it was found
  std::vector<double> too_large_;         // by row, what was too large to be left out of the last step tried,
  double tried_ = 0.0;                    // and its length [s]; 0: none from here
  struct RowRest {
    double tail = 0.0;
    bool follows = false, acts = false;
  };
  std::vector<RowRest> row_rest_;   // of find_rounding()
  TaylorSeries::Norm per_reach_{};  // relative_move() over the row's reach, by kind
  KinkMoments kinks_;
  /// A kink that leaves more of the motion than this inside the step ends it.
  static constexpr double kMostInside = 1e-6;
  double slope_behind_ = 0.0;
  double kinks_inside_ = 0.0;   // what kinks of tables leave inside the step, relative to the motion
  std::vector<int> last_kink_;  // by row, the kink listed last, counted from 1 over all listings
  int listed_before_ = 0;       // in listings before this one
  bool shared_rows_ = false;
  bool projected_ = false, with_laws_ = false;
  bool of_part_ = false;  // of another one's step
  std::array<double, 3> phi_{};
  std::vector<std::array<double, 3>> u_;
  std::vector<double> power_;
  LaneVector ranges_;     // by row, how far it comes; then bounds of its terms and of their slopes
  KinkSizes kink_sizes_;  // of each of kinks_
  Vector z_, v_;
  double t_ = 0.0, h_ = 0.0;
  const PlacedLoad* leaving_ = nullptr;
  double leaving_direction_ = 0.0;
};

}  // namespace drev
