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
constexpr double kEnergyPart = 0.01;  // terms that energies do without, relative to the tolerance
// Size of the last two terms where series are multiplied, relative to what is allowed.
constexpr double kLastOfProducts = 0.1;
constexpr int kFewer = 4;               // terms that a step may do with less than the step before
constexpr double kShortenSeries = 0.9;  // factor on the step at which the last terms are just small enough
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
    Vector row_sum = Vector::Zero(n_);
    for (int i = 0; i < n_; ++i) {
      mass_.solve(Vector::Unit(n_, i), solve_out_);
      row_sum += solve_out_.cwiseAbs();
    }
    mass_norm_ = row_sum.maxCoeff();
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
  for (int row = 0; row < n_; ++row) {
    double k_sum = 0.0, c_sum = 0.0;
    for (int s = outer[row]; s < outer[row + 1]; ++s) {
      const double k = std::abs(k_.now[position_[idx(s)]]);
      if (inner[s] != row) coupling_ = std::max(coupling_, k * mobility(row));
      k_sum += k;
      c_sum += std::abs(c_.now[position_[idx(s)]]);
    }
    k_norm_ = std::max(k_norm_, k_sum * mobility(row));
    c_norm_ = std::max(c_norm_, c_sum * mobility(row));
  }
  // |lambda|^2 <= |lambda| c + k.
  k_norm_ = std::min(k_norm_, largest_eigenvalue(k_.now));
  c_norm_ = std::min(c_norm_, largest_eigenvalue(c_.now));
  k_more_ = c_more_ = 0.0;
  return rate();
}

double TaylorSeries::rate() const {
  const double k = k_norm_ + k_more_, c = c_norm_ + c_more_;
  return 0.5 * (c + std::sqrt(c * c + 4.0 * k));
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
    if (is_small && added_excess(k) <= 1.0 && added_excess(k - 1) <= 1.0) return end(k, h);
  }
  // The last two terms are too large: over r h they are r^k times as large.
  double r = 1.0;
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
