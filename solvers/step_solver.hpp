#pragma once
/// One implicit step of a System by a StepScheme: from a point in time to the next, or a reason why not.
///
/// S = (1-a_m) M + (1-a_f) (gamma h C + beta h^2 K) is factored once per step size. Where the laws are few,
/// Newton runs on their forces alone (contact_newton.hpp) and angle-dependent loads are a small correction
/// iterated on the same factor; with many laws, or general elements, the sparse tangent is factored in
/// each iteration (sparse_newton.hpp). A step that did not converge is never accepted.
#include <memory>
#include <vector>

#include "core/assembler.hpp"
#include "solvers/contact_newton.hpp"
#include "solvers/phase_clock.hpp"
#include "solvers/sparse_cholesky.hpp"
#include "solvers/sparse_newton.hpp"
#include "solvers/step_scheme.hpp"

namespace drev {

/// A state with everything that was evaluated at it.
struct StepPoint {
  State state;
  Vector p;            ///< loads and known motions, right side
  Vector kz, cv;       ///< K z, C v
  Vector total;        ///< C v + K z + B y + general - p
  std::vector<ScalarInput> inputs;        ///< per scalar term
  std::vector<ScalarResponse> responses;
  double general_energy = 0.0;            ///< J, stored in general elements
  double general_power = 0.0;             ///< W, dissipated there
};

struct StepOptions {
  ContactNewton::Options contact;
  /// Change of the loads between two passes, relative to the largest force so far [-].
  double load_tolerance = 1e-10;
  int max_load_passes = 30;
  /// More laws than this are solved with the sparse tangent; measured in docs/performance.md.
  int max_dense_contacts = 32;
  bool time_phases = false;  ///< keep where the time goes (slows the run a little)
};

class StepSolver {
 public:
  StepSolver(const System& system, StepScheme scheme, StepOptions options = {});

  const StepScheme& scheme() const { return scheme_; }
  const Assembler& assembler() const { return assembler_; }
  /// Moves the known motions to time t, for evaluating channels at a point.
  void stand_at(double t) { assembler_.set_time(t); }

  /// Evaluates everything at the point's state and finds the acceleration that satisfies the equation of
  /// motion there. Throws SolverError if M cannot be factored.
  void start(StepPoint& point);

  /// Steps from `from` by h; the new state carries time t_new, and laws and loads are evaluated at
  /// t_evaluate (just below t_new where a breakpoint lies at t_new, so that the value before a jump counts).
  NewtonResult step(const StepPoint& from, double h, double t_new, double t_evaluate,
                    StepPoint& to);

  long load_passes() const { return load_passes_; }
  long factorizations() const { return factorizations_; }
  bool dense_contacts() const { return dense_; }
  PhaseClock& clock() { return clock_; }

 private:
  struct Factor {
    double h = 0.0;
    SparseCholesky cholesky;
    ContactNewton contact;
    Eigen::MatrixXd w;  // S^-1 B
  };
  Factor& factor(double h);
  void evaluate(StepPoint& point);
  /// history: of the general elements before the step that led to the point.
  void evaluate_totals(const Vector& history, StepPoint& point);
  void totals_from_motion(const StepPoint& from, StepPoint& to);
  NewtonResult solve_dense(const StepPoint& from, double h, StepPoint& to);
  NewtonResult solve_sparse(const StepPoint& from, double h, StepPoint& to);
  void correct(double h, StepPoint& to) const;
  void update_scale(const StepPoint& point);

  const System& system_;
  Assembler assembler_;
  StepScheme scheme_;
  StepOptions options_;
  bool dense_ = true;
  std::vector<std::unique_ptr<Factor>> factors_;
  std::unique_ptr<SparseNewton> sparse_;
  Vector z_predicted_, v_predicted_, rhs_base_, rhs_, scratch_, a_linear_, p_last_, lambda_, values_;
  std::vector<ScalarInput> free_;
  double force_scale_ = 0.0;
  PhaseClock clock_;
  long load_passes_ = 0, factorizations_ = 0;
};

}  // namespace drev
