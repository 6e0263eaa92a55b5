#pragma once
/// A step of constant length, halved where Newton's method finds no solution, for single runs and for a lane
/// that leaves its lockstep.
#include <drev/core/error.hpp>

#include <string>
#include <utility>

#include "solvers/run/run_verdict.hpp"
#include "solvers/stepping/stepper.hpp"

namespace drev {

/// Accept: bool(double h, double t_evaluate) enters the converged step from *now to *next, swaps the two and
/// returns whether the run goes on.
template <class Accept>
class HalvedStep {
 public:
  /// now, next: the points that the step goes between. max_halvings: how often a step is halved before the
  /// run ends. All that is referred to outlives this.
  HalvedStep(Stepper& stepper, EvaluatedState*& now, EvaluatedState*& next, int max_halvings,
             RunSummary& summary, Accept accept)
      : stepper_(stepper),
        now_(now),
        next_(next),
        max_halvings_(max_halvings),
        summary_(summary),
        accept_(std::move(accept)) {}

  /// The step of length h [s] that ends at t_new, its end evaluated at t_evaluate (Stepper::step()). Returns
  /// whether the run goes on.
  bool make(double h, double t_new, double t_evaluate, int depth = 0) {
    const NewtonResult result = stepper_.step(*now_, h, t_new, t_evaluate, *next_);
    summary_.iterations += result.iterations;
    if (result.status == NewtonStatus::converged) return accept_(h, t_evaluate);
    if (depth == max_halvings_) return last_resort(result.status, h, t_new, t_evaluate);
    ++summary_.halved;
    const double middle = now_->state.t + 0.5 * h;
    return make(0.5 * h, middle, middle, depth + 1) && make(0.5 * h, t_new, t_evaluate, depth + 1);
  }

  /// For a step that no halving makes solvable: a force that jumps is taken inside its jump; else the run
  /// ends.
  bool last_resort(NewtonStatus status, double h, double t_new, double t_evaluate) {
    if (status == NewtonStatus::no_root) {
      const NewtonResult result = stepper_.step(*now_, h, t_new, t_evaluate, *next_, true);
      summary_.iterations += result.iterations;
      if (result.status == NewtonStatus::converged) {
        summary_.fallbacks += result.inside_jump;
        return accept_(h, t_evaluate);
      }
      status = result.status;
    }
    if (status == NewtonStatus::not_finite)
      end_not_finite(summary_, stepper_.assembler(), *now_, *next_);
    else
      end_run(summary_, stepper_.assembler().system().name(), now_->state.t, RunStatus::no_convergence,
              std::string(to_text(status)) + " even with h = " + to_text(h) + " s");
    return false;
  }

 private:
  Stepper& stepper_;
  EvaluatedState *&now_, *&next_;
  int max_halvings_;
  RunSummary& summary_;
  Accept accept_;
};

}  // namespace drev
