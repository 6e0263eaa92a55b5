// TaylorSeries: what forces inside a step add to its end.
#include <array>
#include <cmath>

#include "solvers/exact/taylor_series.hpp"

namespace drev {

namespace {

// Legendre polynomials that rates along the series, and those that are swept, are expanded in. Coefficients fall as
// (rate h/2)^k/(2 k + 1)!!.
constexpr int kLossTerms = 8;

/// j int u^(j-1) L_k du from 0 to 1, by k, then j.
struct RateMoments {
  std::array<double, kLossTerms*(TaylorSeries::kMaxDegree + 1)> weight{};
  PowersOf<kLossTerms> powers = legendre_powers<kLossTerms>();
  RateMoments() {
    for (std::size_t k = 0; k < kLossTerms; ++k)
      for (std::size_t j = 1; j <= TaylorSeries::kMaxDegree; ++j) {
        // j! (j-1)!/((j-1-k)! (j+k)!), which is zero below k.
        double value = j > k ? 1.0 : 0.0;
        for (std::size_t i = 1; i <= k; ++i)
          value *= (static_cast<double>(j) - static_cast<double>(i)) / static_cast<double>(j + i);
        weight[k * (TaylorSeries::kMaxDegree + 1) + j] = value;
      }
  }
};

}  // namespace

bool TaylorSeries::sweeps() const {
  return row_slopes_.size() == 0 && std::none_of(term_forces_.begin(), term_forces_.end(),
                                                 [](const TermForces* forces) { return forces->active(); });
}

void TaylorSeries::sweep(const double* moments, int degree) {
  swept_.resize(idx(2 * pad_ + (kMostSwept + 3) * stride_));
  swept_degree_ = degree;
  SeriesRecursion r = recursion(h_);
  r.derivatives = true;
  r.p = moments;
  r.p_degree = degree;
  r.z = swept_.data() + idx(pad_);
  products_ += degree + 1;
  if (!diagonals_.empty() && diagonal_mass_) {
    std::array<double, kMostSwept + 1> sizes;
    series_terms(r, 2, degree + 2, sizes.data());
  } else {
    for (int k = 2; k <= degree + 2; ++k) product_term(r, k);
  }
}

double TaylorSeries::coupling(int row, int other) const {
  const int* outer = system_.pattern().outerIndexPtr();
  for (int s = outer[row]; s < outer[row + 1]; ++s)
    if (system_.pattern().innerIndexPtr()[s] == other) return std::abs(k_[position_[idx(s)]]) * mobility(row);
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

double TaylorSeries::loss(double s, bool swept_too) {
  if (!damped_) return 0.0;
  // With b_k = int z' L_k ds and a_k = int y' L_k ds, L_k over [0, s]: sum (2 k + 1)/s (b_k + a_k) C (b_k + a_k). The moments
  // int y' (s - s')^m ds' = m! I_m, I_m = swept(m), hold those of y'.
  static const RateMoments moments;
  const int terms = energy_degree() + 1;
  std::array<double, kLossTerms> factor;
  for (int k = 0; k < kLossTerms; ++k) factor[idx(k)] = (2 * k + 1) / s;
  if (s != weights_at_ || weights_.size() != idx(kLossTerms * terms)) {
    weights_at_ = s;
    weights_.resize(idx(kLossTerms * terms));
    double power = 1.0;
    for (int j = 0; j < terms; ++j, power *= s)
      for (int k = 0; k < kLossTerms; ++k)
        weights_[idx(k * terms + j)] = power * moments.weight[idx(k * (kMaxDegree + 1) + j)];
  }
  rates_.assign(idx(2 * kLossTerms * stride_), 0.0);
  double *of_z = rates_.data(), *of_y = of_z + idx(kLossTerms * stride_);
  weighted_sums(stride_, kLossTerms, terms, weights_.data(), coefficients(0), of_z);
  if (swept_too) {
    std::array<double, kLossTerms * kLossTerms> of_moments{};
    for (std::size_t k = 0; k < kLossTerms; ++k) {
      double sign = k % 2 == 0 ? 1.0 : -1.0;
      for (std::size_t m = 0; m <= k; sign *= static_cast<double>(++m) / s)
        of_moments[k * kLossTerms + (kLossTerms - 1 - m)] = sign * moments.powers[k][m];
    }
    weighted_sums(stride_, kLossTerms, kLossTerms, of_moments.data(), swept(kLossTerms - 1), of_y);
  }
  if (main_damping_)
    return weighted_squares(stride_, kLossTerms, factor.data(), c_.data() + diagonals_[idx(main_)].values,
                            of_z, swept_too ? kLossTerms : 0, of_y) /
           h_;
  double sum = 0.0;
  with_rows_.resize(idx(2 * pad_ + stride_));  // the product reads beside the column
  double* x = with_rows_.data() + pad_;
  for (int k = 0; k < kLossTerms; ++k) {
    for (int i = 0; i < n_; ++i) x[i] = of_z[idx(k * stride_ + i)] + of_y[idx(k * stride_ + i)];
    solve_in_.setZero();
    subtract_product(c_, false, x, -1.0, solve_in_.data());
    for (int i = 0; i < n_; ++i) sum += factor[idx(k)] * x[i] * solve_in_[i];
  }
  return sum / h_;
}

}  // namespace drev
