#pragma once
/// How an iteration of Newton's method ended.

namespace drev {

enum class NewtonStatus {
  converged,
  no_root,         ///< a force that jumps leaves this step without a solution: take a smaller one
  too_many_steps,  ///< the iteration limit was reached
  not_finite,      ///< a law returned NaN or infinity
  singular         ///< the tangent could not be factored
};
const char* to_text(NewtonStatus status);

struct NewtonResult {
  NewtonStatus status = NewtonStatus::converged;
  int iterations = 0;
  bool inside_jump = false;  ///< a force was taken inside its jump (StepEquation::Problem::accept_jump)
};

}  // namespace drev
