#include "solvers/series/taylor_series.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "solvers/linear/extreme_eigenvalue.hpp"
#include "solvers/linear/vector_kernels.hpp"
#include "solvers/series/series_kernels.hpp"

namespace drev {

namespace {
constexpr double kDiagonalFill = 2.0;  // diagonals are kept up to this many values an entry
constexpr double kEigenvalueMargin = 1.1;
}  // namespace

TaylorSeries::TaylorSeries(const System& system)
    : system_(system), n_(system.size()), solve_in_(n_), solve_out_(n_) {
  find_storage();
  const auto fill = [&](const Vector& values, LaneVector& out) {
    for (Eigen::Index s = 0; s < values.size(); ++s) out[position_[static_cast<std::size_t>(s)]] = values[s];
  };
  fill(system.stiffness_values(), k_.base);
  fill(system.damping_values(), c_.base);
  undamped_ = system.damping_values().isZero(0.0);
  base_main_damping_ = system.damping_is_diagonal() && main_ >= 0;
  diagonal_mass_ = system.mass_is_diagonal();
  inverse_mass_.assign(idx(stride_), 0.0);
  if (diagonal_mass_) {
    for (int i = 0; i < n_; ++i)
      inverse_mass_[idx(i)] = 1.0 / system.mass_values()[system.diagonal_slots()[idx(i)]];
  } else {
    if (mass_.factorize(system.pattern(), system.mass_values()) != FactorStatus::success)
      throw SolverError(system.name() + ": the mass matrix is not positive definite");
    inverse_mass_sum_.setZero(n_);
    for (int i = 0; i < n_; ++i) {
      mass_.solve(Vector::Unit(n_, i), solve_out_);
      inverse_mass_sum_ += solve_out_.cwiseAbs();
    }
  }
  std::vector<int> kinds(idx(n_), 0);
  for (int node = 0; node < system.node_count(); ++node)
    if (system.node_map(node).unknown >= 0 && system.node_kind(node) == NodeKind::translational)
      kinds[idx(system.node_map(node).unknown)] = 1;
  const auto translational = std::count(kinds.begin(), kinds.end(), 1);
  if (translational > 0 && translational < n_) kinds_ = std::move(kinds);
  find_rows();
  k_.now = k_.base;
  if (main_ >= 0) k_main_ = k_.now.data() + diagonals_[idx(main_)].values;
  c_.now = c_.base;
  reset();
}

void TaylorSeries::find_rows() {
  const int m = system_.loaded_rows();
  row_slopes_.setZero(m);
  row_mobility_.resize(m);
  row_reach_.resize(m);
  with_rows_.assign(idx(stride_), 0.0);
  for (int j = 0; j < m; ++j) {
    solve_in_ = system_.rows().row(j).transpose();
    solve_mass(solve_in_, solve_out_);
    row_mobility_[j] = solve_in_.dot(solve_out_);
    row_reach_[j] = solve_out_.lpNorm<Eigen::Infinity>();
  }
}

void TaylorSeries::find_storage() {
  const SparseMatrix& p = system_.pattern();
  std::map<int, std::size_t> offsets;  // and which diagonal it is
  for (int row = 0; row < n_; ++row)
    for (int s = p.outerIndexPtr()[row]; s < p.outerIndexPtr()[row + 1]; ++s)
      offsets.try_emplace(p.innerIndexPtr()[s] - row, 0);
  const auto entries = static_cast<std::size_t>(p.nonZeros());
  stride_ = stride(system_);
  if (static_cast<double>(offsets.size()) * n_ > kDiagonalFill * static_cast<double>(entries))
    offsets.clear();
  for (auto& [offset, number] : offsets) {
    number = diagonals_.size();
    if (offset == 0) main_ = static_cast<int>(number);
    diagonals_.push_back({offset, number * idx(stride_)});
    pad_ = std::max(pad_, whole_lanes(std::abs(offset)));
  }
  position_.resize(entries);
  for (int row = 0; row < n_; ++row)
    for (int s = p.outerIndexPtr()[row]; s < p.outerIndexPtr()[row + 1]; ++s)
      position_[idx(s)] =
          diagonals_.empty() ? idx(s) : diagonals_[offsets.at(p.innerIndexPtr()[s] - row)].values + idx(row);
  const std::size_t length = diagonals_.empty() ? entries : diagonals_.size() * idx(stride_);
  for (Matrix* m : {&k_, &c_}) {
    m->base.assign(length, 0.0);
    m->step.assign(length, 0.0);
  }
  z_.assign(idx(2 * pad_ + (kMaxDegree + 1) * stride_), 0.0);
  p_.assign(idx(kProjectionTerms * stride_), 0.0);
  zeros_.assign(idx(stride_), 0.0);
  values_.assign(idx(2 * stride_), 0.0);
  mobility_step_.assign(idx(stride_), 0.0);
  if (diagonals_.empty()) return;
  find_views(true);
  const bool chain = main_ >= 0 && static_cast<int>(k_views_.size()) <= stride_ / kLanes;
  if (!chain) return find_views(false);
  k_chain_ = chain_of(k_.step);
  c_chain_ = chain_of(c_.step);
}

/// The views of each block of lanes; far: without those of the main diagonal and its neighbours.
void TaylorSeries::find_views(bool far) {
  const SparseMatrix& p = system_.pattern();
  k_views_.clear();
  c_views_.clear();
  block_begin_.assign(1, 0);
  single_views_ = true;
  for (int begin = 0; begin < stride_; begin += kLanes) {
    for (const Diagonal& d : diagonals_) {
      if (far && std::abs(d.offset) <= 1) continue;
      int entries = 0, column = -1;
      for (int row = begin; row < std::min(begin + kLanes, n_); ++row)
        for (int s = p.outerIndexPtr()[row]; s < p.outerIndexPtr()[row + 1]; ++s) {
          if (p.innerIndexPtr()[s] - row != d.offset) continue;
          ++entries;
          column = p.innerIndexPtr()[s];
        }
      if (entries == 0) continue;
      const int only = entries == 1 ? column : -1;
      k_views_.push_back({d.offset, k_.step.data() + d.values, only});
      c_views_.push_back({d.offset, c_.step.data() + d.values, only});
    }
    block_begin_.push_back(static_cast<int>(k_views_.size()));
    const auto in_block = std::span(k_views_).subspan(idx(*(block_begin_.end() - 2)));
    single_views_ &= in_block.empty() || (in_block.size() == 1 && in_block[0].only >= 0);
  }
}

void TaylorSeries::reset() {
  k_.reset();
  c_.reset();
  if (main_ >= 0) std::copy_n(k_.base.data() + diagonals_[idx(main_)].values, stride_, main_diagonal());
  damped_ = !undamped_;
  main_damping_ = base_main_damping_;
  k_more_ = c_more_ = 0.0;
  load_damping_.clear();
  dampers_.clear();
  std::fill_n(p_.begin(), 3 * stride_, 0.0);
  row_slopes_.setZero();
  right_degree_ = 2;
}

template <class Add>
void TaylorSeries::for_slots(const ScalarTerm& term, double value, const Add& add) {
  std::size_t slot = 0;
  for (const Entry& row : term.z)
    for (const Entry& column : term.z)
      add(position_[idx(term.slots[slot++])], value * row.coeff * column.coeff);
}

void TaylorSeries::add_spring(const ScalarTerm& term, double k) {
  for_slots(term, k, [this](std::size_t at, double value) { k_.add(at, value); });
}

void TaylorSeries::add_damper(const ScalarTerm& term, double c) {
  if (c != 0.0) {  // else products with C stay those of its main diagonal
    damped_ = true;
    main_damping_ = false;
    for_slots(term, c, [this](std::size_t at, double value) { c_.add(at, value); });
  }
  dampers_.push_back({&term, c});
}

void TaylorSeries::take_damper() {
  const Damper last = dampers_.back();
  dampers_.pop_back();
  if (last.c != 0.0)
    for_slots(*last.term, -last.c, [this](std::size_t at, double value) { c_.add(at, value); });
}

void TaylorSeries::add_row_slopes(const double* slope) {
  int first = 0;
  if (main_ >= 0 && diagonal_mass_) {
    const double widest = subtract_slopes(stride_, slope, inverse_mass_.data(), main_diagonal());
    k_more_ = std::max(k_more_, widest);
    first = n_;
  }
  for (int row = first; row < n_ + row_slopes_.size(); ++row) {
    if (slope[row] == 0.0) continue;
    add_row_stiffness(row, -slope[row]);
    widen(row, slope[row], 0.0);
  }
}

void TaylorSeries::subtract_product(const LaneVector& values, bool main_only, const double* x, double factor,
                                    double* out) const {
  if (diagonals_.empty()) {
    const int* outer = system_.pattern().outerIndexPtr();
    const int* inner = system_.pattern().innerIndexPtr();
    for (int row = 0; row < n_; ++row) {
      double sum = 0.0;
      add_row_product(outer, inner, values.data(), x, row, sum);
      out[row] -= factor * sum;
    }
    return;
  }
  for (const Diagonal& d : diagonals_) {
    if (main_only && d.offset != 0) continue;
    for (int i = 0; i < n_; ++i) out[i] -= factor * values[d.values + idx(i)] * x[i + d.offset];
  }
}

double TaylorSeries::bound_rates() {
  const int *outer = system_.pattern().outerIndexPtr(), *inner = system_.pattern().innerIndexPtr();
  k_norm_ = c_norm_ = coupling_ = 0.0;
  const double most = diagonal_mass_ ? 0.0 : inverse_mass_sum_.maxCoeff();
  for (int row = 0; row < n_; ++row) {
    const double moves = diagonal_mass_ ? mobility(row) : most;  // through M^-1 all rows act on each
    double k_sum = 0.0, c_sum = 0.0;
    for (int s = outer[row]; s < outer[row + 1]; ++s) {
      const double k = std::abs(k_.now[position_[idx(s)]]);
      if (inner[s] != row) coupling_ = std::max(coupling_, k * moves);
      k_sum += k;
      c_sum += std::abs(c_.now[position_[idx(s)]]);
    }
    k_norm_ = std::max(k_norm_, k_sum * moves);
    c_norm_ = std::max(c_norm_, c_sum * moves);
  }
  k_norm_ = std::min(k_norm_, largest_eigenvalue(k_.now));
  c_norm_ = std::min(c_norm_, largest_eigenvalue(c_.now));
  k_more_ = c_more_ = 0.0;
  return rate();
}

double TaylorSeries::rate() const {
  const double c = c_norm_ + c_more_;
  return std::max(std::sqrt(k_norm_ + k_more_), 0.5 * (c + std::sqrt(c * c + 4.0 * k_more_)));
}

void TaylorSeries::widen(int row, double k, double c) {
  if (row >= n_)  // rows share unknowns
    k_more_ += std::abs(k) * mobility(row);
  else
    k_more_ = std::max(k_more_, std::abs(k) * mobility(row));
  c_more_ = std::max(c_more_, std::abs(c) * mobility(row));
}

double TaylorSeries::largest_eigenvalue(const LaneVector& values) {
  // The margin covers what the iteration lacks after its steps.
  return kEigenvalueMargin * extreme_eigenvalue(n_, [&](const Vector& x, Vector& product) {
           std::fill(solve_in_.begin(), solve_in_.end(), 0.0);
           std::copy_n(x.data(), n_, z_.data() + pad_);
           subtract_product(values, false, z_.data() + pad_, -1.0, solve_in_.data());
           solve_mass(solve_in_, product);
         });
}

void TaylorSeries::scale_as(const TaylorSeries& other) {
  k_norm_ = other.k_norm_;
  c_norm_ = other.c_norm_;
  coupling_ = other.coupling_;
  z_scale_ = z_step_scale_ = other.z_scale_;
  v_scale_ = v_step_scale_ = other.v_scale_;
}

TaylorSeries::Norm TaylorSeries::norm(const double* x) const {
  if (kinds_.empty()) return {largest_size(n_, x), 0.0};
  Norm result{};
  for (int i = 0; i < n_; ++i) {
    double& largest = result[idx(kinds_[idx(i)])];
    largest = std::max(largest, std::abs(x[i]));
  }
  return result;
}

void TaylorSeries::note_scale(const Vector& z, const Vector& v) {
  const Norm a = norm(z.data()), b = norm(v.data());
  for (std::size_t i = 0; i < 2; ++i) {
    z_scale_[i] = std::max(z_scale_[i], a[i]);
    v_scale_[i] = std::max(v_scale_[i], b[i]);
    sizes_[1][i] = h_ * b[i];
  }
}

void TaylorSeries::solve_mass(const Vector& rhs, Vector& out) {
  if (!diagonal_mass_) return mass_.solve(rhs, out);
  out.resize(n_);
  for (int i = 0; i < n_; ++i) out[i] = rhs[i] * inverse_mass_[idx(i)];
}

/// with_rows_ = p with the rows' forces less their slopes times x_0.
void TaylorSeries::add_row_forces(const double* p, const double* x_0) {
  const Eigen::Index m = row_slopes_.size();
  const auto tail = [&](const double* x) { return Eigen::Map<const Vector>(x + n_, m); };
  row_forces_ = tail(p) - row_slopes_.cwiseProduct(tail(x_0));
  std::copy_n(p, n_, with_rows_.data());
  Eigen::Map<Vector>(with_rows_.data(), n_).noalias() += system_.rows().topRows(m).transpose() * row_forces_;
}

/// The diagonals below, on and above the main one; zeros for one that there is not.
TaylorSeries::Chain TaylorSeries::chain_of(const LaneVector& values) const {
  Chain chain{zeros_.data(), zeros_.data(), zeros_.data()};
  for (const Diagonal& d : diagonals_)
    if (std::abs(d.offset) <= 1) chain[idx(d.offset + 1)] = values.data() + d.values;
  return chain;
}

/// The matrices that stand now, for the recursion over a step of h_.
void TaylorSeries::scale_step() {
  double* mobility = mobility_step_.data();
  const auto row_of = [this](std::size_t at) {  // in 32 bits, whose division takes half the time
    return static_cast<std::uint32_t>(at) % static_cast<std::uint32_t>(stride_);
  };
  const auto update = [&](Matrix& m, double factor) {
    if (by_kernel() && scaled_h_ == h_)
      for (const std::size_t at : m.unscaled) m.step[at] = factor * mobility[row_of(at)] * m.now[at];
    else if (by_kernel())
      for (const Diagonal& d : diagonals_)
        scaled_product(stride_, factor, mobility, m.now.data() + d.values, m.step.data() + d.values);
    m.unscaled.clear();
  };
  if (scaled_h_ != h_)
    for (int i = 0; i < n_; ++i) mobility[i] = h_ * h_ * inverse_mass_[idx(i)];
  if (main_unscaled_ && scaled_h_ == h_) {
    const std::size_t main = diagonals_[idx(main_)].values;
    scaled_product(stride_, -1.0, mobility, k_.now.data() + main, k_.step.data() + main);
  }
  update(k_, -1.0);
  update(c_, -1.0 / h_);
  scaled_h_ = h_;
  main_unscaled_ = false;
}

SeriesRecursion TaylorSeries::recursion() {
  const bool whole = damped_ && !main_damping_;
  return {.stride = stride_,
          .k = {block_begin_.data(), k_views_.data(), single_views_},
          .c = {block_begin_.data(), whole ? c_views_.data() : nullptr},
          .c_main = damped_ && main_damping_ ? c_.step.data() + diagonals_[idx(main_)].values : nullptr,
          .mobility = mobility_step_.data(),
          .p = p_.data(),
          .p_first = 0,
          .p_degree = right_degree_,
          .z = z_.data() + idx(pad_),
          .k_chain = k_chain_,
          .c_chain = whole ? c_chain_ : Chain{}};
}

}  // namespace drev
