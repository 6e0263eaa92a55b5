#include "solvers/linear/cholmod_factor.hpp"

#include <algorithm>

namespace drev {

namespace {

/// CHOLMOD's view of A; nothing is copied. CHOLMOD does not write through the pointers.
cholmod_sparse view(const SparseMatrix& pattern, const double* values, int triangle) {
  cholmod_sparse a{};
  a.nrow = a.ncol = static_cast<std::size_t>(pattern.rows());
  a.nzmax = static_cast<std::size_t>(pattern.nonZeros());
  a.p = const_cast<int*>(pattern.outerIndexPtr());
  a.i = const_cast<int*>(pattern.innerIndexPtr());
  a.x = const_cast<double*>(values);
  a.stype = triangle;
  a.itype = CHOLMOD_INT;
  a.xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = a.packed = 1;
  return a;
}

cholmod_dense view(double* values, int n) {
  cholmod_dense d{};
  d.nrow = d.nzmax = d.d = static_cast<std::size_t>(n);
  d.ncol = 1;
  d.x = values;
  d.xtype = CHOLMOD_REAL;
  d.dtype = CHOLMOD_DOUBLE;
  return d;
}

}  // namespace

CholmodFactor::CholmodFactor(bool ll) {
  cholmod_start(&common_);
  common_.print = 0;
  common_.error_handler = nullptr;
  common_.supernodal = CHOLMOD_SIMPLICIAL;
  common_.final_asis = 0;
  common_.final_super = 0;
  common_.final_ll = ll ? 1 : 0;
  common_.quick_return_if_not_posdef = 1;
  common_.nmethods = 1;
}

CholmodFactor::~CholmodFactor() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_free_dense(&y_, &common_);
  cholmod_free_dense(&e_, &common_);
  cholmod_finish(&common_);
}

bool CholmodFactor::same_pattern(const SparseMatrix& pattern) const {
  return pattern.rows() == size_ && pattern.isCompressed() &&
         static_cast<std::size_t>(pattern.nonZeros()) == inner_.size() &&
         std::equal(outer_.begin(), outer_.end(), pattern.outerIndexPtr()) &&
         std::equal(inner_.begin(), inner_.end(), pattern.innerIndexPtr());
}

FactorStatus CholmodFactor::analyse(const SparseMatrix& pattern) {
  if (pattern.rows() != pattern.cols() || !pattern.isCompressed()) return FactorStatus::pattern_changed;
  cholmod_sparse a = view(pattern, nullptr, 1);
  common_.method[0].ordering = CHOLMOD_NATURAL;
  common_.postorder = 0;
  factor_ = cholmod_analyze(&a, &common_);
  const double natural_fill = common_.lnz;
  common_.method[0].ordering = CHOLMOD_AMD;
  common_.postorder = 1;
  cholmod_factor* amd = cholmod_analyze(&a, &common_);
  if (!factor_ || !amd) {
    cholmod_free_factor(&factor_, &common_);
    cholmod_free_factor(&amd, &common_);
    return FactorStatus::out_of_memory;
  }
  if (common_.lnz < natural_fill) std::swap(factor_, amd);
  cholmod_free_factor(&amd, &common_);
  size_ = static_cast<int>(pattern.rows());
  outer_.assign(pattern.outerIndexPtr(), pattern.outerIndexPtr() + size_ + 1);
  inner_.assign(pattern.innerIndexPtr(), pattern.innerIndexPtr() + pattern.nonZeros());
  return FactorStatus::success;
}

FactorStatus CholmodFactor::factorize(const SparseMatrix& pattern, const Vector& values) {
  failed_column_ = -1;
  if (!factor_) {
    const FactorStatus analysed = analyse(pattern);
    if (analysed != FactorStatus::success) return analysed;
  } else if (!same_pattern(pattern)) {
    return FactorStatus::pattern_changed;
  }
  if (static_cast<std::size_t>(values.size()) != inner_.size()) return FactorStatus::pattern_changed;
  if (!values.allFinite()) return FactorStatus::not_finite;
  // The triangle that CHOLMOD need not transpose (natural order) or transposes once.
  const int triangle = factor_->ordering == CHOLMOD_NATURAL ? 1 : -1;
  cholmod_sparse a = view(pattern, values.data(), triangle);
  cholmod_factorize(&a, factor_, &common_);
  if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE)
    return FactorStatus::out_of_memory;
  if (common_.status == CHOLMOD_NOT_POSDEF || factor_->minor < factor_->n) {
    failed_column_ = row(static_cast<int>(std::min(factor_->minor, factor_->n - 1)));
    return FactorStatus::not_positive_definite;
  }
  return common_.status == CHOLMOD_OK ? FactorStatus::success : FactorStatus::not_computed;
}

bool CholmodFactor::solve(const Vector& b, Vector& x) {
  x.resize(size_);
  cholmod_dense rhs = view(const_cast<double*>(b.data()), size_);
  cholmod_dense result = view(x.data(), size_);
  cholmod_dense* result_handle = &result;
  return cholmod_solve2(CHOLMOD_A, factor_, &rhs, nullptr, &result_handle, nullptr, &y_, &e_, &common_) != 0;
}

int CholmodFactor::row(int j) const { return factor_->Perm ? static_cast<const int*>(factor_->Perm)[j] : j; }

std::vector<int> CholmodFactor::order() const {
  std::vector<int> rows(static_cast<std::size_t>(size_));
  for (int j = 0; j < size_; ++j) rows[static_cast<std::size_t>(j)] = row(j);
  return rows;
}

double CholmodFactor::diagonal(int j) const {
  return static_cast<const double*>(factor_->x)[static_cast<const int*>(factor_->p)[j]];
}

}  // namespace drev
