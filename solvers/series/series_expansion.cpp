// The series itself, degree by degree, until what it leaves out is small enough.
#include <algorithm>
#include <cmath>

#include "solvers/linear/vector_kernels.hpp"
#include "solvers/series/series_kernels.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

namespace {

constexpr double kEnergyPart = 0.01;  // terms that energies do without, relative to the tolerance
// Size of the last two terms where series are multiplied, relative to what is allowed.
constexpr double kLastOfProducts = 0.1;
constexpr int kFewer = 4;               // terms that a step may do with less than the step before
constexpr double kShortenSeries = 0.9;  // factor on the step at which the last terms are just small enough

}  // namespace

/// False: none of them acts.
bool TaylorSeries::add_term_forces(int k, double factor, double* term) {
  bool any = false;
  added_[idx(k)] = {};
  for (TermForces* forces : term_forces_) {
    if (!forces->active()) continue;
    const double most = forces->add(*this, k, factor, term);
    for (double& added : added_[idx(k)]) added = std::max(added, most);
    any = true;
  }
  return any;
}

/// Of the terms behind k, what forces still make of them at the step's end, at most, where no two terms in a row tell: from rest at
/// the top of a torque, the square of the angle begins with s^4.
TaylorSeries::Norm TaylorSeries::left_out(int k) const {
  Norm most{};
  const double factor = h_ * h_ * kInverse[idx(k + 1)] * kInverse[idx(k)];
  for (const TermForces* forces : term_forces_)
    if (forces->active()) forces->note_left_out(*this, k, factor, most);
  return most;
}

void TaylorSeries::next_terms(int first, int last) {
  if (by_diagonals()) {
    double largest[kMaxDegree];
    SeriesRecursion all = recursion();
    if (std::any_of(term_forces_.begin(), term_forces_.end(),
                    [](const TermForces* forces) { return forces->active(); })) {
      all.hook = {[](void* of, int k, double* term) {
                    auto& series = *static_cast<TaylorSeries*>(of);
                    return series.add_term_forces(
                        k, series.h_ * series.h_ * kInverse[idx(k)] * kInverse[idx(k - 1)], term);
                  },
                  this};
    }
    series_terms(all, first, last, largest);
    for (int k = first; k <= last; ++k) sizes_[idx(k)] = {largest[k - first], 0.0};
    return;
  }
  for (int k = first; k <= last; ++k) sizes_[idx(k)] = next_term(k);
}

TaylorSeries::Norm TaylorSeries::next_term(int k) {
  SeriesRecursion one = recursion();
  if (row_slopes_.size() > 0) {
    add_row_forces(k - 2 <= right_degree_ ? right_side(k - 2) : zeros_.data(), coefficients(k - 2));
    one.p = with_rows_.data();
    one.p_first = one.p_degree = k - 2;
  }
  double* next = one.z + idx(k * stride_);
  double largest = 0.0;
  if (by_kernel())
    series_terms(one, k, k, &largest);
  else
    product_term(one, k);
  const bool more = add_term_forces(k, h_ * h_ * one.factor(k), next);
  rows_of(next);
  return by_kernel() && kinds_.empty() && !more ? Norm{largest, 0.0} : norm(next);
}

double TaylorSeries::expand(const Vector& z, const Vector& v, double h, double tolerance) {
  h_ = h;
  sums_at_ = -1.0;
  ends_known_ = false;
  scale_step();
  energy_part_ = std::clamp(kEnergyPart * tolerance, 1e-13, 1e-9);
  const auto column = [&](int k) { return z_.data() + idx(pad_ + k * stride_); };
  std::copy_n(z.data(), n_, column(0));
  sum_with(n_, zeros_.data(), h, v.data(), column(1));
  for (int k = 0; k < 2; ++k) rows_of(column(k));
  note_scale(z, v);
  Norm z_scale = z_scale_, v_scale = v_scale_;
  const double k_step = (k_norm_ + k_more_) * h * h, c_step = (c_norm_ + c_more_) * h;
  const auto inverse = [](int k) { return kInverse[idx(k)]; };
  const std::size_t kinds = this->kinds();
  // Size of a term over what is allowed, and the same of what forces added to it.
  Norm per_z{}, per_v{}, scales_of{};
  const auto excess_of = [&](const Norm& size, int k) {
    double largest = 0.0;
    for (std::size_t i = 0; i < kinds; ++i) {
      if (!(size[i] > 0.0)) continue;
      if (scales_of[i] != z_scale[i] + h * v_scale[i]) {  // they hardly change from the first terms on
        scales_of[i] = z_scale[i] + h * v_scale[i];
        per_z[i] = 1.0 / (tolerance * z_scale[i]);
        per_v[i] = 1.0 / (tolerance * h * v_scale[i]);
      }
      largest = std::max(largest, size[i] * std::max(per_z[i], k * per_v[i]));
    }
    return largest;
  };
  const auto excess = [&](int k) { return excess_of(sizes_[idx(k)], k); };
  const auto added_excess = [&](int k) {
    Norm size;
    for (std::size_t i = 0; i < 2; ++i) size[i] = std::min(added_[idx(k)][i], sizes_[idx(k)][i]);
    return excess_of(size, k) / kLastOfProducts;
  };
  int known_degree = right_degree_;
  bool products = false;  // products of series act, whose tails the norms of K and C alone do not bound
  for (const TermForces* forces : term_forces_)
    if (forces->active()) {
      known_degree = std::max(known_degree, forces->known_degree());
      products = true;
    }
  const auto end = [&](int degree, double got) {
    z_step_scale_ = z_scale;
    v_step_scale_ = v_scale;
    degree_ = degree;
    products_ += degree - 1;
    return h_ = got;
  };
  double last = 0.0;
  const double most_growth = std::max(std::sqrt(k_step), c_step);
  // The last term there is. The kernel takes many at once: as many as the step before needed are nearly always wanted.
  int known = 1;
  const int likely = by_diagonals() ? degree_ : 0;
  const int judged = likely - kFewer;  // terms before this one are not asked whether they are the last
  const auto note = [&](int from, int to) { note_terms(from, to, most_growth, z_scale, v_scale); };
  const int unasked =
      std::max(known_degree + 2, judged);  // before, a term of the right side may still be to come
  for (int k = 2; k <= kMaxDegree; ++k) {
    if (k > known) {
      known = std::min(std::max({k, known_degree + 2, likely}), kMaxDegree);
      next_terms(k, known);
      if (const Norm& size = sizes_[idx(known)]; !std::isfinite(size[0] + size[1])) return end(k, 0.0);
      if (unasked <= known && k < unasked) {
        note(k, unasked);
        k = unasked;
      }
    }
    note(k, k + 1);
    if (k < unasked) continue;
    const double before = last;
    last = excess(k);
    if (k == unasked) continue;
    const double first = inverse(k + 1) * (k_step * inverse(k) * before + c_step * last);
    const double second = inverse(k + 2) * (k_step * inverse(k + 1) * last + c_step * first);
    const bool is_small = first <= 1.0 && second <= 1.0;
    if (is_small && !products) return end(k, h);
    // Terms of products fall like a geometric series, whose rest is a multiple of the last ones.
    if (is_small && added_excess(k) <= 1.0 && added_excess(k - 1) <= 1.0 &&
        excess_of(left_out(k), k + 1) <= 1.0)
      return end(k, h);
  }
  // The last two terms are too large, or what is left out: over r h they are r^k times as large.
  double r = 1.0;
  if (const double left = products ? excess_of(left_out(kMaxDegree), kMaxDegree + 1) : 0.0; left > 1.0)
    r = std::pow(left, -1.0 / kMaxDegree);
  for (const int k : {kMaxDegree - 1, kMaxDegree}) {
    const double most = std::max(excess(k), products ? added_excess(k) : 0.0);
    if (most > 1.0) r = std::min(r, std::pow(most, -1.0 / (k - 1)));
  }
  r *= kShortenSeries;
  double power = 1.0;
  for (int k = 0; k <= kMaxDegree; ++k, power *= r)
    for (int i = 0; i < stride_; ++i) column(k)[i] *= power;
  return end(kMaxDegree, r * h);
}

}  // namespace drev
