#pragma once
/// Where a quantity of a section is largest against its limit, and the speed ranges in which it exceeds it, with their ends.
/// Internal to judge_sweep().
///
/// Where the limit changes with the speed, the ratio to it is largest beside the peaks of the quantity. Each local maximum of the
/// ratio among the known points is followed between its neighbours (MaximumSearch of solvers/periodic/bracketed_search.hpp); one
/// sweep solves the trial speeds of all of them.
///
/// An end lies between a speed at which the ratio to the limit is above 1 and a neighbour at which it is not. It is first
/// interpolated: linearly in the ratio, beside an infinite ratio, which grows as one over the distance, linearly in one over
/// the ratio. Where the sweep can be solved at further speeds, each end is then enclosed by the Illinois rule
/// (solvers/periodic/bracketed_search.hpp) on (r - 1)/(r + 1), which is finite for every ratio r >= 0, and by bisection where
/// that does not halve the bracket in two rounds, as where the limit jumps. One sweep solves the trial speeds of all ends of a
/// round.
#include <drev/solvers/strength/class_judgement.hpp>

#include <functional>
#include <vector>

namespace drev {

/// A speed [rad/s] and the value at it [unit of the quantity].
struct CurvePoint {
  double speed = 0.0, value = 0.0;
};

/// A quantity of one section over the speed, and the ranges in which it exceeds its limit.
struct LimitedCurve {
  int section = 0;   ///< number in LinearSweep::sections
  int strength = 0;  ///< number in Strength::sections; -1: it is the chatter of a contact
  /// The quantity, of half range and mean of the section.
  std::function<double(double half_range, double mean)> quantity;
  /// Its ratio to the limit [-]; not a number: there is no limit.
  std::function<double(const CurvePoint&)> ratio;
  /// Its ratio to the limit in transient running [-]; empty: that is not asked for.
  std::function<double(const CurvePoint&)> transient_ratio = {};
  std::vector<CurvePoint> points = {};  ///< by ascending speed
  std::vector<ExceededRange> ranges = {};

  /// The quantity at speed number i of a sweep.
  double value(const LinearSweep& sweep, Eigen::Index i) const {
    const SweepSection& s = sweep.sections[static_cast<std::size_t>(section)];
    return quantity(0.5 * (s.maximum[i] - s.minimum[i]), s.mean[i]);
  }
};

/// Adds the tops of both ratios that lie between the points to the points of all curves. sweep_at: not empty.
void add_tops(std::vector<LimitedCurve>& curves, const SweepAt& sweep_at);

/// Finds the ranges of all curves. sweep_at: as in judge_sweep(); empty: ends are interpolated.
void find_exceeded_ranges(std::vector<LimitedCurve>& curves, const SweepAt& sweep_at);

}  // namespace drev
