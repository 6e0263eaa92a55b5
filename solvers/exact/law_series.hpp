#pragma once
/// LawSeries: which piece of its law each scalar element is on, and when it leaves it.
///
/// On a piece, y = y_0 + k x + c x': k and c go into the matrices, y_0 and what is known of x to
/// the right side. Each bound g = a + b_x x + b_v x' is a polynomial of s over the step; its first
/// fall below zero is the change (roots.hpp). Behind a change the crossed bound of the new
/// piece stands at zero: that root is divided out, and the sign of the first coefficient that is
/// not zero says whether the piece holds or changes back at once. Laws that are projected
/// or expanded
/// (projected_laws.hpp, expanded_laws.hpp) take part with the bounds of their pieces, or with the stretches between their kinks.
/// Where the pieces are scaled by an angle, y = r(s) Y(x, x'/r), a bound with b_v is r (a + b_x x) + b_v x'.
#include <array>
#include <functional>
#include <optional>

#include "solvers/exact/law_offsets.hpp"
#include "solvers/exact/load_series.hpp"

namespace drev {

class LawSeries {
 public:
  struct Change {
    double s = 0.0;  ///< where in the step
    int law = 0;     ///< of System::scalars()
    int bound = 0;   ///< of its piece
    /// At s = 0 the bound is beyond zero: a stiffness or the rate of an offset jumped across it.
    bool jumped = false;
  };

  explicit LawSeries(const System& system);

  /// Every law on the piece that its input is on.
  void locate(const std::vector<ScalarInput>& inputs);
  int piece(int law) const { return laws_[idx(law)].piece; }
  /// StepMotion::side() of the pieces that hold.
  std::optional<int> side(int law) const {
    const Law& l = laws_[idx(law)];
    return l.sides[idx(l.piece)];
  }

  /// The piece that tells a law's force, but for what scales it; null: of a law that is projected.
  const LawPiece* force_piece(int law) const;
  /// Series of a law's deflection along the step.
  const std::vector<double>& deflection(int law) const { return series_of(laws_[idx(law)]); }

  /// Adds the pieces to the matrices and the right side over a step of h seconds.
  void add_to(TaylorSeries& series, const LoadSeries& known, double h) const;
  /// Adds the stiffest pieces of all laws, to bound the fastest rate.
  void add_stiffest(TaylorSeries& series) const;

  /// Series of how the pieces of a law are scaled along the step.
  using ScaleSeries = std::function<void(int law, std::vector<double>& scale)>;
  /// The deflections along the step: their series where something asks for them. sizes: of the rows of `series`, bounds of what their
  /// terms from the first on add up to, and stride() behind them of their slopes by s from the second on; null: not known.
  void expand(const TaylorSeries& series, const LoadSeries& known, const LawOffsets& offsets,
              const double* sizes, const ScaleSeries& scale_of);
  /// A law whose piece does not hold from s = 0 on, s = 0.
  std::optional<Change> change_at_once();
  /// No piece that holds loses energy but by its damping, nor does a known motion act on it.
  bool lossless() const;
  /// The first change in (0, end].
  std::optional<Change> first_change(double end);
  /// The first change where kinks add to the series a motion of |y| <= push s^3/(6 sqrt(m)), |y'| <= push s^2/(2 sqrt(m)):
  /// near which it is. unsure: whether there is one, or which comes first, depends on them.
  struct Beside {
    std::optional<Change> change = {};
    bool unsure = false;
  };
  Beside first_change_beside(const TaylorSeries& series, double push);
  /// Part of the step by which a change is later where these motions y and rates y' (by s) add to the series at its s.
  double later(const Change& change, const double* y, const double* rate) const;
  /// The s nearest to a change, behind it at the start (s = 0) or ahead of it at s > 0, at which the law's
  /// deflection is clear of the bound by more than rounding.
  double clear_of_change(const Change& change, double s) const;
  /// How far behind s = 1 the bound is crossed, by Newton's rule.
  double beyond_end(const Change& change) const;
  /// The law goes over to the piece behind the bound.
  void pass(const Change& change);
  /// The step was accepted and no bound is known to be at zero any more.
  void forget_roots();

  /// Energies from 0 to s of the step [J]: energy dissipated in the laws, and put in by their prescribed
  /// ends.
  double dissipated(double s) const;
  double input(double s) const;

 private:
  struct Law {
    std::vector<LawPiece> pieces;           // the law's own; of a projected one its bounds, without forces
    bool scaled = false;                    // by its angle, where that matters to a bound
    bool expanded = false;                  // the law is one of ExpandedLaws
    std::vector<std::optional<int>> sides;  // StepMotion::side() of each piece
    int piece = 0;
    int root = -1;                  // bound of the piece that is zero at s = 0
    int number = 0;                 // of the law
    double root_mobility = 0.0;     // sum |b_i| sqrt(mobility) of its row; 0: not found yet
    mutable std::vector<double> x;  // series of x, where whole: series_of()
    mutable bool whole = false;
    double x_0 = 0.0, x_1 = 0.0;                     // its first two terms
    std::array<double, 3> known = {}, known_size{};  // of its known part, and sums of what that adds up from
    std::vector<double> scale;                       // series of r, where it is scaled
    mutable double reach = 0.0,
                   rate_reach = 0.0;  // at least sum |x_k|, and sum k |x_k| from the second term on
    /// A bound of the piece: its series; or, where the bound stays above a clearance > 0, none.
    struct BoundSeries {
      std::vector<double> g;
      double clearance = 0.0;
    };
    std::vector<BoundSeries> bounds;
  };
  const LawPiece& current(std::size_t j) const { return laws_[j].pieces[idx(laws_[j].piece)]; }
  const std::vector<double>& series_of(const Law& law) const;
  bool keeps_clear(const Law& law, const LawBound& bound, double least, double& clear) const;
  enum class Start { holds, falls, jumped };
  Start start_of(int law, const LawBound& bound, int index);
  double clearance(const Law& law, const LawBound& bound) const;
  void bound_series(const Law& law, const LawBound& bound, std::vector<double>& g) const;
  /// The sizes of the terms that its coefficients are summed from.
  void bound_sizes(int law, const LawBound& bound, std::vector<double>& size) const;
  /// Of term k of x, the sum of its parts' sizes: the scale of rounding.
  double size_of_term(int law, std::size_t k) const;

  const System& system_;
  std::vector<Law> laws_;
  std::vector<double> sizes_, lower_;
  mutable LaneVector row_;  // a law's deflection, in whole lanes
  double h_ = 0.0;
  const TaylorSeries* series_ = nullptr;  // that were expanded last
  const LawOffsets* offsets_ = nullptr;
};

}  // namespace drev
