#include "solvers/sparse_cholesky.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "solvers/cholmod_factor.hpp"

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
  CholmodFactor cholmod{true};
  FactorStatus status = FactorStatus::not_computed;
  double pivot_ratio = 0.0;
  int failed_column = -1;

  void check_pivots(const SparseMatrix& pattern, const Vector& values);
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::SparseCholesky(const SparseMatrix& pattern) : SparseCholesky() {
  impl_->cholmod.analyse(pattern);
}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

void SparseCholesky::Impl::check_pivots(const SparseMatrix& pattern, const Vector& values) {
  const int n = cholmod.size();
  int worst = -1;
  pivot_ratio = 1.0;
  for (int j = 0; j < n; ++j) {
    const int column = cholmod.row(j);
    const double pivot = cholmod.diagonal(j);
    double diagonal = 0.0;
    for (int s = pattern.outerIndexPtr()[column]; s < pattern.outerIndexPtr()[column + 1]; ++s)
      if (pattern.innerIndexPtr()[s] == column) diagonal = values[s];
    const double ratio = pivot * pivot / diagonal;
    if (!(ratio >= pivot_ratio)) pivot_ratio = ratio, worst = column;
  }
  if (!std::isfinite(pivot_ratio)) {
    status = FactorStatus::not_finite;
  } else if (pivot_ratio < (10 + n) * std::numeric_limits<double>::epsilon()) {
    status = FactorStatus::singular;
  }
  if (status != FactorStatus::success) failed_column = worst;
}

FactorStatus SparseCholesky::factorize(const SparseMatrix& pattern, const Vector& values) {
  Impl& s = *impl_;
  s.pivot_ratio = 0.0;
  s.status = s.cholmod.factorize(pattern, values);
  s.failed_column = s.cholmod.failed_column();
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
  if (b.size() != s.cholmod.size())
    throw SolverError("Cholesky: right-hand side has " + std::to_string(b.size()) +
                      " entries, the matrix " + std::to_string(s.cholmod.size()) + " rows");
  if (!s.cholmod.solve(b, x)) throw SolverError("Cholesky: CHOLMOD could not solve: no memory");
}

double SparseCholesky::reciprocal_condition() const {
  if (!ok()) return 0.0;
  return cholmod_rcond(&impl_->cholmod.factor(), &impl_->cholmod.common());
}

bool SparseCholesky::natural_order() const {
  return impl_->cholmod.size() >= 0 && impl_->cholmod.factor().ordering == CHOLMOD_NATURAL;
}

int SparseCholesky::factor_entries() const {
  return ok() ? static_cast<int>(impl_->cholmod.factor().nzmax) : 0;
}

}  // namespace drev
