// TaylorSeries: sums over the terms of a step, for its end, its energies and its bounds.
#include <array>
#include <cmath>

#include "solvers/series/taylor_series.hpp"

namespace drev {

namespace {

// Legendre polynomials that rates along the series, and those that are swept, are expanded in. Coefficients fall as
// (rate h/2)^k/(2 k + 1)!!.
constexpr int kLossTerms = 8;
// Columns of the sums: the moments b_k = int z' L_k ds and the rate at the end; then, of sizes, what the terms and their
// slopes by s add up to, and what lies beyond a cubic, of the motion and of its rate.
constexpr int kRateSum = kLossTerms, kTermSums = kRateSum + 1, kSizeSum = kTermSums, kSlopeSum = kSizeSum + 1,
              kBeyondSum = kSlopeSum + 1, kRateBeyondSum = kBeyondSum + 1, kAllSums = kRateBeyondSum + 1;

struct SumWeights {
  std::array<double, kAllSums*(TaylorSeries::kMaxDegree + 1)>
      weight{};  // by term k, then by column, for s = 1
  // Of the moments int y' (s - s')^m/m! ds' = swept(m) in int y' L_k ds, for s = 1: by kLossTerms - 1 - m, as columns of a
  // sweep stand, then by k.
  std::array<double, kLossTerms * kLossTerms> swept{};
  SumWeights() {
    const PowersOf<kLossTerms> powers = legendre_powers<kLossTerms>();
    double factorial = 1.0;
    for (std::size_t m = 0; m < kLossTerms; factorial *= static_cast<double>(++m))
      for (std::size_t k = m; k < kLossTerms; ++k)
        swept[(kLossTerms - 1 - m) * kLossTerms + k] = (k % 2 == 0 ? factorial : -factorial) * powers[k][m];
    for (int k = 1; k <= TaylorSeries::kMaxDegree; ++k) {
      double* w = weight.data() + k * kAllSums;
      for (int j = 0; j < kLossTerms; ++j) {
        // k int u^(k-1) L_j du = k! (k-1)!/((k-1-j)! (k+j)!), which is zero below j.
        w[j] = k > j ? 1.0 : 0.0;
        for (int i = 1; i <= j; ++i) w[j] *= static_cast<double>(k - i) / (k + i);
      }
      w[kRateSum] = k;
      w[kSizeSum] = 1.0;
      w[kSlopeSum] = k > 1 ? k : 0.0;
      // Of the fourth derivative: Hermite's cubic through values and rates at both ends is off by |z''''| s^4/384 at most.
      w[kBeyondSum] = k * (k - 1.0) * (k - 2.0) * (k - 3.0) / 384.0;
      w[kRateBeyondSum] = w[kBeyondSum] * (k - 4.0);
    }
  }
};

const SumWeights& sum_weights() {
  static const SumWeights weights;
  return weights;
}

/// Of the moments swept(m) in y and y' at the nodes of Gauss's rule, for s = 1: y' = sum (2 k + 1) (int y' L_k ds) L_k.
struct NodeWeights {
  std::array<NodeValues, kLossTerms> of_moment{};
  NodeWeights() {
    const PowersOf<kLossTerms> powers = legendre_powers<kLossTerms>();
    for (std::size_t m = 0; m < kLossTerms; ++m)
      for (std::size_t k = m; k < kLossTerms; ++k) {
        const double weight =
            (2.0 * static_cast<double>(k) + 1.0) * sum_weights().swept[(kLossTerms - 1 - m) * kLossTerms + k];
        std::array<double, kLossTerms + 1> integral{};  // of L_k, from 0
        for (std::size_t i = 0; i < kLossTerms; ++i)
          integral[i + 1] = powers[k][i] / static_cast<double>(i + 1);
        NodeValues at;
        find_at_nodes(integral, 1.0, at);
        for (std::size_t q = 0; q < at.value.size(); ++q) {
          of_moment[m].value[q] += weight * at.value[q];
          of_moment[m].slope[q] += weight * at.slope[q];
        }
      }
  }
};

}  // namespace

void TaylorSeries::swept_at_nodes(const std::vector<Entry>& row, double s, NodeValues& out) const {
  static const NodeWeights weights;
  out = {};
  double part = 1.0;  // s^-m
  for (int m = 0; m < kLossTerms; ++m, part /= s) {
    const double moment = value_along(row, swept(m));
    const NodeValues& weight = weights.of_moment[idx(m)];
    for (std::size_t q = 0; q < out.value.size(); ++q) {
      out.value[q] += part * moment * weight.value[q];
      out.slope[q] += part / s * moment * weight.slope[q];
    }
  }
}

const double* TaylorSeries::sums(double s) {
  if (s == sums_at_) return step_sums_.data();
  const auto& at_end = sum_weights().weight;
  const double* weight = at_end.data();
  if (s != 1.0) {
    part_weights_.assign(at_end.begin(), at_end.end());
    double power = s, below = 1.0;  // s^k, s^(k-1)
    for (int k = 1; k <= degree_; ++k, below = power, power *= s) {
      double* w = part_weights_.data() + k * kAllSums;
      for (int j = 0; j < kAllSums; ++j) w[j] *= j == kRateSum || j == kRateBeyondSum ? below : power;
    }
    weight = part_weights_.data();
  }
  step_sums_.resize(idx(kAllSums * stride_));
  weighted_sums(stride_, kTermSums, kAllSums - kTermSums, degree_ + 1, weight, coefficients(0),
                step_sums_.data());
  sums_at_ = s;
  return step_sums_.data();
}

void TaylorSeries::evaluate(double s, Vector& z, Vector& v) const {
  z.resize(n_);
  v.resize(n_);
  const double per_time = 1.0 / h_;
  if (s == sums_at_) {
    const double *start = coefficients(0), *turn = step_sums_.data(), *rate = turn + idx(kRateSum * stride_);
    for (int i = 0; i < n_; ++i) {
      z[i] = start[i] + turn[i];
      v[i] = per_time * rate[i];
    }
    return;
  }
  double* values = values_.data();
  series_values(stride_, degree_, coefficients(0), s, values, values + stride_);
  for (int i = 0; i < n_; ++i) {
    z[i] = values[i];
    v[i] = per_time * values[stride_ + i];
  }
}

void TaylorSeries::ranges(double* end, double* size, double* slope) {
  const double* sum = sums(1.0);
  std::copy_n(sum, stride_, end);
  std::copy_n(sum + idx(kSizeSum * stride_), stride_, size);
  std::copy_n(sum + idx(kSlopeSum * stride_), stride_, slope);
}

void TaylorSeries::beyond_cubic(double s, double* out) {
  const double *beyond = sums(s) + idx(kBeyondSum * stride_), per_time = 1.0 / h_;
  std::copy_n(beyond, n_, out);
  for (int i = 0; i < n_; ++i) out[n_ + i] = per_time * beyond[stride_ + i];
}

double TaylorSeries::work(const double* p, int degree, double s) {
  if (sums_at_ >= 0.0 && degree <= 2) return work_of_moments(stride_, p, sums(s), s);
  return series_work(stride_, energy_degree(), coefficients(0), degree, p, s);
}

double TaylorSeries::loss(double s, bool swept_too) {
  if (!damped_) return 0.0;
  // With b_k = int z' L_k ds and a_k = int y' L_k ds, L_k over [0, s]: sum (2 k + 1)/s (b_k + a_k) C (b_k + a_k).
  const double* of_z = sums(s);
  std::array<double, kLossTerms> factor;
  for (int k = 0; k < kLossTerms; ++k) factor[idx(k)] = (2 * k + 1) / s;
  swept_moments_.resize(idx(kLossTerms * stride_));
  double* of_y = swept_moments_.data();
  if (swept_too) {
    const auto& at_end = sum_weights().swept;
    const double* weight = at_end.data();
    if (s != 1.0) {
      part_weights_.assign(at_end.begin(), at_end.end());
      double part = 1.0;
      for (int m = 0; m < kLossTerms; ++m, part /= s)
        for (int k = 0; k < kLossTerms; ++k)
          part_weights_[idx((kLossTerms - 1 - m) * kLossTerms + k)] *= part;
      weight = part_weights_.data();
    }
    weighted_sums(stride_, kLossTerms, 0, kLossTerms, weight, swept(kLossTerms - 1), of_y);
  }
  const int y_terms = swept_too ? kLossTerms : 0;
  double sum = 0.0;
  for (const Entry& load : load_damping_)
    for (int k = 0; k < kLossTerms; ++k) {
      const auto at = idx(k * stride_ + load.index);
      const double x = of_z[at] + (k < y_terms ? of_y[at] : 0.0);
      sum -= factor[idx(k)] * load.coeff * x * x;
    }
  if (main_damping_)
    return (sum + weighted_squares(stride_, kLossTerms, factor.data(),
                                   c_.data() + diagonals_[idx(main_)].values, of_z, y_terms, of_y)) /
           h_;
  with_rows_.resize(idx(2 * pad_ + stride_));  // the product reads beside the column
  double* x = with_rows_.data() + pad_;
  for (int k = 0; k < kLossTerms; ++k) {
    for (int i = 0; i < n_; ++i)
      x[i] = of_z[idx(k * stride_ + i)] + (k < y_terms ? of_y[idx(k * stride_ + i)] : 0.0);
    solve_in_.setZero();
    subtract_product(c_, false, x, -1.0, solve_in_.data());
    for (int i = 0; i < n_; ++i) sum += factor[idx(k)] * x[i] * solve_in_[i];
  }
  return sum / h_;
}

}  // namespace drev
