#pragma once
/// KinkResponse: what kinks of tables that a step passes do to the motion, by one backward sweep and without passes.
///
/// The series of the step has each load on the straight line that it starts on. Behind the s at which an angle passes a
/// knot, the load carries jump (theta(s) - theta_k) more: that force along the series' path, in moments by Gauss's nodes
/// (kink_moments.hpp), goes through one sweep (TaylorSeries::sweep). What it adds, y, bends the angle in turn: with the
/// changed slope in the stiffness the sweep holds that, too, since y of a kink's row is zero ahead of it. Left out is
/// what other kinks have added to that row before: of order h^4 of the same row's, and h^6 of its neighbours'; the
/// step ends where that would matter. Slopes of laws that change along the step make a second sweep, of their first and second
/// derivatives on the motion of the first. A knot's place follows from the series alone: a force is continuous there, so
/// that an error of place counts squared.
#include <vector>

#include "solvers/exact/expanded_laws.hpp"
#include "solvers/exact/load_series.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

class KinkResponse {
 public:
  KinkResponse(TaylorSeries& series, LoadSeries& loads, ExpandedLaws& laws)
      : series_(series), loads_(loads), laws_(laws) {}
  KinkResponse(const KinkResponse&) = delete;

  /// A new step, no slope of which is changed: lists the kinks of the whole of it. share: of the motion, what may be left out.
  /// False: some load's kinks are none of this kind, or larger than a sweep takes.
  bool look(double share);
  /// Finds y up to s = end, where the series stands at z_end; first to where the step is likely to end. False: not to be found.
  bool find(double end, const double* z_end, double share);
  /// Returns to the loads' slopes at the step's start.
  void undo();
  bool found() const { return found_; }
  /// s to which y was found.
  double end() const { return end_; }
  /// Whether there are kinks up to there: then TaylorSeries::swept() has y and its rate; else y = 0.
  bool any() const { return found_ && loads_.kinks().count() > 0; }
  /// s up to which the first y found holds: beyond, more would be left out than the share; 1: all of it.
  double limit() const { return limit_; }
  /// Work of loads beyond what they do along the series [J].
  double work() const { return any() ? loads_.kink_work(series_, end_) : 0.0; }
  /// Loss in all dampers of the system and of pieces that are linear [J].
  double dissipated() {
    return_slopes();
    return series_.loss(end_, any(), true);
  }

 private:
  void return_slopes();
  bool list(double end, const double* z_end, double share);
  /// Of the kinks listed: what they add to the motion at most, relative to it; the degree that their sweep wants, and what that
  /// leaves out.
  struct Size {
    double scale = 0.0;  // of the motion over an acceleration by s
    double response = 0.0, rest = 0.0;
    int degree = 0;
  };
  bool find_size(double end, double share);
  /// Nodes and terms by which moments are taken.
  struct Rule {
    int nodes = KinkMoments::kSweepRules.back();
    std::size_t terms = TaylorSeries::kMaxDegree + 1, place_terms = terms;
  };
  Rule rule_for(double response, double growth, double allowed, double scale, double end) const;
  struct Others {
    double error = 0.0;    // of the motion by the scale
    double between = 0.0;  // s between the two kinks that make most of it
  };
  Others error_of_others(double end, double allowed);
  double bound_of_rows_apart(double end, double beside, double apart, bool coarse);
  Others error_of_slopes(double end, const ExpandedLoads::SlopeChange& change, double enough) const;
  Others error_of_slopes(double end, const ExpandedLoads::SlopeChange& change, bool by_nearness) const;
  double nearness(int row, const ScalarTerm& law, double d) const;
  bool find_limit(double end, double allowed, double scale);
  /// (rate h)^2/4: |k| h^2/m of a row's coupling in a chain of equal rows.
  double quarter_rate_square() const { return 0.25 * rate_step_ * rate_step_; }

  TaylorSeries& series_;
  LoadSeries& loads_;
  ExpandedLaws& laws_;
  bool found_ = false, slopes_changed_ = false, limited_ = false;
  // This step's sweep takes what slopes of laws change towards the end, which is so much of the motion over the whole of it.
  bool corrects_ = false;
  double uncorrected_ = 0.0;
  double rate_step_ = 0.0;  // (rate h) of this step
  double listed_to_ = 0.0, end_ = 0.0, limit_ = 1.0;
  Size size_;
  struct OnRow {
    double place = 0.0, pull = 0.0;
  };
  std::vector<OnRow> on_row_;  // of the kink on each row, while they are bounded; zeros: none
  LaneVector moments_;         // in columns, where laws add to them; zeros between sweeps
};

}  // namespace drev
