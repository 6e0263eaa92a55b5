#include "solvers/linear/sturm_count.hpp"

#include <drev/core/error.hpp>

#include <cmath>
#include <optional>
#include <string>

#include "solvers/linear/cholmod_factor.hpp"
#include "solvers/linear/low_fill_factor.hpp"

namespace drev {

struct InertiaCounter::Impl {
  const SparseMatrix& pattern;
  const Vector &stiffness, &mass;
  Vector values, row_sum;
  std::optional<LowFillFactor> flat;
  std::unique_ptr<CholmodFactor> cholmod;  // where the factor fills too much for flat arrays

  void note(int row, double s, double sum, SturmCount& count) const;
  void count_flat(double s, SturmCount& count);
  void count_cholmod(double s, SturmCount& count);
};

InertiaCounter::InertiaCounter(const SparseMatrix& pattern, const Vector& stiffness, const Vector& mass,
                               std::shared_ptr<const LowFillPattern> analysed)
    : impl_(new Impl{.pattern = pattern,
                     .stiffness = stiffness,
                     .mass = mass,
                     .values = {},
                     .row_sum = {},
                     .flat = {},
                     .cholmod = {}}) {
  if (!analysed) analysed = analyse_low_fill(pattern);
  if (analysed)
    impl_->flat.emplace(std::move(analysed));
  else
    impl_->cholmod = std::make_unique<CholmodFactor>(false);
}
InertiaCounter::~InertiaCounter() = default;

/// Takes the growth of the factor in one row.
void InertiaCounter::Impl::note(int row, double s, double sum, SturmCount& count) const {
  double scale = 0.0;
  for (int e = pattern.outerIndexPtr()[row]; e < pattern.outerIndexPtr()[row + 1]; ++e)
    if (pattern.innerIndexPtr()[e] == row) scale = std::abs(stiffness[e]) + std::abs(s * mass[e]);
  const double growth = sum / scale;
  if (!(growth <= count.growth)) count.growth = growth;
}

void InertiaCounter::Impl::count_flat(double s, SturmCount& count) {
  if (!flat->factorize(values, false)) {  // a pivot that is exactly zero
    count.growth = INFINITY;
    return;
  }
  const LowFillPattern& p = flat->pattern();
  row_sum.setZero(p.size);
  for (int j = 0; j < p.size; ++j) {
    const double d = 1.0 / flat->inverse_pivots()[j];
    if (d < 0.0) ++count.below;
    row_sum[j] += std::abs(d);
    for (int e = p.begin[idx(j)]; e < p.begin[idx(j + 1)]; ++e)
      row_sum[p.rows[idx(e)]] += flat->entries()[e] * flat->entries()[e] * std::abs(d);
  }
  for (int j = 0; j < p.size; ++j) note(p.order[idx(j)], s, row_sum[j], count);
}

void InertiaCounter::Impl::count_cholmod(double s, SturmCount& count) {
  const FactorStatus status = cholmod->factorize(pattern, values);
  if (status == FactorStatus::not_positive_definite) {  // a pivot that is exactly zero
    count.growth = INFINITY;
    return;
  }
  if (status != FactorStatus::success)
    throw SolverError("Sturm count at s = " + std::to_string(s) + " (rad/s)^2: " + to_text(status));
  const cholmod_factor& f = cholmod->factor();
  const int* begin = static_cast<const int*>(f.p);
  const int* entries = static_cast<const int*>(f.nz);
  const int* rows = static_cast<const int*>(f.i);
  const double* x = static_cast<const double*>(f.x);
  const int n = cholmod->size();
  row_sum.setZero(n);
  for (int j = 0; j < n; ++j) {
    const double d = x[begin[j]];
    if (d < 0.0) ++count.below;
    row_sum[j] += std::abs(d);
    for (int e = begin[j] + 1; e < begin[j] + entries[j]; ++e) row_sum[rows[e]] += x[e] * x[e] * std::abs(d);
  }
  for (int j = 0; j < n; ++j) note(cholmod->row(j), s, row_sum[j], count);
}

SturmCount InertiaCounter::count_below(double s) {
  constexpr double kLargestGrowth = 1e6;
  Impl& m = *impl_;
  m.values = m.stiffness - s * m.mass;
  if (!m.values.allFinite())
    throw SolverError("Sturm count at s = " + std::to_string(s) +
                      " (rad/s)^2: " + to_text(FactorStatus::not_finite));
  SturmCount count;
  if (m.flat)
    m.count_flat(s, count);
  else
    m.count_cholmod(s, count);
  count.trusted = count.growth <= kLargestGrowth;
  return count;
}

}  // namespace drev
