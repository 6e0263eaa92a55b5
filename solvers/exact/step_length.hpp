#pragma once
/// StepLength: how long the next step is to be.
///
/// Passes over projected forces want omega h <= 3 (legendre_projection.hpp). The series itself bears more, and so do kinks that are
/// swept as long as they move little: up to omega h = 4 a step costs less than its length gains, with the short series of a loose
/// tolerance up to 5 or 5.5. Such a step is tried; where it is given up, the next kPause steps are no longer than passes bear, twice
/// as many each time that fewer than kEnough went well since: a step given up costs what some ten longer ones gain.
#include <algorithm>
#include <cmath>

#include "solvers/run/stops.hpp"

namespace drev {

class StepLength {
 public:
  static constexpr double kProjectedAngle = 3.0;  ///< omega h of a step with projected forces, at most [rad]
  /// omega h of any step, at most [rad].
  static constexpr double longest_angle(double tolerance) {
    return tolerance < 1e-5 ? 4.0 : tolerance < 5e-3 ? 5.0 : 5.5;
  }

  /// fastest: the rate of the fastest mode [rad/s], or a bound of it; 0: none. duration: of the run [s]. called: some forces are
  /// known only where they are called.
  void start(double fastest, double duration, double tolerance, bool called = false) {
    const auto step = [&](double angle) {
      return fastest > 0.0 ? std::min(duration, angle / fastest) : duration;
    };
    longest_projected_ = step(kProjectedAngle);
    if (called && !(fastest > 0.0)) longest_projected_ /= kLeastSteps;
    longest_ = growing_ = step(longest_angle(tolerance));
  }
  /// Of a step with projected forces, and of any, at most [s].
  double longest_projected() const { return longest_projected_; }
  double longest() const { return longest_; }

  /// The length [s] of the next of as few steps from t to `end` as may be: all alike to the last bit (EvenSteps), so that what
  /// depends on it is computed once.
  double next(double t, double end) {
    const EvenSteps even(t, end, growing_);
    if (!(even.count > 1.0)) return even.h;
    if (!(std::abs(even.h - last_) <= kSame * even.h)) last_ = even.h;
    return last_;
  }
  static constexpr double kUnlimited = 1e300;
  /// An attempt over h held for `got` [s], 0 where terms overflowed; a next step may be `longer` times that. Returns the length to
  /// try where less was got than asked for.
  double attempted(double h, double got, double longer = kUnlimited) {
    if (got > 0.0)
      growing_ = std::min(wait_ > 0 ? longest_projected_ : longest_,
                          longer < kGrowth ? longer * got : kGrowth * std::max(got, growing_));
    if (got != h) growing_ = got > 0.0 ? got : kRetreat * h;
    return growing_;
  }
  /// A step over h was given up, or kinks ended it. Returns the length to try, which is longest_projected() where it was longer than that.
  double hold_back(double h) {
    if (!(h > longest_projected_)) return h;
    pause_ = longer_ < kEnough ? std::clamp(2 * pause_, kPause, kLongestPause) : kPause;
    wait_ = pause_;
    longer_ = 0;
    growing_ = std::min(growing_, longest_projected_);
    return longest_projected_;
  }
  /// A step was made.
  void count() {
    if (wait_ > 0)
      --wait_;
    else if (longer_ < kLongestPause)
      ++longer_;
  }

 private:
  // Most of a step's length over that of the one before, which was shortened; of the next attempt over a step with overflow.
  static constexpr double kGrowth = 3.0, kRetreat = 1.0 / 16.0;
  // Where no mode bounds the steps: the nodes of one step over the whole run would see no short pulse, no narrow gate over the
  // speed.
  static constexpr double kLeastSteps = 100.0;
  // Two lengths that differ by the rounding of times alone, relative to them.
  static constexpr double kSame = 1e-7;
  static constexpr int kPause = 8, kEnough = 16, kLongestPause = 1024;  // steps

  double longest_projected_ = 0.0, longest_ = 0.0, growing_ = 0.0, last_ = 0.0;
  int pause_ = 0,
      wait_ = 0;    // steps no longer than longest_projected_: when one was last given up, and left of these
  int longer_ = 0;  // steps since then that were free to be longer
};

}  // namespace drev
