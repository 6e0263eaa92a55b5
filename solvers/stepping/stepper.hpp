#pragma once
/// A method that steps from one point in time to the next: what the run loop (transient.hpp) knows of it.
#include <memory>

#include "solvers/stepping/step_equation.hpp"

namespace drev {

class Stepper {
 public:
  Stepper(const System& system, const StepScheme& scheme, const StepOptions& options)
      : equation_(system, scheme, options) {}
  virtual ~Stepper() = default;

  /// Evaluates everything at the point's state and finds the acceleration that satisfies the equation of
  /// motion there. Throws SolverError if M cannot be factored.
  void start(EvaluatedState& point);

  /// Steps from `from` by h; the new state carries time t_new, and laws and loads at the step's end are
  /// evaluated at t_evaluate (just below t_new where a breakpoint lies at t_new, so that the value before a
  /// jump counts). accept_jump: see StepEquation::Problem. A step that did not converge is not to be used.
  virtual NewtonResult step(const EvaluatedState& from, double h, double t_new, double t_evaluate,
                            EvaluatedState& to, bool accept_jump = false) = 0;

  /// Estimated local error of the step just made, of deviations and rates.
  virtual void estimate(const EvaluatedState& from, const EvaluatedState& to, double h, Vector& e_z,
                        Vector& e_v) = 0;

  StepEquation& equation() { return equation_; }
  const Assembler& assembler() { return equation_.assembler(); }

 protected:
  /// Local error as the difference to the quadrature of the acceleration over the motion between the ends
  /// (step_polynomial.hpp): e_v = v_1 - v_0 - int a, e_z = z_1 - z_0 - h v_0 - int (t_1 - t) a. For Newmark's
  /// methods it is, without needing a step before, what Zienkiewicz and Xie (1991,
  /// doi:10.1002/eqe.4290200907) estimate, (beta - 1/6) h^2 (a_1 - a_0), and (h/12) (a_1 - 2 a_0 + a_-1)
  /// for the rates. Simpson's rule up to order 2, Lobatto's with four points above.
  void estimate_by_quadrature(const EvaluatedState& from, const EvaluatedState& to, double h, Vector& e_z,
                              Vector& e_v);

  StepEquation equation_;

 private:
  EvaluatedState inside_;
  Vector a_;
};

std::unique_ptr<Stepper> make_stepper(const System& system, const StepScheme& scheme,
                                      const StepOptions& options);

}  // namespace drev
