#pragma once
/// SteadyStep: the length of steps to a stop, all alike to the last bit (EvenSteps), so that what depends on it is computed once.
#include <cmath>

#include "solvers/run/stops.hpp"

namespace drev {

class SteadyStep {
 public:
  /// The length [s] of the next of as few steps from t to `end` as are no longer than `longest`.
  double next(double t, double end, double longest) {
    const EvenSteps even(t, end, longest);
    if (!(even.count > 1.0)) return even.h;
    if (!(std::abs(even.h - last_) <= kSame * even.h)) last_ = even.h;
    return last_;
  }

 private:
  // Two lengths that differ by the rounding of times alone, relative to them.
  static constexpr double kSame = 1e-7;
  double last_ = 0.0;
};

}  // namespace drev
