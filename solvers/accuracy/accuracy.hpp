#pragma once
/// Figures of a run, each with its error, to an accuracy that is asked for.
///
///   1. How fast do small differences grow (error_growth.hpp)?
///   2. The run at one tolerance (exact, controlled steps) or step, then at a tighter one. A figure of the
///      tighter run has the error 2 |difference| + max(tolerance, 1e-14) growth |figure|; with controlled and
///      constant steps not less than half of the difference before, which second order quarters. Tightened
///      until every figure keeps the accuracy, or the method's end or the time allowed is reached.
///   3. The horizon: the first time at which the two runs differ by more than the accuracy, or 1e-14 has
///      grown to it. Past it trajectories
///      cannot be compared point by point; what depends on them is given as a statistic with a 95 %
///      confidence interval: time averages by the means of 20 batches, peaks over the run by runs that start
///      1e-9 beside the first.
///
/// The estimate is one: it is honest where tightening reduces the error by a factor of 3 or more (second
/// order: 4), and does not know what both runs miss, e.g. a flank touched and left inside one step of a
/// method with constant steps.
#include <drev/core/range.hpp>
#include <drev/core/system.hpp>
#include <drev/solvers/accuracy/error_growth.hpp>
#include <drev/solvers/run/estimate.hpp>

#include <limits>
#include <string>
#include <vector>

namespace drev {

struct AccuracyOptions {
  double accuracy = 1e-4;  ///< relative
  static constexpr Range kAccuracy{1e-12, 0.5};
  double t_end = 0.0;                     ///< s
  double from = 0.0;                      ///< s, in [0, t_end): figures are of the run from then on
  std::string deflection = {};            ///< channel; its peak, orders and quantiles; empty: none
  std::vector<std::string> torques = {};  ///< channels; the largest peak of all
  std::vector<std::string> meshes = {};   ///< channels of mesh forces; the largest peak of all
  double cycle = 0.0;  ///< s, of which orders are the multiples; 0: frequencies of the last half
  Method method = {};  ///< exact, controlled (the tolerance is found), or the constant step to begin with
  double most_seconds = 30.0;  ///< processor time of the longest run
  int ensemble = 8;            ///< perturbed runs for peaks past the horizon
  /// Of the initial state, relative to the largest deviation and rate (FoundStart::error): it grows or decays as any
  /// small difference does, and is part of the error of every figure. In [0, 1].
  double start_error = 0.0;
  std::function<bool(double)> progress = {};
};

/// Of one contact over the span [from, t_end]. Past the horizon, where two runs do not agree, an error is
/// infinite: unknown.
struct ContactFigures {
  std::string element;
  Estimate largest_force;                ///< N or N m
  Estimate time_separated;               ///< s
  Estimate front_impacts, back_impacts;  ///< numbers
};

struct AccuracyResult {
  std::vector<Figure> figures;           ///< of kind estimate, from two runs, or interval, of a statistic
  std::vector<ContactFigures> contacts;  ///< of whatever has a gap, in the order of System::scalars()
  /// Every estimate, those of contacts among them, keeps the accuracy and nothing had to be given as a statistic.
  bool reached = false;
  std::string reason;  ///< why not
  ErrorGrowth growth;
  double horizon = std::numeric_limits<double>::infinity();  ///< s
  Method coarse, fine;                                       ///< the two runs compared
  RunSummary summary;                                        ///< of the fine one
  /// By name, or by how the name begins; null: none.
  const Figure* find(const std::string& name) const;
};

/// Throws ModelError for bad options. A run that fails says so in the summary.
AccuracyResult run_to_accuracy(const System& system, const AccuracyOptions& options);

}  // namespace drev
