#pragma once
/// Sparse Cholesky factorisation A = L L' of a symmetric positive definite matrix whose pattern
/// stays the same: analysed once, factored often, solved without allocating.
///
///   P A P' = L L',  A x = b
///
/// P eliminates a tree from its leaves inwards, without fill, so that the arms of a chain are two
/// recurrences that run side by side. With loops P is the identity where that fills no more than AMD's
/// ordering does, else AMD's. What hardly fills, as drivetrains do, is factored and solved in flat
/// arrays (low_fill_factor.hpp: as L D L', all D > 0 asked for), the rest by CHOLMOD's simplicial LL'. A
/// matrix that is diagonal in the first call needs its diagonal alone, whatever its pattern.
///
/// Bare LDL' accepts diag(1, -1) and singular matrices as success; here every pivot is judged.
///
/// Source: Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, Algorithm 887: CHOLMOD, ACM TOMS
/// 35(3), 2008, doi:10.1145/1391989.1391995.
#include <drev/core/system.hpp>

#include <memory>

namespace drev {

enum class FactorStatus {
  not_computed,           ///< factorize() was not called, or not with success
  success,                ///< the factor can be used
  not_positive_definite,  ///< a pivot is zero or negative: failed_column() says which
  singular,               ///< a pivot lost all its digits: see pivot_ratio(), failed_column()
  not_finite,             ///< a value is NaN or infinite, or the factor overflowed
  pattern_changed,        ///< not the pattern of the first call, or sizes that do not match
  out_of_memory           ///< CHOLMOD or KLU could not allocate
};
const char* to_text(FactorStatus status);

class LowFillFactor;
struct LowFillPattern;

/// Order of elimination.
enum class Ordering { natural, from_leaves, amd };

class SparseCholesky {
 public:
  SparseCholesky();
  /// Analyses at once; a pattern that cannot be analysed is reported by factorize().
  explicit SparseCholesky(const SparseMatrix& pattern);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// Factors A. pattern: compressed, structurally symmetric, both triangles there; values: of A on
  /// that pattern, numerically symmetric (one triangle is read). The first call analyses the
  /// pattern, where A is not diagonal; later calls must bring the same one. Prints nothing, throws nothing.
  FactorStatus factorize(const SparseMatrix& pattern, const Vector& values);
  FactorStatus status() const;
  bool ok() const { return status() == FactorStatus::success; }

  /// x = A^-1 b; b and x may be the same vector. Allocates nothing after the first call. Throws
  /// SolverError without a factor and where b has another size.
  void solve(const Vector& b, Vector& x);

  /// Column (unknown) at which the factorisation failed, for the message; -1 where it did not.
  int failed_column() const;
  /// min_j L_jj^2 / A_jj, in (0, 1]: what is left of the diagonal after elimination, independent of
  /// the units of the unknowns. Below (10 + n) eps nothing but rounding is left and the status is
  /// singular.
  double pivot_ratio() const;
  /// (min L_jj / max L_jj)^2, CHOLMOD's estimate of 1 / cond(A). Depends on the units of the
  /// unknowns: small for a badly scaled matrix that is solved well. 0 without a factor.
  double reciprocal_condition() const;
  /// How the unknowns are ordered; natural before the analysis.
  Ordering ordering() const;
  /// What was found of a pattern that hardly fills; null before, or where CHOLMOD factors it.
  std::shared_ptr<const LowFillPattern> low_fill() const;
  /// The factor itself, likewise, for who goes on in its order of elimination.
  LowFillFactor* low_fill_factor();
  /// Number of entries of L; 0 before the first factorisation.
  int factor_entries() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drev
