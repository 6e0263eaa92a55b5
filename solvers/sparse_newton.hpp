#pragma once
/// Newton with the sparse tangent, for many laws, general elements and static equilibrium:
///
///   R(w) = mu M w + phi [C v + K z + B y(z, v) + g(z, v) - p(z, v)] + r_0 = 0
///   z = z_0 + kappa_z w,   v = v_0 + kappa_v w
///
/// Tangent mu M + phi (kappa_v C + kappa_z K + slopes), factored in every iteration by CHOLMOD, or by KLU
/// if an element says its tangent is unsymmetric. The same exact line search as on the contact forces.
#include <memory>

#include "core/assembler.hpp"
#include "solvers/contact_newton.hpp"
#include "solvers/sparse_cholesky.hpp"
#include "solvers/sparse_lu.hpp"

namespace drev {

struct SparseNewtonProblem {
  double mu = 0.0, phi = 1.0, kappa_z = 1.0, kappa_v = 0.0;
  const Vector* z_0 = nullptr;
  const Vector* v_0 = nullptr;
  const Vector* r_0 = nullptr;       ///< may be null: 0
  const Vector* history = nullptr;   ///< of the last accepted state
  double shift = 0.0;                ///< added as shift * M to the tangent alone (static solves)
};

class SparseNewton {
 public:
  explicit SparseNewton(const System& system);

  struct Options {
    int max_iterations = 60;
    double tolerance = 1e-11;  ///< |R| relative to the largest force in it
    bool line_search = true;
  };

  /// w: start in, solution out. The assembler must stand at the time of evaluation. history_new: of the
  /// general elements at the solution.
  NewtonResult solve(const Assembler& assembler, const SparseNewtonProblem& problem,
                     const Options& options, Vector& w, Vector& history_new);
  long factorizations() const { return factorizations_; }

 private:
  double residual(const Assembler& assembler, const SparseNewtonProblem& problem, const Vector& w,
                  Vector& history_new);
  NewtonStatus direction(const Assembler& assembler, const SparseNewtonProblem& problem,
                         const Vector& history);

  const System& system_;
  std::unique_ptr<SparseCholesky> cholesky_;
  std::unique_ptr<SparseLu> lu_;
  Vector z_, v_, r_, part_, values_, direction_, trial_;
  std::vector<double> kinks_;
  double scale_ = 0.0, rounding_ = 0.0;
  long factorizations_ = 0;
};

}  // namespace drev
