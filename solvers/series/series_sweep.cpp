// TaylorSeries: what forces inside a step add to its end.
#include <cmath>

#include "solvers/series/taylor_series.hpp"

namespace drev {

bool TaylorSeries::sweeps() const {
  return row_slopes_.size() == 0 &&
         std::none_of(term_forces_.begin(), term_forces_.end(),
                      [](const TermForces* forces) { return forces->active() && !forces->sweeps(); });
}

void TaylorSeries::sweep(double* moments, int degree) {
  swept_.resize(idx(2 * pad_ + (kMostSwept + 3) * stride_));
  swept_degree_ = degree;
  scale_step();
  SeriesRecursion r = recursion();
  r.derivatives = true;
  r.p = moments;
  r.p_degree = degree;
  r.z = swept_.data() + idx(pad_);
  products_ += degree + 1;
  if (by_kernel()) return series_terms(r, 2, degree + 2, nullptr);
  for (int k = 2; k <= degree + 2; ++k) product_term(r, k);
  std::fill_n(moments, idx((degree + 1) * stride_), 0.0);
}

double TaylorSeries::coupling(int row, int other) const {
  const int* outer = system_.pattern().outerIndexPtr();
  for (int s = outer[row]; s < outer[row + 1]; ++s)
    if (system_.pattern().innerIndexPtr()[s] == other)
      return std::abs(k_.now[position_[idx(s)]]) * mobility(row);
  return 0.0;
}

bool TaylorSeries::share_neighbour(int row, int other) const {
  const int *outer = system_.pattern().outerIndexPtr(), *inner = system_.pattern().innerIndexPtr();
  int a = outer[row], b = outer[other];
  while (a < outer[row + 1] && b < outer[other + 1]) {
    if (inner[a] == inner[b]) return true;
    ++(inner[a] < inner[b] ? a : b);
  }
  return false;
}

}  // namespace drev
