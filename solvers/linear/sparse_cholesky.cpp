#include "solvers/linear/sparse_cholesky.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "solvers/linear/cholmod_factor.hpp"
#include "solvers/linear/low_fill_factor.hpp"

namespace drev {

const char* to_text(FactorStatus status) {
  switch (status) {
    case FactorStatus::not_computed:
      return "not computed";
    case FactorStatus::success:
      return "success";
    case FactorStatus::not_positive_definite:
      return "not positive definite";
    case FactorStatus::singular:
      return "numerically singular";
    case FactorStatus::not_finite:
      return "a value is not finite";
    case FactorStatus::pattern_changed:
      return "the pattern is not the one analysed";
    case FactorStatus::out_of_memory:
      return "out of memory";
  }
  return "unknown";
}

struct SparseCholesky::Impl {
  Vector inverse_diagonal;  // of a diagonal matrix; such a one is not analysed
  std::optional<LowFillFactor> flat;
  std::unique_ptr<CholmodFactor> cholmod;  // where L fills too much for flat arrays
  FactorStatus status = FactorStatus::not_computed;
  double pivot_ratio = 0.0;
  int failed_column = -1;

  FactorStatus analyse(const SparseMatrix& pattern);
  FactorStatus factorize(const SparseMatrix& pattern, const Vector& values);
  /// False where A is not diagonal, or has a pivot that is not sound.
  bool factorize_diagonal(const SparseMatrix& pattern, const Vector& values);
  bool is_diagonal() const { return inverse_diagonal.size() > 0; }
  int size() const {
    if (is_diagonal()) return static_cast<int>(inverse_diagonal.size());
    return flat ? flat->pattern().size : cholmod->size();
  }
  void check_pivots(const SparseMatrix& pattern, const Vector& values);
  void judge_pivots(int worst);
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::SparseCholesky(const SparseMatrix& pattern) : SparseCholesky() { impl_->analyse(pattern); }
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

FactorStatus SparseCholesky::Impl::analyse(const SparseMatrix& pattern) {
  if (pattern.rows() != pattern.cols() || !pattern.isCompressed()) return FactorStatus::pattern_changed;
  if (std::shared_ptr<const LowFillPattern> low_fill = analyse_low_fill(pattern)) {
    flat.emplace(std::move(low_fill));
    return FactorStatus::success;
  }
  cholmod = std::make_unique<CholmodFactor>(true);
  const FactorStatus done = cholmod->analyse(pattern);
  if (done != FactorStatus::success) cholmod.reset();
  return done;
}

FactorStatus SparseCholesky::Impl::factorize(const SparseMatrix& pattern, const Vector& values) {
  failed_column = -1;
  if (!flat && !cholmod) {
    if (factorize_diagonal(pattern, values)) return FactorStatus::success;
    inverse_diagonal.resize(0);
    const FactorStatus analysed = analyse(pattern);
    if (analysed != FactorStatus::success) return analysed;
  }
  if (cholmod) {
    const FactorStatus done = cholmod->factorize(pattern, values);
    failed_column = cholmod->failed_column();
    return done;
  }
  if (!flat->pattern().same(pattern) || values.size() != pattern.nonZeros())
    return FactorStatus::pattern_changed;
  if (!values.allFinite()) return FactorStatus::not_finite;
  if (flat->factorize(values, true)) return FactorStatus::success;
  failed_column = flat->pattern().order[idx(flat->failed_place())];
  return std::isnan(flat->failed_pivot()) ? FactorStatus::not_finite : FactorStatus::not_positive_definite;
}

bool SparseCholesky::Impl::factorize_diagonal(const SparseMatrix& pattern, const Vector& values) {
  if (pattern.rows() != pattern.cols() || !pattern.isCompressed() || values.size() != pattern.nonZeros())
    return false;
  inverse_diagonal.setZero(pattern.rows());
  for (int j = 0; j < pattern.cols(); ++j) {
    double& inverse = inverse_diagonal[j];
    for (int s = pattern.outerIndexPtr()[j]; s < pattern.outerIndexPtr()[j + 1]; ++s) {
      if (pattern.innerIndexPtr()[s] == j)
        inverse = 1.0 / values[s];
      else if (values[s] != 0.0)
        return false;
    }
    if (!(inverse > 0.0) || !std::isfinite(inverse)) return false;
  }
  return true;
}

void SparseCholesky::Impl::check_pivots(const SparseMatrix& pattern, const Vector& values) {
  if (is_diagonal()) {
    pivot_ratio = 1.0;
    return;
  }
  if (flat) {
    pivot_ratio = flat->pivot_ratio();
    return judge_pivots(flat->worst_place() < 0 ? -1 : flat->pattern().order[idx(flat->worst_place())]);
  }
  const int n = cholmod->size();
  int worst = -1;
  pivot_ratio = 1.0;
  for (int j = 0; j < n; ++j) {
    const int column = cholmod->row(j);
    const double pivot = cholmod->diagonal(j);
    double diagonal = 0.0;
    for (int s = pattern.outerIndexPtr()[column]; s < pattern.outerIndexPtr()[column + 1]; ++s)
      if (pattern.innerIndexPtr()[s] == column) diagonal = values[s];
    const double ratio = pivot * pivot / diagonal;
    if (!(ratio >= pivot_ratio)) pivot_ratio = ratio, worst = column;
  }
  judge_pivots(worst);
}

void SparseCholesky::Impl::judge_pivots(int worst) {
  if (!std::isfinite(pivot_ratio)) {
    status = FactorStatus::not_finite;
  } else if (pivot_ratio < (10 + size()) * std::numeric_limits<double>::epsilon()) {
    status = FactorStatus::singular;
  }
  if (status != FactorStatus::success) failed_column = worst;
}

FactorStatus SparseCholesky::factorize(const SparseMatrix& pattern, const Vector& values) {
  Impl& s = *impl_;
  s.pivot_ratio = 0.0;
  s.status = s.factorize(pattern, values);
  if (s.status == FactorStatus::success) s.check_pivots(pattern, values);
  return s.status;
}

FactorStatus SparseCholesky::status() const { return impl_->status; }
int SparseCholesky::failed_column() const { return impl_->failed_column; }
double SparseCholesky::pivot_ratio() const { return impl_->pivot_ratio; }

void SparseCholesky::solve(const Vector& b, Vector& x) {
  Impl& s = *impl_;
  if (s.status != FactorStatus::success)
    throw SolverError(std::string("Cholesky: solve without a factor: ") + to_text(s.status));
  if (b.size() != s.size())
    throw SolverError("Cholesky: right-hand side has " + std::to_string(b.size()) + " entries, the matrix " +
                      std::to_string(s.size()) + " rows");
  if (s.is_diagonal()) {
    x = b.cwiseProduct(s.inverse_diagonal);
    return;
  }
  if (s.flat) return s.flat->solve(b, x);
  if (!s.cholmod->solve(b, x)) throw SolverError("Cholesky: CHOLMOD could not solve: no memory");
}

double SparseCholesky::reciprocal_condition() const {
  if (!ok()) return 0.0;
  if (impl_->cholmod) return cholmod_rcond(&impl_->cholmod->factor(), &impl_->cholmod->common());
  const Vector& inverse = impl_->is_diagonal() ? impl_->inverse_diagonal : impl_->flat->inverse_pivots();
  const auto [least, largest] = std::minmax_element(inverse.begin(), inverse.end());
  return *least / *largest;
}

Ordering SparseCholesky::ordering() const {
  const Impl& s = *impl_;
  if (s.flat) return s.flat->pattern().ordering;
  return s.cholmod && s.cholmod->factor().ordering == CHOLMOD_AMD ? Ordering::amd : Ordering::natural;
}

std::shared_ptr<const LowFillPattern> SparseCholesky::low_fill() const {
  return impl_->flat ? impl_->flat->shared_pattern() : nullptr;
}

LowFillFactor* SparseCholesky::low_fill_factor() { return impl_->flat ? &*impl_->flat : nullptr; }

int SparseCholesky::factor_entries() const {
  if (!ok()) return 0;
  if (impl_->is_diagonal()) return impl_->size();
  if (impl_->cholmod) return static_cast<int>(impl_->cholmod->factor().nzmax);
  return impl_->flat->pattern().size + static_cast<int>(impl_->flat->entries().size());
}

}  // namespace drev
