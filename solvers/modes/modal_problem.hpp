#pragma once
/// K x = lambda M x of one system in one contact state, with a shift below the spectrum. Internal
/// to modes.cpp: users call solve_modes().
///
/// Both methods work on (K - sigma M)^-1 M x = mu x, mu = 1 / (lambda - sigma), which keeps the
/// lowest modes accurate: the error of lambda from mu is about eps (lambda - sigma)^2 / |sigma|,
/// that of the Rayleigh quotient x' K x / x' M x about eps lambda_max; the smaller of the two is
/// taken.
#include <drev/core/assembler.hpp>
#include <drev/solvers/modes/modes.hpp>

#include "solvers/linear/sparse_cholesky.hpp"
#include "solvers/linear/sturm_count.hpp"
#include "solvers/modes/lanczos.hpp"

namespace drev {

struct ModalPairs {
  Vector lambda;            ///< ascending [(rad/s)^2]
  Eigen::MatrixXd vectors;  ///< columns x, x' M x = 1
  Vector error;             ///< >= 0, of lambda: what rounding of K and of the solver leave [(rad/s)^2]
  /// The mode may store no elastic energy: |x' K x| <= 1e-13 |x|' |K| |x|, or |lambda| is nothing beside the
  /// shift, which is of the size of the first elastic lambda (a part alone has no |K| to compare with).
  std::vector<bool> rigid;
  int count() const { return static_cast<int>(lambda.size()); }
};

class ModalProblem {
 public:
  /// summary receives shift, solves and factorisations. Throws SolverError where K/M overflows.
  ModalProblem(const System& system, Contact contact, ModesSummary& summary);

  /// Chooses sigma about -lambda of the first elastic mode: starts at -lambda_max / n^2, the scale
  /// of a uniform chain, and starts again where that turns out to be more than 10 times or less
  /// than a hundredth. Throws SolverError where no shift makes K - sigma M positive definite.
  /// most: pairs that will be asked for then.
  void find_shift(int rigid_modes, int most, bool dense);
  /// The lowest pairs, at least count, by the method preferred; summary says which it was. Round 0 is
  /// Lanczos without restarts, which is fast and may miss copies of a frequency; later rounds, and what
  /// did not converge, are ARPACK's, each with another start vector. Where that does not converge either
  /// (very many copies) the basis is enlarged, then dense is taken up to kDenseRescue unknowns; beyond,
  /// throws SolverError with ARPACK's reason.
  ModalPairs lowest(int count, int round, bool prefer_dense);
  static constexpr int kDenseRescue = 3000;

  /// lambda below which rounding of the stiffest parts may hide a mode's [(rad/s)^2].
  double hidden() const { return 1e-14 * lambda_max_; }
  InertiaCounter& sturm() { return sturm_; }
  /// Largest |K x - lambda M x| / (|K| |x| + lambda |M| |x|), each in the maximum norm, of `count` pairs.
  /// Adds what these residuals r say to the errors: r^2 over the distance to the next lambda (T. Kato, J. Phys.
  /// Soc. Japan 4, 1949, doi:10.1143/JPSJ.4.334) or, where that is less, r itself, in the norm of M^-1, M
  /// taken by its diagonal.
  double check_residuals(ModalPairs& pairs, int first, int count) const;
  /// Name of the node that moves most.
  const std::string& largest_entry(const Vector& x) const;

 private:
  bool all_at_once(int count, bool prefer_dense) const;
  ModalPairs lanczos(int count, int round);
  double first_elastic(int rigid_modes, int most, bool prefer_dense);  // lambda, roughly
  /// Of K - sigma M, or of W P (K - sigma M) P' W and the unit matrix with weight_.
  ShiftInvertProblem shift_invert(int count, int start);
  const ModalPairs& dense();  // all pairs, computed once for each shift
  void factor(double sigma);
  /// One more inverse iteration takes out the rounding that Lanczos leaves in the fast modes; shares in
  /// slower modes, which it magnifies, are taken out after it. x' M x = 1.
  void polish(const ShiftInvertProblem& problem, ShiftInvertResult& pairs);
  /// Vectors as shift_invert()'s problem has them, times the upper triangular c: over the unknowns.
  Eigen::MatrixXd over_unknowns(Eigen::MatrixXd vectors, const Eigen::MatrixXd& c) const;
  void refine(ModalPairs& pairs) const;

  const System& system_;
  Assembler assembler_;
  Vector stiffness_;
  const Vector& mass_;
  // Where M is diagonal and L hardly fills, vectors are iterated in the order of elimination, scaled so that
  // M = I: 1 / sqrt(M_ii) in that order, else empty.
  Vector weight_;
  std::vector<int> place_;   // of each unknown in that order
  double lambda_max_ = 0.0;  // scale, from row sums; finite
  ModesSummary& summary_;
  SparseCholesky shifted_;
  std::unique_ptr<ShiftInvertLanczos> lanczos_;  // begun with the shift, which it is to go on with
  InertiaCounter sturm_;
  ModalPairs dense_pairs_;
  double dense_shift_ = 0.0;  // shift of dense_pairs_
};

}  // namespace drev
