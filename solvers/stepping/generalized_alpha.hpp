#pragma once
/// One step of the generalized-alpha family (step_scheme.hpp).
///
/// Its acceleration a_n is that of the time t_n + (alpha_m - alpha_f) h. Where steps vary, it is carried over
/// to the next one's length, z''_n + (a_n - z''_n) h_new/h_old; the first step after a start is made twice,
/// the second time from z''_0 + (alpha_m - alpha_f) (z''_1 - z''_0). Without it each change of the step would
/// cost an error of order h^2 in the rates. Source: M. Arnold, O. Bruels, Convergence of the
/// generalized-alpha scheme for constrained mechanical systems, Multibody Syst. Dyn. 18, 2007,
/// doi:10.1007/s11044-007-9084-0.
#include "solvers/stepping/stepper.hpp"

namespace drev {

class GeneralizedAlpha final : public Stepper {
 public:
  using Stepper::Stepper;
  NewtonResult step(const EvaluatedState& from, double h, double t_new, double t_evaluate, EvaluatedState& to,
                    bool accept_jump = false) override;
  void estimate(const EvaluatedState& from, const EvaluatedState& to, double h, Vector& e_z,
                Vector& e_v) override;

 private:
  NewtonResult step_from(const Vector& a, const EvaluatedState& from, double h, EvaluatedState& to,
                         bool accept_jump);

  StepEquation::Problem problem_;
  Vector known_, scratch_, a_0_, a_1_, a_shifted_;
};

}  // namespace drev
