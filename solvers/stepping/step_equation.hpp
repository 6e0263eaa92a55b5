#pragma once
/// The equation that every implicit step or stage ends in, solved for the acceleration a:
///
///   mu M a + phi F(t, z_0 + beta h^2 a, v_0 + gamma h a) = known,   F = C v + K z + B y + general - p
///
/// S = mu M + phi (gamma h C + beta h^2 K) is factored once per h: all stages of a method share it. Where
/// the laws are few, Newton runs on their forces alone (contact_newton.hpp) and angle-dependent loads are a
/// small correction iterated on the same factor; with many laws, or general elements, the sparse tangent
/// is factored in each iteration (sparse_newton.hpp). A small S that is used often is inverted: a product
/// with S^-1 waits for nothing, where a solve with the factor waits for row after row.
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/stepping/step_options.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <algorithm>
#include <memory>
#include <vector>

#include "solvers/contact/contact_newton.hpp"
#include "solvers/contact/sparse_newton.hpp"
#include "solvers/linear/matrix_product.hpp"
#include "solvers/linear/sparse_cholesky.hpp"
#include "solvers/run/run_clock.hpp"

namespace drev {

/// Largest load, force K z or law's force at a point [N m or N].
double largest_force(const EvaluatedState& point);

class StepEquation {
 public:
  /// Coefficients mu = 1 - alpha_m, phi = 1 - alpha_f, beta, gamma are the scheme's.
  StepEquation(const System& system, StepScheme scheme, StepOptions options);

  struct Problem {
    double h = 0.0;                   ///< s
    Vector z_0, v_0;                  ///< motion with a = 0
    const Vector* known = nullptr;    ///< right side; null: 0
    const Vector* a_start = nullptr;  ///< where loads, phase and Newton start
    const Vector* history = nullptr;  ///< of the general elements before the step
    /// A force that jumps and leaves no root: take the value inside the jump at which the law stands on
    /// its edge. Only with few laws.
    bool accept_jump = false;
  };

  const StepScheme& scheme() const { return scheme_; }
  const StepOptions& options() const { return options_; }
  Assembler& assembler() { return assembler_; }

  /// Solves at the assembler's time. Fills to's z, v, a, p, inputs, responses, history.
  NewtonResult solve(Problem& problem, EvaluatedState& to) {
    return dense_ ? solve_dense(problem, to) : solve_sparse(problem, to);
  }
  /// kz, cv and total after solve(); the step's own equation gives the total force, so that no product
  /// with K is needed. from: where the step began, a_0: with which acceleration.
  void totals(const EvaluatedState& from, const Vector& a_0, EvaluatedState& to);

  /// Everything at the point's state and the assembler's time. history: of the general elements before the
  /// step that led to it; what they leave goes to history_new (may be null).
  void evaluate(const Vector& history, EvaluatedState& point, Vector* history_new = nullptr);
  /// a = -M^-1 total. Throws SolverError if M cannot be factored.
  void acceleration(const Vector& total, Vector& a);
  /// Takes the errors' share in modes too fast for the step away: (e_z, e_v) become
  /// (I - gamma h J)^-1 (e_z, e_v), J the motion's Jacobian without the laws. Only with few laws.
  void filter(double h, Vector& e_z, Vector& e_v);
  /// Newton starts from the forces at this point.
  void start_from(const EvaluatedState& point);
  void update_scale(const EvaluatedState& point) { expect_force(largest_force(point)); }
  /// The largest force so far is at least this: of a run that was stepped elsewhere [N or N m].
  void expect_force(double force) { force_scale_ = std::max(force_scale_, force); }

  long load_passes() const { return load_passes_; }
  long factorizations() const { return factorizations_; }
  long solves() const { return solves_; }
  bool dense_contacts() const { return dense_; }
  RunClock& clock() { return clock_; }

 private:
  struct Factor {
    double h = 0.0;
    SparseCholesky cholesky;
    ContactNewton contact;
    Eigen::MatrixXd w;  // S^-1 B
    long used = 0;
    Vector inverse;  // columns of S^-1, padded to whole lanes
  };
  void invert(Factor& f);
  /// x = S^-1 b; inverts S when this has been asked for often enough.
  void solve_by_factor(Factor& f, const Vector& b, Vector& x);
  /// For steps of h: the last one used; else another whose h differs by rounding at most; else a new one.
  Factor& factor(double h) {
    return !factors_.empty() && factors_.back()->h == h ? *factors_.back() : find_factor(h);
  }
  Factor& find_factor(double h);
  void evaluate_totals(const Vector& history, EvaluatedState& point, Vector* history_new);
  NewtonResult solve_dense(Problem& problem, EvaluatedState& to);
  NewtonResult solve_sparse(const Problem& problem, EvaluatedState& to);
  /// Returns the largest change of z.
  double correct(const Problem& problem, EvaluatedState& to) const;

  const System& system_;
  Assembler assembler_;
  StepScheme scheme_;
  StepOptions options_;
  bool dense_ = true;
  bool phases_ = false;                           // a law follows the angle of a node
  bool moves_ = false;                            // loads or phases look at the motion
  std::vector<std::unique_ptr<Factor>> factors_;  // used last, last
  SparseCholesky mass_;
  MatrixProduct mass_product_, damping_, stiffness_;
  std::unique_ptr<SparseNewton> sparse_;
  Vector linear_, rhs_, scratch_, history_, p_last_, lambda_, lambda_start_, values_;
  std::vector<ScalarInput> given_, free_;  // what laws see: known; without their forces
  double force_scale_ = 0.0;
  RunClock clock_;
  long load_passes_ = 0, factorizations_ = 0, solves_ = 0;
};

}  // namespace drev
