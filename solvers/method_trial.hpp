#pragma once
/// Whether the method that suits a system is far dearer than another that keeps the accuracy: both are tried.
///
///   1. The chosen method runs 1,000 steps, fewer where they are dear, up to five times as many while its steps
///      still grow behind the start. What it would cost over the whole run follows from the last half of them.
///      Below two seconds it stays.
///   2. The other controlled methods, at the tolerance 1e-4, run 4,000 steps or less in the same way. Where one
///      would be cheap enough, every force and torque must agree with the first at 32 times of its trial, to
///      1e-3 of its peak there.
///   3. One that costs less than a twentieth is taken.
///
/// Costs are counts times weights in nanoseconds that were measured once, no clocks: the same system gives the
/// same answer every time, on every machine.
///
///   exact      products (20 + unknowns + 10 contacts) 2 + steps (8000 + 4 x 12 (loads + projected laws) 100)
///   stepping   solves (10 (20 + unknowns + 10 contacts) 2 + loads 100)
///
/// The second factor is what a product costs (method_choice.hpp); 4 passes over 12 nodes evaluate the loads of a step.
#include <drev/solvers/method_choice.hpp>

#include <functional>

namespace drev {

struct MethodTrial {
  MethodChoice choice;  ///< with the reason of a change; else as it was
  double chosen_ns =
      0.0;                ///< of the whole run with the method first chosen; 0: it came to the end, or failed
  double other_ns = 0.0;  ///< the same of the cheapest other one that keeps the accuracy; 0: none
};

/// A change is made where the chosen method costs more than kTooDear times as much as another.
inline constexpr double kTooDear = 20.0;

/// chosen: by choose_method(), for the same system and duration [s]. progress: returns false to stop trying.
/// Throws nothing of its own: a method that fails in its trial is no candidate.
MethodTrial try_methods(const System& system, const MethodChoice& chosen, double duration,
                        const std::function<bool()>& progress = {});

}  // namespace drev
