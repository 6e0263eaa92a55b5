#include "solvers/linear/sparse_lu.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <klu.h>
#include <limits>
#include <string>
#include <vector>

namespace drev {

struct SparseLu::Impl {
  klu_common common{};
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  std::vector<int> outer, inner;
  std::vector<double> values;
  int size = -1, failed_column = -1;
  double reciprocal_condition = 0.0;
  FactorStatus status = FactorStatus::not_computed;

  Impl() { klu_defaults(&common); }
  ~Impl() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  FactorStatus analyse(const SparseMatrix& pattern);
  bool same_pattern(const SparseMatrix& pattern) const;
  FactorStatus factorize();
  FactorStatus failure();
};

FactorStatus SparseLu::Impl::analyse(const SparseMatrix& pattern) {
  if (pattern.rows() != pattern.cols() || !pattern.isCompressed()) return FactorStatus::pattern_changed;
  size = static_cast<int>(pattern.rows());
  outer.assign(pattern.outerIndexPtr(), pattern.outerIndexPtr() + size + 1);
  inner.assign(pattern.innerIndexPtr(), pattern.innerIndexPtr() + pattern.nonZeros());
  symbolic = klu_analyze(size, outer.data(), inner.data(), &common);
  return symbolic ? FactorStatus::success : failure();
}

bool SparseLu::Impl::same_pattern(const SparseMatrix& pattern) const {
  return pattern.rows() == size && pattern.isCompressed() &&
         static_cast<std::size_t>(pattern.nonZeros()) == inner.size() &&
         std::equal(outer.begin(), outer.end(), pattern.outerIndexPtr()) &&
         std::equal(inner.begin(), inner.end(), pattern.innerIndexPtr());
}

FactorStatus SparseLu::Impl::failure() {
  if (common.status == KLU_OUT_OF_MEMORY || common.status == KLU_TOO_LARGE)
    return FactorStatus::out_of_memory;
  failed_column = common.singular_col < size ? common.singular_col : -1;
  return FactorStatus::singular;
}

FactorStatus SparseLu::Impl::factorize() {
  // The old pivot order is kept while growth stays small: |U| no more than 1e6 times |A|.
  constexpr double kSmallestGrowthRatio = 1e-6;
  const auto refactored = [&] {
    return numeric && klu_refactor(outer.data(), inner.data(), values.data(), symbolic, numeric, &common) &&
           common.status == KLU_OK &&
           klu_rgrowth(outer.data(), inner.data(), values.data(), symbolic, numeric, &common) &&
           common.rgrowth >= kSmallestGrowthRatio;
  };
  if (!refactored()) {
    klu_free_numeric(&numeric, &common);
    numeric = klu_factor(outer.data(), inner.data(), values.data(), symbolic, &common);
    if (!numeric || common.status != KLU_OK) return failure();
  }
  klu_rcond(symbolic, numeric, &common);
  reciprocal_condition = common.rcond;
  return reciprocal_condition < 10 * std::numeric_limits<double>::epsilon() ? FactorStatus::singular
                                                                            : FactorStatus::success;
}

SparseLu::SparseLu() : impl_(std::make_unique<Impl>()) {}
SparseLu::SparseLu(const SparseMatrix& pattern) : SparseLu() { impl_->analyse(pattern); }
SparseLu::~SparseLu() = default;
SparseLu::SparseLu(SparseLu&&) noexcept = default;
SparseLu& SparseLu::operator=(SparseLu&&) noexcept = default;

FactorStatus SparseLu::factorize(const SparseMatrix& pattern, const Vector& values) {
  Impl& s = *impl_;
  s.failed_column = -1;
  s.reciprocal_condition = 0.0;
  s.status = s.symbolic ? FactorStatus::success : s.analyse(pattern);
  if (s.status != FactorStatus::success) return s.status;
  if (!s.same_pattern(pattern) || static_cast<std::size_t>(values.size()) != s.inner.size())
    return s.status = FactorStatus::pattern_changed;
  if (!values.allFinite()) return s.status = FactorStatus::not_finite;
  s.values.assign(values.begin(), values.end());
  return s.status = s.factorize();
}

FactorStatus SparseLu::status() const { return impl_->status; }
int SparseLu::failed_column() const { return impl_->failed_column; }
double SparseLu::reciprocal_condition() const { return impl_->reciprocal_condition; }

void SparseLu::solve(const Vector& b, Vector& x) {
  Impl& s = *impl_;
  if (s.status != FactorStatus::success)
    throw SolverError(std::string("LU: solve without a factor: ") + to_text(s.status));
  if (b.size() != s.size)
    throw SolverError("LU: right-hand side has " + std::to_string(b.size()) + " entries, the matrix " +
                      std::to_string(s.size) + " rows");
  if (&x != &b) x = b;
  if (!klu_solve(s.symbolic, s.numeric, s.size, 1, x.data(), &s.common))
    throw SolverError("LU: KLU could not solve");
}

}  // namespace drev
