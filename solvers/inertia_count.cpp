#include "solvers/inertia_count.hpp"

#include <cmath>
#include <string>

#include "solvers/cholmod_factor.hpp"

namespace drev {

struct InertiaCounter::Impl {
  CholmodFactor cholmod{false};
  const SparseMatrix& pattern;
  Vector stiffness, mass, values, row_sum;
};

InertiaCounter::InertiaCounter(const SparseMatrix& pattern, const Vector& stiffness,
                               const Vector& mass)
    : impl_(new Impl{
          .pattern = pattern, .stiffness = stiffness, .mass = mass, .values = {}, .row_sum = {}}) {}
InertiaCounter::~InertiaCounter() = default;

InertiaCount InertiaCounter::count_below(double s) {
  constexpr double kLargestGrowth = 1e6;
  Impl& m = *impl_;
  m.values = m.stiffness - s * m.mass;
  InertiaCount count;
  const FactorStatus status = m.cholmod.factorize(m.pattern, m.values);
  if (status == FactorStatus::not_positive_definite) {  // a pivot that is exactly zero
    count.growth = INFINITY;
    return count;
  }
  if (status != FactorStatus::success)
    throw SolverError("Sturm count at s = " + std::to_string(s) + " (rad/s)^2: " + to_text(status));

  const cholmod_factor& f = m.cholmod.factor();
  const int* begin = static_cast<const int*>(f.p);
  const int* entries = static_cast<const int*>(f.nz);
  const int* rows = static_cast<const int*>(f.i);
  const double* x = static_cast<const double*>(f.x);
  const int n = m.cholmod.size();
  m.row_sum.setZero(n);
  for (int j = 0; j < n; ++j) {
    const double d = x[begin[j]];
    if (d < 0.0) ++count.below;
    m.row_sum[j] += std::abs(d);
    for (int e = begin[j] + 1; e < begin[j] + entries[j]; ++e)
      m.row_sum[rows[e]] += x[e] * x[e] * std::abs(d);
  }
  for (int j = 0; j < n; ++j) {
    const int column = m.cholmod.row(j);
    double scale = 0.0;
    for (int e = m.pattern.outerIndexPtr()[column]; e < m.pattern.outerIndexPtr()[column + 1]; ++e)
      if (m.pattern.innerIndexPtr()[e] == column)
        scale = std::abs(m.stiffness[e]) + std::abs(s * m.mass[e]);
    const double growth = m.row_sum[j] / scale;
    if (!(growth <= count.growth)) count.growth = growth;
  }
  count.trusted = count.growth <= kLargestGrowth;
  return count;
}

}  // namespace drev
