// TaylorSeries: sums over the terms of a step, for its end, its energies and its bounds.
#include <algorithm>
#include <array>
#include <cmath>

#include "solvers/linear/lane_pair.hpp"
#include "solvers/linear/vector_kernels.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

namespace {

// Legendre polynomials that rates are expanded in for losses: coefficients fall as (rate h/2)^k/(2 k + 1)!!, and what the most of them
// leave out is at most 1e-16 of the loss by a mode of rate h = 4.5. As few are taken as set_loss_accuracy() allows.
constexpr int kLossTerms = 12, kFewestLossTerms = 6;
// The same of the motion swept, which is a small part of all, and at the nodes of Gauss's rule: at most 1e-11 by one of rate h = 3.
constexpr int kSweptTerms = TaylorSeries::kSweptParts;
// Columns of the sums: the rate at the end, and the moments b_k = int z' L_k ds. Works of loads want the first three moments;
// the first columns are known from ranges() on.
constexpr int kRateSum = 0, kMoments = 1, kSums = kMoments + kLossTerms, kWorkMoments = 3, kEndSums = 2;
// Bounds by rows are summed from these terms; those behind them are bounded by the largest of any row.
constexpr int kRangeTerms = 8, kFirstBeyond = 4, kLastBeyond = 16;

/// Weights of the moments int y' (s - s')^m/m! ds' = swept(m) in int y' L_k ds, for s = 1: by kTerms - 1 - m, in the order of a
/// sweep's columns, then by k.
template <int kTerms>
std::array<double, std::size_t{kTerms} * kTerms> weights_of_swept() {
  std::array<double, std::size_t{kTerms} * kTerms> weight{};
  const PowersOf<kTerms> powers = legendre_powers<kTerms>();
  double factorial = 1.0;
  for (std::size_t m = 0; m < kTerms; factorial *= static_cast<double>(++m))
    for (std::size_t k = m; k < kTerms; ++k)
      weight[(kTerms - 1 - m) * kTerms + k] = (k % 2 == 0 ? factorial : -factorial) * powers[k][m];
  return weight;
}

/// Weight of term k: Hermite's cubic through values and rates at both ends is off by the largest fourth derivative times s^4/384 at most.
constexpr double beyond_weight(int k) { return k * (k - 1.0) * (k - 2.0) * (k - 3.0) / 384.0; }

struct SumWeights {
  // Weights by term k, then by column, for s = 1.
  std::array<double, std::size_t{kSums} * (TaylorSeries::kMaxDegree + 1)> end{};
  std::array<double, std::size_t{kSweptTerms}* kSweptTerms> swept = weights_of_swept<kSweptTerms>();
  std::array<double, std::size_t{2} * kRangeTerms>
      range{};  // weights of the terms' sizes from the first on: of the value, of the slope
  // Where the weights of a sum begin: end's are zero up to term j of moment j, swept's ahead of the moment's own row.
  std::array<int, kSums> end_begin{};
  std::array<int, kSweptTerms> swept_begin{};
  SumWeights() {
    for (int j = 0; j < kLossTerms; ++j) end_begin[idx(kMoments + j)] = j;
    for (int j = 0; j < kSweptTerms; ++j) swept_begin[idx(j)] = kSweptTerms - 1 - j;
    for (int k = 1; k <= TaylorSeries::kMaxDegree; ++k) {
      double* w = end.data() + k * kSums;
      w[kRateSum] = k;
      for (int j = 0; j < kLossTerms; ++j) {
        // k int u^(k-1) L_j du = k! (k-1)!/((k-1-j)! (k+j)!), which is zero below j.
        double& moment = w[kMoments + j];
        moment = k > j ? 1.0 : 0.0;
        for (int i = 1; i <= j; ++i) moment *= static_cast<double>(k - i) / (k + i);
      }
      if (k > kRangeTerms) continue;
      range[idx(2 * k - 2)] = 1.0;
      range[idx(2 * k - 1)] = k > 1 ? k : 0.0;
    }
  }
};

const SumWeights& sum_weights() {
  static const SumWeights weights;
  return weights;
}

/// Weights of the moments swept(m) in y and y' at the nodes of Gauss's rule, for s = 1: y' = sum (2 k + 1) (int y' L_k ds) L_k.
struct NodeWeights {
  std::array<NodeValues, kSweptTerms> of_moment{};
  NodeWeights() {
    const PowersOf<kSweptTerms> powers = legendre_powers<kSweptTerms>();
    const auto swept = weights_of_swept<kSweptTerms>();
    for (std::size_t m = 0; m < kSweptTerms; ++m)
      for (std::size_t k = m; k < kSweptTerms; ++k) {
        const double weight =
            (2.0 * static_cast<double>(k) + 1.0) * swept[(kSweptTerms - 1 - m) * kSweptTerms + k];
        std::array<double, kSweptTerms + 1> integral{};  // powers of the integral of L_k from 0
        for (std::size_t i = 0; i < kSweptTerms; ++i)
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

/// out: sum over m of moments_m weights_m, the slopes times per_s.
struct MomentsAtNodes {
  template <class L>
  [[gnu::always_inline]] static void run(const NodeValues* weights, const double* moments, double per_s,
                                         NodeValues* out) {
    for (std::size_t first = 0; first < out->value.size(); first += kLanes) {
      L value{}, slope{}, x;
      for (int m = 0; m < kSweptTerms; ++m) {
        load(weights[m].value.data() + first, x);
        value += moments[m] * x;
        load(weights[m].slope.data() + first, x);
        slope += moments[m] * x;
      }
      store(value, out->value.data() + first);
      store(per_s * slope, out->slope.data() + first);
    }
  }
};

}  // namespace

/// Raises the scales of the motion where terms from ... to - 1 say so: of a mode of rate w, term k is no more than (w h)^k/k! times as
/// large as the motion. most: of w h.
void TaylorSeries::note_terms(int from, int to, double most, Norm& z_scale, Norm& v_scale) const {
  const double per_time = 1.0 / h_;
  for (std::size_t kind = 0; kind < kinds(); ++kind) {
    double largest = 0.0, largest_rate = 0.0;
    for (int k = from; k < to; ++k) {
      largest = std::max(largest, sizes_[idx(k)][kind]);
      largest_rate = std::max(largest_rate, k * sizes_[idx(k)][kind]);
    }
    // As nearly always, since no growth is less than 1.
    if (largest <= z_scale[kind] && per_time * largest_rate <= v_scale[kind]) continue;
    double growth = most;
    for (int k = 1; k < to; ++k) {
      if (k > 1) growth = std::max(1.0, growth * (most * kInverse[idx(k)]));
      if (k < from) continue;
      const double size = sizes_[idx(k)][kind] / growth;
      z_scale[kind] = std::max(z_scale[kind], size);
      v_scale[kind] = std::max(v_scale[kind], k * per_time * size);
    }
  }
}

int TaylorSeries::terms_within(double part) const {
  int terms = 3;
  for (std::size_t kind = 0; kind < kinds(); ++kind) {
    double tail = 0.0;
    const double most = part * z_step_scale_[kind];
    for (int k = degree_; k >= terms; --k)
      if ((tail += sizes_[idx(k)][kind]) > most) terms = k + 1;
  }
  return terms;
}

int TaylorSeries::energy_degree() const {
  const auto rate = [&](int k) { return k * (sizes_[idx(k)][0] + sizes_[idx(k)][1]); };
  double largest = 0.0;
  for (int k = 1; k <= degree_; ++k) largest = std::max(largest, rate(k));
  int degree = degree_;
  while (degree > 1 && rate(degree) < energy_part_ * largest) --degree;
  return degree;
}

void TaylorSeries::swept_at_nodes(const std::vector<Entry>& row, double s, NodeValues& out) const {
  static const NodeWeights weights;
  const double per_s = 1.0 / s;
  std::array<double, kSweptTerms> moments;
  double part = 1.0;  // s^-m
  for (int m = 0; m < kSweptTerms; ++m, part *= per_s) moments[idx(m)] = part * value_along(row, swept(m));
  run_widest<MomentsAtNodes>(static_cast<const NodeValues*>(weights.of_moment.data()),
                             static_cast<const double*>(moments.data()), per_s, &out);
}

/// As many moments as losses in this step want: of the series, the next one tells what is left out, relative to the square of the
/// largest rate. A motion that is swept beside it bends where forces kink, but is a small part of all.
int TaylorSeries::loss_terms() const {
  const auto suffices = [this](int terms) {
    const double* weight = sum_weights().end.data() + kMoments + terms;
    for (std::size_t kind = 0; kind < kinds(); ++kind) {
      double next = 0.0;
      for (int k = terms + 1; k <= degree_; ++k) next += weight[k * kSums] * sizes_[idx(k)][kind];
      const double largest = h_ * v_step_scale_[kind];
      if (!((2 * terms + 1) * next * next <= left_of_loss_ * largest * largest)) return false;
    }
    return true;
  };
  if (undamped_ && !added_damping()) return kWorkMoments;
  int terms = kFewestLossTerms;
  while (terms < kLossTerms && !suffices(terms)) terms += 2;
  return terms;
}

const double* TaylorSeries::sums(double s) {
  if (s == sums_at_) return step_sums_.data();
  const auto& at_end = sum_weights().end;
  const double* weight = at_end.data();
  loss_terms_ = loss_terms();
  const int columns = kMoments + loss_terms_, first = s == 1.0 ? kEndSums : 0;
  if (s != 1.0) {
    part_weights_.resize(at_end.size());
    double power = s, below = 1.0;  // s^k, s^(k-1)
    for (int k = 1; k <= degree_; ++k, below = power, power *= s) {
      double* w = part_weights_.data() + k * kSums;
      const double* whole = at_end.data() + k * kSums;
      for (int j = 0; j < columns; ++j) w[j] = whole[j] * power;
      w[kRateSum] = whole[kRateSum] * below;
    }
    weight = part_weights_.data();
  }
  if (s == 1.0)
    find_ends();
  else
    step_sums_.resize(idx(kSums * stride_));
  weighted_sums(stride_, columns - first, 0, degree_, weight + kSums + first, kSums,
                sum_weights().end_begin.data() + first, coefficients(1),
                step_sums_.data() + idx(first * stride_));
  sums_at_ = s;
  ends_known_ = s == 1.0;
  return step_sums_.data();
}

/// The first columns of the sums at s = 1.
void TaylorSeries::find_ends() {
  if (ends_known_) return;
  step_sums_.resize(idx(kSums * stride_));
  sum_terms(stride_, degree_, coefficients(1), step_sums_.data() + idx(kRateSum * stride_),
            step_sums_.data() + idx(kMoments * stride_));
  sums_at_ = -1.0;
  ends_known_ = true;
}

void TaylorSeries::evaluate(double s, Vector& z, Vector& v, bool with_swept) const {
  z.resize(n_);
  v.resize(n_);
  const double *from = coefficients(0), *turn = step_sums_.data() + idx(kMoments * stride_),
               *rate = step_sums_.data() + idx(kRateSum * stride_);
  if (s != sums_at_) {
    from = zeros_.data();
    turn = values_.data();
    rate = turn + stride_;
    series_values(stride_, degree_, coefficients(0), s, values_.data(), values_.data() + stride_);
  }
  end_motion(n_, from, turn, rate, 1.0 / h_, with_swept ? swept(0) : nullptr,
             with_swept ? swept(-1) : nullptr, z.data(), v.data());
}

void TaylorSeries::add_swept(Vector& z, Vector& v) const {
  add_multiple(n_, 1.0, swept(0), z.data());
  add_multiple(n_, 1.0 / h_, swept(-1), v.data());
}

/// The sums of sizes of `count` terms from `first` on, by rows, and of a tail of each that is the same for all unknowns of a kind.
void TaylorSeries::sum_sizes(int first, int count, const double* weight, const Norm& tail,
                             const Norm& other_tail, double* out) const {
  const bool same = kinds_.empty() && row_slopes_.size() == 0;
  const std::array<double, 2> tails{tail[0], other_tail[0]};
  weighted_sums(stride_, 0, 2, count, weight, 2, nullptr, coefficients(first), out, false,
                same ? tails.data() : nullptr);
  if (same) return;
  for (int i = 0; i < n_; ++i) {
    const auto kind = idx(this->kind(i));
    out[i] += tail[kind];
    out[stride_ + i] += other_tail[kind];
  }
}

void TaylorSeries::ranges(double* end, double* size) {
  find_ends();
  std::copy_n(step_sums_.data() + idx(kMoments * stride_), stride_, end);
  const int terms = std::min(degree_, kRangeTerms);
  Norm tail{}, slope_tail{};
  for (std::size_t kind = 0; kind < kinds(); ++kind) {
    double of_kind = 0.0, slope = 0.0;  // in registers
    for (int k = terms + 1; k <= degree_; ++k) {
      of_kind += sizes_[idx(k)][kind];
      slope += k * sizes_[idx(k)][kind];
    }
    tail[kind] = of_kind;
    slope_tail[kind] = slope;
  }
  sum_sizes(1, terms, sum_weights().range.data(), tail, slope_tail, size);
  for (int i = n_; i < n_ + row_slopes_.size(); ++i)  // loaded rows, of whose terms no sizes are known
    for (int k = terms + 1; k <= degree_; ++k) {
      size[i] += std::abs(coefficient(k, i));
      size[stride_ + i] += k * std::abs(coefficient(k, i));
    }
}

void TaylorSeries::beyond_cubic(double s, double* out) {
  const int last = std::min(degree_, kLastBeyond);
  std::array<double, std::size_t{2} * (kLastBeyond - kFirstBeyond + 1)> weight;
  Norm tail{}, rate_tail{};
  const double per_time = 1.0 / h_;
  double power = s * s * s;  // s^(k-1)
  for (int k = kFirstBeyond; k <= degree_; ++k) {
    const double of_rate = beyond_weight(k) * (k - 4.0) * power * per_time;
    power *= s;
    const double of_value = beyond_weight(k) * power;
    if (k <= last) {
      weight[idx(2 * (k - kFirstBeyond))] = of_value;
      weight[idx(2 * (k - kFirstBeyond) + 1)] = of_rate;
      continue;
    }
    for (std::size_t kind = 0; kind < kinds(); ++kind) {
      tail[kind] += of_value * sizes_[idx(k)][kind];
      rate_tail[kind] += of_rate * sizes_[idx(k)][kind];
    }
  }
  sum_sizes(kFirstBeyond, last - kFirstBeyond + 1, weight.data(), tail, rate_tail, out);
}

double TaylorSeries::work(const double* p, int degree, double s) {
  if (sums_at_ >= 0.0 && degree <= 2)
    return work_of_moments(stride_, p, sums(s) + idx(kMoments * stride_), s);
  return series_work(stride_, energy_degree(), coefficients(0), degree, p, s);
}

double TaylorSeries::loss(double s, bool swept_too, bool of_added) {
  of_added = of_added && added_damping();
  if ((undamped_ && !of_added) || s == 0.0) return 0.0;
  // With b_k = int z' L_k ds and a_k = int y' L_k ds, L_k over [0, s]: sum (2 k + 1)/s (b_k + a_k) C (b_k + a_k).
  const double* of_z = sums(s) + idx(kMoments * stride_);
  std::array<double, kLossTerms> factor;
  const int terms = loss_terms_;
  for (int k = 0; k < terms; ++k) factor[idx(k)] = (2 * k + 1) / s;
  swept_moments_.resize(idx(kSweptTerms * stride_));
  double* of_y = swept_moments_.data();
  const int y_terms = swept_too ? std::min(terms, kSweptTerms) : 0;
  if (swept_too) {
    const auto& at_end = sum_weights().swept;
    const double* weight = at_end.data();
    if (s != 1.0) {
      part_weights_.assign(at_end.begin(), at_end.end());
      double part = 1.0;
      for (int m = 0; m < kSweptTerms; ++m, part /= s)
        for (int k = 0; k < kSweptTerms; ++k)
          part_weights_[idx((kSweptTerms - 1 - m) * kSweptTerms + k)] *= part;
      weight = part_weights_.data();
    }
    weighted_sums(stride_, y_terms, 0, kSweptTerms, weight, kSweptTerms, sum_weights().swept_begin.data(),
                  swept(kSweptTerms - 1), of_y);
  }
  double sum = 0.0;
  for (std::size_t i = 0; of_added && i < dampers_.size(); ++i)
    for (int k = 0; k < terms; ++k) {
      const Damper& damper = dampers_[i];
      double x = value_along(damper.term->z, of_z + idx(k * stride_));
      if (k < y_terms) x += value_along(damper.term->z, of_y + idx(k * stride_));
      sum += factor[idx(k)] * damper.c * x * x;
    }
  if (undamped_) return sum / h_;
  if (base_main_damping_)
    return (sum + weighted_squares(stride_, terms, factor.data(),
                                   c_.base.data() + diagonals_[idx(main_)].values, of_z, y_terms, of_y)) /
           h_;
  with_rows_.resize(idx(2 * pad_ + stride_));  // the product reads beside the column
  double* x = with_rows_.data() + pad_;
  for (int k = 0; k < terms; ++k) {
    for (int i = 0; i < n_; ++i)
      x[i] = of_z[idx(k * stride_ + i)] + (k < y_terms ? of_y[idx(k * stride_ + i)] : 0.0);
    solve_in_.setZero();
    subtract_product(c_.base, false, x, -1.0, solve_in_.data());
    for (int i = 0; i < n_; ++i) sum += factor[idx(k)] * x[i] * solve_in_[i];
  }
  return sum / h_;
}

std::array<TaylorSeries::Norm, 2> TaylorSeries::scales_at_nodes(const double* z, const double* v) const {
  std::array<Norm, 2> scales{z_scale_, v_scale_};
  for (int q = 0; q < GaussRule::kNodes; ++q) {
    const std::array<Norm, 2> here{norm(z + q * stride_), norm(v + q * stride_)};
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t kind = 0; kind < 2; ++kind) scales[i][kind] = std::max(scales[i][kind], here[i][kind]);
  }
  return scales;
}

void TaylorSeries::at_places(int n, const double* s, double* z, double* v) const {
  series_at_nodes(stride_, degree_, coefficients(0), s, n, z, v);
  if (v == nullptr) return;
  for (int i = 0; i < n * stride_; ++i) v[i] /= h_;
}

}  // namespace drev
