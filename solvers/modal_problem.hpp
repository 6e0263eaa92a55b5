#pragma once
/// K x = lambda M x of one system in one contact state, with a shift below the spectrum. Internal
/// to modes.cpp: users call solve_modes().
///
/// Both methods work on (K - sigma M)^-1 M x = mu x, mu = 1 / (lambda - sigma), which keeps the
/// lowest modes accurate: the error of lambda from mu is about eps (lambda - sigma)^2 / |sigma|,
/// that of the Rayleigh quotient x' K x / x' M x about eps lambda_max; the smaller of the two is
/// taken.
#include "core/assembler.hpp"
#include "solvers/inertia_count.hpp"
#include "solvers/modes.hpp"
#include "solvers/sparse_cholesky.hpp"

namespace drev {

struct ModalPairs {
  Vector lambda;            ///< ascending [(rad/s)^2]
  Eigen::MatrixXd vectors;  ///< columns x, x' M x = 1
  int count() const { return static_cast<int>(lambda.size()); }
};

class ModalProblem {
 public:
  /// summary receives shift, solves and factorisations.
  ModalProblem(const System& system, Contact contact, ModesSummary& summary);

  /// Chooses sigma about -lambda of the first elastic mode: starts at -lambda_max / n^2, the scale
  /// of a uniform chain, and starts again where that turns out to be more than 10 times or less
  /// than a hundredth. Throws SolverError where no shift makes K - sigma M positive definite.
  void find_shift(int rigid_modes, bool dense);
  /// The lowest pairs, at least count, by the method preferred; summary says which it was. Where
  /// Lanczos does not converge (very many copies of one frequency) the basis is enlarged, then
  /// dense is taken up to kDenseRescue unknowns; beyond, throws SolverError with ARPACK's reason.
  /// start: number of start vector.
  ModalPairs lowest(int count, int start, bool prefer_dense);
  static constexpr int kDenseRescue = 3000;

  InertiaCounter& sturm() { return sturm_; }
  bool stores_no_energy(const Vector& x) const;
  /// |K x - lambda M x| / (|K| |x| + lambda |M| |x|) in the maximum norm.
  double residual(double lambda, const Vector& x) const;
  /// Name of the node that moves most.
  const std::string& largest_entry(const Vector& x) const;

 private:
  ModalPairs lanczos(int count, int start);
  const ModalPairs& dense();  // all pairs, computed once for each shift
  void factor(double sigma);
  void refine(ModalPairs& pairs) const;

  const System& system_;
  Assembler assembler_;
  Vector stiffness_, mass_;
  double lambda_max_ = 0.0;  // scale, from row sums
  ModesSummary& summary_;
  InertiaCounter sturm_;
  SparseCholesky shifted_;
  ModalPairs dense_pairs_;
  double dense_shift_ = 0.0;  // that dense_pairs_ belong to
};

}  // namespace drev
