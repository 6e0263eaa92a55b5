#include "solvers/taylor_series.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace drev {

namespace {
constexpr int kMinDegree = 5;          // the known right side reaches degree 4
constexpr double kDiagonalFill = 2.0;  // diagonals pay up to this many values an entry
constexpr double kNegligible = 1e-16;  // part of a sum that is rounding
constexpr double kShorten = 0.9;       // of the step at which the last terms are just small enough
}  // namespace

TaylorSeries::TaylorSeries(const System& system)
    : system_(system), n_(system.size()), z_(at((kMaxDegree + 1) * n_)), rhs_(n_), solved_(n_) {
  find_storage();
  const auto fill = [&](const Vector& values, std::vector<double>& out) {
    for (Eigen::Index s = 0; s < values.size(); ++s)
      out[position_[static_cast<std::size_t>(s)]] = values[s];
  };
  fill(system.stiffness_values(), k_base_);
  fill(system.damping_values(), c_base_);
  undamped_ = system.damping_values().isZero(0.0);
  base_main_damping_ = system.damping_is_diagonal() && main_ >= 0;
  diagonal_mass_ = system.mass_is_diagonal();
  if (diagonal_mass_) {
    for (const int slot : system.diagonal_slots())
      inverse_mass_.push_back(1.0 / system.mass_values()[slot]);
  } else {
    if (mass_.factorize(system.pattern(), system.mass_values()) != FactorStatus::success)
      throw SolverError(system.name() + ": the mass matrix is not positive definite");
    Vector row_sum = Vector::Zero(n_);
    for (int i = 0; i < n_; ++i) {
      mass_.solve(Vector::Unit(n_, i), solved_);
      row_sum += solved_.cwiseAbs();
    }
    mass_norm_ = row_sum.maxCoeff();
  }
  for (Vector& p : p_) p = Vector::Zero(n_);
  std::vector<int> translational;
  for (int i = 0; i < n_; ++i)
    if (system.node_kind(system.node(system.unknown_name(i))) == NodeKind::translational)
      translational.push_back(i);
  if (static_cast<int>(translational.size()) < n_) translational_ = std::move(translational);
  reset();
}

void TaylorSeries::find_storage() {
  const SparseMatrix& p = system_.pattern();
  std::map<int, std::pair<int, int>> range;  // offset -> first and last row
  for (int row = 0; row < n_; ++row)
    for (int s = p.outerIndexPtr()[row]; s < p.outerIndexPtr()[row + 1]; ++s) {
      const int offset = p.innerIndexPtr()[s] - row;
      auto [it, added] = range.try_emplace(offset, row, row);
      it->second.second = row;
    }
  // The three in the middle at full length (they may hold zeros), so that they can share a loop.
  three_in_one_ = n_ > 2 && range.contains(-1) && range.contains(0) && range.contains(1);
  if (three_in_one_) range[-1] = {1, n_ - 1}, range[0] = {0, n_ - 1}, range[1] = {0, n_ - 2};
  std::size_t length = 0;
  for (const auto& [offset, rows] : range) {
    diagonals_.push_back({offset, rows.first, rows.second + 1, length});
    length += at(rows.second + 1 - rows.first);
  }
  const auto entries = static_cast<std::size_t>(p.nonZeros());
  if (static_cast<double>(length) > kDiagonalFill * static_cast<double>(entries)) {
    diagonals_.clear();
    length = entries;
  }
  for (std::size_t d = 0; d < diagonals_.size(); ++d)
    if (diagonals_[d].offset == 0) main_ = static_cast<int>(d);
  position_.resize(entries);
  for (int row = 0; row < n_; ++row)
    for (int s = p.outerIndexPtr()[row]; s < p.outerIndexPtr()[row + 1]; ++s) {
      position_[at(s)] = at(s);
      for (const Diagonal& d : diagonals_)
        if (d.offset == p.innerIndexPtr()[s] - row) position_[at(s)] = d.values + at(row - d.begin);
    }
  k_base_.assign(length, 0.0);
  c_base_.assign(length, 0.0);
}

void TaylorSeries::reset() {
  k_ = k_base_;
  c_ = c_base_;
  damped_ = !undamped_;
  main_damping_ = base_main_damping_;
}

void TaylorSeries::add_damping(int slot, double value) {
  c_[position_[at(slot)]] += value;
  damped_ = true;
  main_damping_ = false;
}

void TaylorSeries::product(const std::vector<double>& values, bool main_only, const double* x,
                           double factor, double* out) const {
  if (diagonals_.empty()) {
    const int* outer = system_.pattern().outerIndexPtr();
    const int* inner = system_.pattern().innerIndexPtr();
    for (int row = 0; row < n_; ++row) {
      double sum = 0.0;
      for (int s = outer[row]; s < outer[row + 1]; ++s) sum += values[at(s)] * x[inner[s]];
      out[row] -= factor * sum;
    }
    return;
  }
  const std::span<const Diagonal> all(diagonals_);
  if (three_in_one_ && !main_only) {
    const double* below = values.data() + all[at(main_ - 1)].values;  // from row 1 on
    const double* own = values.data() + all[at(main_)].values;
    const double* above = values.data() + all[at(main_ + 1)].values;
    const int last = n_ - 1;
    out[0] -= factor * (own[0] * x[0] + above[0] * x[1]);
    for (int i = 1; i < last; ++i)
      out[i] -= factor * (below[i - 1] * x[i - 1] + own[i] * x[i] + above[i] * x[i + 1]);
    out[last] -= factor * (below[last - 1] * x[last - 1] + own[last] * x[last]);
  }
  for (const Diagonal& d : main_only ? all.subspan(at(main_), 1) : all) {
    if (three_in_one_ && !main_only && std::abs(d.offset) <= 1) continue;
    const double* value = values.data() + d.values;
    const double* from = x + d.begin + d.offset;
    double* to = out + d.begin;
    const int count = d.end - d.begin;
    for (int i = 0; i < count; ++i) to[i] -= factor * value[i] * from[i];
  }
}

double TaylorSeries::bound_rates() {
  const int* outer = system_.pattern().outerIndexPtr();
  const int* inner = system_.pattern().innerIndexPtr();
  double k_scaled = 0.0, c_scaled = 0.0;
  k_norm_ = c_norm_ = 0.0;
  for (int row = 0; row < n_; ++row) {
    double sum[4] = {};  // of K and C, with the row's inertia and with the roots of both
    for (int s = outer[row]; s < outer[row + 1]; ++s) {
      const double k = std::abs(k_[position_[at(s)]]), c = std::abs(c_[position_[at(s)]]);
      const double own = diagonal_mass_ ? inverse_mass_[at(row)] : mass_norm_;
      const double both =
          diagonal_mass_ ? std::sqrt(own * inverse_mass_[at(inner[s])]) : mass_norm_;
      sum[0] += k * own;
      sum[1] += c * own;
      sum[2] += k * both;
      sum[3] += c * both;
    }
    k_norm_ = std::max(k_norm_, sum[0]);
    c_norm_ = std::max(c_norm_, sum[1]);
    k_scaled = std::max(k_scaled, sum[2]);
    c_scaled = std::max(c_scaled, sum[3]);
  }
  // |lambda|^2 <= |lambda| c + k.
  const double k = std::min(k_norm_, k_scaled), c = std::min(c_norm_, c_scaled);
  return 0.5 * (c + std::sqrt(c * c + 4.0 * k));
}

TaylorSeries::Norm TaylorSeries::norm(const double* x) const {
  if (translational_.empty())
    return {Eigen::Map<const Vector>(x, n_).lpNorm<Eigen::Infinity>(), 0.0};
  Norm result{0.0, 0.0};
  std::size_t next = 0;
  for (int i = 0; i < n_; ++i) {
    const bool moves = next < translational_.size() && translational_[next] == i;
    if (moves) ++next;
    double& largest = result[moves ? 1 : 0];
    largest = std::max(largest, std::abs(x[i]));
  }
  return result;
}

void TaylorSeries::note_scale(const Vector& z, const Vector& v) {
  const Norm a = norm(z.data()), b = norm(v.data());
  for (std::size_t i = 0; i < 2; ++i) {
    z_scale_[i] = std::max(z_scale_[i], a[i]);
    v_scale_[i] = std::max(v_scale_[i], b[i]);
  }
}

void TaylorSeries::solve_mass(const Vector& rhs, Vector& out) {
  if (!diagonal_mass_) return mass_.solve(rhs, out);
  out.resize(n_);
  for (int i = 0; i < n_; ++i) out[i] = rhs[i] * inverse_mass_[at(i)];
}

double TaylorSeries::expand(const Vector& z, const Vector& v, double h, double tolerance,
                            SeriesSource* source) {
  h_ = h;
  const auto column = [&](int k) { return z_.data() + static_cast<std::ptrdiff_t>(k) * n_; };
  std::copy_n(z.data(), n_, column(0));
  for (int i = 0; i < n_; ++i) column(1)[i] = h * v[i];
  note_scale(z, v);
  Norm z_scale = z_scale_, v_scale = v_scale_;
  for (double& x : v_scale) x *= h;
  double excess[kMaxDegree + 1] = {};  // of each term over what is allowed
  for (int k = 2; k <= kMaxDegree; ++k) {
    if (k - 2 < 3)
      rhs_ = p_[at(k - 2)];
    else
      rhs_.setZero();
    if (source) source->add(k - 2, z_.data(), rhs_.data());
    product(k_, false, column(k - 2), 1.0, rhs_.data());
    if (damped_) product(c_, main_damping_, column(k - 1), (k - 1) / h, rhs_.data());
    const double factor = h * h / (static_cast<double>(k) * (k - 1));
    double* next = column(k);
    if (diagonal_mass_) {
      for (int i = 0; i < n_; ++i) next[i] = rhs_[i] * inverse_mass_[at(i)] * factor;
    } else {
      mass_.solve(rhs_, solved_);
      for (int i = 0; i < n_; ++i) next[i] = solved_[i] * factor;
    }
    const Norm size = norm(next);
    for (std::size_t i = 0; i < 2; ++i) {
      if (size[i] == 0.0) continue;
      z_scale[i] = std::max(z_scale[i], size[i]);
      v_scale[i] = std::max(v_scale[i], k * size[i]);
      excess[k] = std::max(
          {excess[k], size[i] / (tolerance * z_scale[i]), k * size[i] / (tolerance * v_scale[i])});
    }
    degree_ = k;
    if (!std::isfinite(size[0] + size[1])) return h_ = 0.0;
    if (k < kMinDegree) continue;
    if (source) {
      if (excess[k] <= 1.0 && excess[k - 1] <= 1.0) return h_;
      continue;
    }
    const double first =
        k_norm_ * h * h / (k * (k + 1.0)) * excess[k - 1] + c_norm_ * h / (k + 1.0) * excess[k];
    const double second =
        k_norm_ * h * h / ((k + 1.0) * (k + 2.0)) * excess[k] + c_norm_ * h / (k + 2.0) * first;
    if (first <= 1.0 && second <= 1.0) return h_;
  }
  // The last two terms are too large: over r h they are r^k times as large.
  double r = 1.0;
  for (const int k : {kMaxDegree - 1, kMaxDegree})
    if (excess[k] > 1.0) r = std::min(r, std::pow(excess[k], -1.0 / (k - 1)));
  r *= kShorten;
  double power = 1.0;
  for (int k = 0; k <= degree_; ++k, power *= r)
    for (int i = 0; i < n_; ++i) column(k)[i] *= power;
  h_ = r * h;
  return h_;
}

double TaylorSeries::dissipated(double s) {
  if (undamped_) return 0.0;
  // Column j: j Z_j s^(j-1), and C times it; the integral of s^(j-1) s^(k-1) is 1/(j+k-1).
  rates_.resize(n_, degree_);
  forces_.setZero(n_, degree_);
  double power = 1.0, sum = 0.0, largest = 0.0;
  std::array<double, kMaxDegree + 1> size;
  for (int j = 1; j <= degree_; ++j, power *= s) {
    rates_.col(j - 1) = (j * power) * Eigen::Map<const Vector>(z_.data() + j * n_, n_);
    product(c_base_, base_main_damping_, rates_.col(j - 1).data(), -1.0, forces_.col(j - 1).data());
    size[at(j)] = rates_.col(j - 1).lpNorm<Eigen::Infinity>();
    largest = std::max(largest, size[at(j)]);
  }
  const double negligible = kNegligible * largest * largest;
  for (int j = 1; j <= degree_; ++j)
    for (int k = 1; k <= j; ++k)
      if (size[at(j)] * size[at(k)] > negligible)
        sum += (j == k ? 1.0 : 2.0) / (j + k - 1) * rates_.col(j - 1).dot(forces_.col(k - 1));
  return sum * s / h_;
}

void TaylorSeries::evaluate(double s, Vector& z, Vector& v) const {
  z.setZero(n_);
  v.setZero(n_);
  for (int k = degree_; k >= 0; --k) {
    const double* c = z_.data() + static_cast<std::ptrdiff_t>(k) * n_;
    if (k > 0)
      for (int i = 0; i < n_; ++i) v[i] = v[i] * s + k * c[i];
    for (int i = 0; i < n_; ++i) z[i] = z[i] * s + c[i];
  }
  v /= h_;
}

}  // namespace drev
