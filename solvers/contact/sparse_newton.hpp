#pragma once
/// Newton with the sparse tangent, for many laws, general elements and static equilibrium:
///
///   R(w) = mu M w + phi [C v + K z + B y(z, v) + g(z, v) - p(z, v)] + r_0 = 0
///   z = z_0 + kappa_z w,   v = v_0 + kappa_v w
///
/// Tangent mu M + phi (kappa_v C + kappa_z K + slopes), by Cholesky, or by KLU if an element says its
/// tangent is unsymmetric. Factored again where a law's slope is not that of the factor at hand: laws that are
/// linear in pieces keep it until a contact changes. A rank-one update for a single change (CHOLMOD's takes
/// 3.5 ns an unknown of the model) would save half a factorisation (8 ns), and from two on nothing. The same
/// exact line search as on the contact forces.
#include <drev/core/assembler.hpp>

#include <memory>

#include "solvers/contact/contact_newton.hpp"
#include "solvers/linear/sparse_cholesky.hpp"
#include "solvers/linear/sparse_lu.hpp"

namespace drev {

struct SparseNewtonProblem {
  double mu = 0.0, phi = 1.0, kappa_z = 1.0, kappa_v = 0.0;
  const Vector* z_0 = nullptr;
  const Vector* v_0 = nullptr;
  const Vector* r_0 = nullptr;      ///< may be null: 0
  const Vector* history = nullptr;  ///< of the last accepted state
  const Vector* loads = nullptr;    ///< in place of p(z, v), the same for every motion; null: p
  double shift = 0.0;               ///< added as shift * M to the tangent alone (static solves)
};

class SparseNewton {
 public:
  explicit SparseNewton(const System& system);

  using Options = SparseNewtonOptions;

  /// w: start in, solution out. The assembler must stand at the time of evaluation. history_new: of the
  /// general elements at the solution.
  NewtonResult solve(const Assembler& assembler, const SparseNewtonProblem& problem, const Options& options,
                     Vector& w, Vector& history_new);
  /// Swaps the laws' inputs and responses at the last w evaluated with these vectors; what is left here means
  /// nothing until the next solve().
  void hand_over_laws(std::vector<ScalarInput>& inputs, std::vector<ScalarResponse>& responses) {
    hand_over(inputs_, inputs);
    hand_over(responses_, responses);
  }
  long factorizations() const { return factorizations_; }

 private:
  double residual(const Assembler& assembler, const SparseNewtonProblem& problem, const Vector& w,
                  Vector& history_new);
  NewtonStatus direction(const Assembler& assembler, const SparseNewtonProblem& problem,
                         const Vector& history);
  /// Whether the factor at hand is of the tangent asked for; takes the slopes of the last residual.
  bool same_tangent(const Weights& weights, double shift);

  const System& system_;
  const bool only_laws_vary_;  // no general elements, no loads that depend on the motion
  std::unique_ptr<SparseCholesky> cholesky_;
  std::unique_ptr<SparseLu> lu_;
  Vector z_, v_, r_, part_, values_, direction_, trial_;
  std::vector<ScalarInput> inputs_;  // and responses: of the last residual, unless handed over
  std::vector<ScalarResponse> responses_;
  std::vector<double> slopes_, kinks_;
  Weights weights_;  // weights of the tangent, slopes_ and shift_
  double shift_ = 0.0;
  bool tangent_kept_ = false;
  double scale_ = 0.0, rounding_ = 0.0;
  long factorizations_ = 0;
};

}  // namespace drev
