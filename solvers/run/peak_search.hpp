#pragma once
/// PeakSearch: largest and smallest value of a smooth function in an interval, each found on the function
/// itself, to rounding.
///
/// With a rate, by the cubic through values and rates at the ends of a bracket: the function is looked at
/// where the cubic has its extremum, and the half with the change of sign is kept. Rates of one sign at both
/// ends: where the cubic dips between two extrema, its dip parts the interval into two such brackets. Without
/// a rate, by parabolas through three points (R. P. Brent, Algorithms for Minimization without Derivatives,
/// 1973, chapter 5), with a halved bracket where they do not close in.
#include <drev/solvers/run/peak.hpp>

#include <functional>
#include <optional>

namespace drev {

inline constexpr int kMostLooks = 40;
inline constexpr double kRangeError = 1e-6;  ///< what is smaller beside the range is not looked for
inline constexpr double kLeastGain = 1e-15;  ///< gain of a next look by the rates, over the range

/// A value of the function, and its rate where it has one.
struct PeakSample {
  double t = 0.0, y = 0.0;
  std::optional<double> rate = {};
};

/// Searches [a.t, b.t] for values above peak.max and below peak.min and notes those it finds. range >= 0: of
/// the function so far; what is smaller than 1e-6 of it beside the cubic's own rise is not looked for.
void search_peak(const PeakSample& a, const PeakSample& b, const std::function<PeakSample(double t)>& look,
                 double range, Peak& peak);

}  // namespace drev
