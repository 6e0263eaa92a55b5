#pragma once
/// One step of a Runge-Kutta method, explicit or diagonally implicit (butcher_tableau.hpp).
#include "solvers/stepping/butcher_tableau.hpp"
#include "solvers/stepping/stepper.hpp"

namespace drev {

class RungeKutta final : public Stepper {
 public:
  RungeKutta(const System& system, const StepScheme& scheme, const StepOptions& options);
  NewtonResult step(const EvaluatedState& from, double h, double t_new, double t_evaluate, EvaluatedState& to,
                    bool accept_jump = false) override;
  /// By the embedded formula; its own error if it is of lower order than the method. Where there is none, by
  /// quadrature. Implicit: filtered (Hosea and Shampine 1996), or fast modes at rest would count.
  void estimate(const EvaluatedState& from, const EvaluatedState& to, double h, Vector& e_z,
                Vector& e_v) override;

 private:
  /// z_0 + h sum_j w_j v_j, v_0 + h sum_j w_j a_j over the first `count` stages.
  void combine(const EvaluatedState& from, double h, const double* weights, Eigen::Index stride, int count,
               Vector& z, Vector& v) const;

  /// Of methods without a stage at the start: what the loads' jump or kink before the first stage, which none of the
  /// stages sees, may add at most; that is how far the loads at the start are off those at the stages, carried on to it.
  void add_change_before_stages(const EvaluatedState& from, double h, Vector& e_v);

  const ButcherTableau& tableau_;
  std::vector<Vector> rate_, acceleration_;  // v_i, a_i of the stages; explicit: and of the end
  std::vector<Vector> loads_;                // at the stages, where there is none at the start; else empty
  StepEquation::Problem problem_;
  EvaluatedState stage_;
};

}  // namespace drev
