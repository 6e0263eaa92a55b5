// TaylorSeries: what forces inside a step add to its end, and terms without the kernel.
#include <cmath>

#include "solvers/series/taylor_series.hpp"

namespace drev {

bool TaylorSeries::sweeps() const {
  return row_slopes_.size() == 0 &&
         std::none_of(term_forces_.begin(), term_forces_.end(),
                      [](const TermForces* forces) { return forces->active() && !forces->sweeps(); });
}

/// One term without the kernel: where the mass has to be solved for, or no diagonals are kept.
void TaylorSeries::product_term(const SeriesRecursion& r, int k) {
  const double* p = k - 2 <= r.p_degree ? r.p + idx((k - 2 - r.p_first) * stride_) : zeros_.data();
  std::copy_n(p, n_, solve_in_.data());
  subtract_product(k_.now, false, r.z + idx((k - 2) * stride_), 1.0, solve_in_.data());
  if (damped_)
    subtract_product(c_.now, main_damping_, r.z + idx((k - 1) * stride_), r.damping_factor(k) / h_,
                     solve_in_.data());
  solve_mass(solve_in_, solve_out_);
  double* next = r.z + idx(k * stride_);
  for (int i = 0; i < n_; ++i) next[i] = solve_out_[i] * (h_ * h_ * r.factor(k));
}

SeriesRecursion TaylorSeries::sweep_recursion(int degree) {
  swept_.resize(idx(2 * pad_ + (kMostSwept + 3) * stride_));
  swept_degree_ = degree;
  scale_step();
  SeriesRecursion r = recursion();
  r.derivatives = true;
  r.p = nullptr;
  r.p_degree = degree;
  r.z = swept_.data() + idx(pad_);
  return r;
}

void TaylorSeries::sweep(const RowMoments& moments, int degree) {
  SeriesRecursion r = sweep_recursion(degree);
  if (by_kernel() && moments.own_rows && moments.count <= PackedForces::kMost && takes_packed_forces(r)) {
    packed_from_.assign(idx(stride_), PackedForces::kMost);
    for (int i = 0; i < moments.count; ++i) packed_from_[idx(moments.rows[i])] = i;
    r.packed = {moments.values + degree * moments.step, moments.step, packed_from_.data()};
    r.first_kept = degree + 2 - kSweptParts;
    products_ += degree + 1;
    return series_terms(r, 2, degree + 2, nullptr);
  }
  swept_forces_.resize(idx((kMostSwept + 1) * stride_), 0.0);
  add_to_columns(moments, degree, swept_forces_.data());
  sweep(swept_forces_.data(), degree);
}

void TaylorSeries::sweep(double* moments, int degree) {
  SeriesRecursion r = sweep_recursion(degree);
  r.p = moments;
  products_ += degree + 1;
  if (by_kernel()) return series_terms(r, 2, degree + 2, nullptr);
  for (int k = 2; k <= degree + 2; ++k) product_term(r, k);
  std::fill_n(moments, idx((degree + 1) * stride_), 0.0);
}

void TaylorSeries::add_to_columns(const RowMoments& moments, int degree, double* columns) const {
  for (int i = 0; i < moments.count; ++i) {
    const double* moment = moments.values + i;
    double* at = columns + degree * stride_ + moments.rows[i];
    for (int j = 0; j <= degree; ++j, at -= stride_, moment += moments.step) *at += *moment;
  }
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
