#pragma once
/// Runs a reference model: Taylor steps that end at every event, located as the first root of a guard.
#include <functional>

#include "tests/stability/coverage/reference_model.hpp"

namespace coverage {

struct ReferencePrecision {
  int degree = 30;          ///< of the series
  Real tolerance = 1e-17L;  ///< of their last terms, relative to the motion so far
};
/// The second run, which says by its difference what the first is worth: other steps, other truncation.
inline constexpr ReferencePrecision kFine{30, 1e-17L}, kCheck{25, 1e-16L};

/// A step [t, t + h] with the model expanded at its start.
struct ReferenceStep {
  const ReferenceModel& model;
  Real t = 0, h = 0;
  const Guard* passes = nullptr;  ///< at the end; null: none
};

/// Something that looks at every step.
using Watcher = std::function<void(const ReferenceStep&)>;

/// Throws std::runtime_error where events follow each other without end or a guard is found broken.
void run_reference(ReferenceModel& model, Real t_end, const ReferencePrecision& precision,
                   const std::vector<Watcher>& watchers);

/// The first s in (0, h] at which g, positive just after 0, comes down to zero; fresh: it is zero at 0. Negative: none.
Real first_fall(const Poly& g, Real h, bool fresh);
/// Values of s in [0, h] at which y may be extreme: both ends and the zeros of its slope.
std::vector<Real> extremes(const Poly& y, Real h);
/// No value on [0, h] is above, or below.
Real upper_bound(const Poly& y, Real h);
Real lower_bound(const Poly& y, Real h);

}  // namespace coverage
