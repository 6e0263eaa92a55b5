#include "solvers/exact/law_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "solvers/contact/pieces.hpp"
#include "solvers/contact/roots.hpp"
#include "solvers/exact/expanded_laws.hpp"
#include "solvers/series/series_kernels.hpp"

namespace drev {

namespace {

// A coefficient below this part of the terms it was summed from is zero: rounding.
constexpr double kZero = 1e-13;
// The same for higher ones, relative to the bound's own terms at s = 0 (their cancellation is not
// seen).
constexpr double kFloor = 4e-15;
// A deflection is clear of a bound, relative to the terms that it is summed from.
constexpr double kClear = 1e-14;
constexpr double kPastOff = 2.0;     // times as far as the motion is off the bound
constexpr double kMostClear = 1e-3;  // largest distance from a change, relative to the step
// A crossing that a motion beside the series moves by no more of the step, with slopes that differ by no more, is one.
constexpr double kNearCrossing = 0.05, kAlike = 3.0;
constexpr double kParallel = 1e-9;  // two bounds are one line, relative to their coefficients

/// int_0^s (sum a_j s^j) (sum b_k s^k)' ds.
double work_of(std::span<const double> a, std::span<const double> b, double s) {
  double sum = 0.0, s_j = 1.0;
  for (std::size_t j = 0; j < a.size(); ++j, s_j *= s) {
    double s_k = s_j * s;
    for (std::size_t k = 1; k < b.size(); ++k, s_k *= s)
      sum += a[j] * b[k] * s_k * static_cast<double>(k) / static_cast<double>(j + k);
  }
  return sum;
}

/// b is the other side of a's line.
bool opposite(const LawBound& a, const LawBound& b) {
  const double size_a = std::max({std::abs(a.a), std::abs(a.b_x), std::abs(a.b_v)});
  const double size_b = std::max({std::abs(b.a), std::abs(b.b_x), std::abs(b.b_v)});
  const auto cancels = [&](double p, double q) { return std::abs(p / size_a + q / size_b) <= kParallel; };
  return cancels(a.a, b.a) && cancels(a.b_x, b.b_x) && cancels(a.b_v, b.b_v);
}

/// On which side of the gap a piece lies: 1, 0, -1; none: on several, or there is no gap.
std::optional<int> side_of(const LawPiece& piece, const std::optional<Gap>& gap) {
  if (!gap) return std::nullopt;
  const Interval x = piece.x_range();
  if (x.low >= gap->high) return 1;
  if (x.high <= gap->low) return -1;
  if (x.low >= gap->low && x.high <= gap->high) return 0;
  return std::nullopt;
}

}  // namespace

LawSeries::LawSeries(const System& system) : system_(system), laws_(system.scalars().size()) {
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const ScalarTerm& term = system.scalars()[j];
    Law& law = laws_[j];
    law.number = static_cast<int>(j);
    const std::span<const LawPiece> own = linear_pieces(term);
    law.pieces = own.empty() ? bounds_alone(*term.force) : std::vector<LawPiece>(own.begin(), own.end());
    law.expanded = ExpandedLaws::takes(term);
    if (law.expanded)
      for (std::size_t i = 0; i < law.pieces.size(); ++i)
        if (const LawPiece& piece = term.force->pieces()[i]; ExpandedLaws::is_linear(term, piece))
          law.pieces[i] = piece;
    for (const LawPiece& p : law.pieces) law.sides.push_back(side_of(p, term.force->gap()));
    if (!term.force->varies() || term.phase_node < 0) continue;
    for (const LawPiece& p : law.pieces)
      for (const LawBound& b : p.bounds) law.scaled |= b.b_v != 0.0;
  }
}

void LawSeries::locate(const std::vector<ScalarInput>& inputs) {
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const ScalarInput& in = inputs[j];
    const double r = laws_[j].scaled ? system_.scalars()[j].force->pieces_scale(in.angle) : 1.0;
    laws_[j].piece = piece_at(laws_[j].pieces, in.x, in.x_dot / r);
    laws_[j].root = -1;
  }
}

void LawSeries::add_to(TaylorSeries& series, const LoadSeries& known, double h) const {
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const ScalarTerm& term = system_.scalars()[j];
    const LawPiece& p = current(j);
    if (p.k != 0.0) series.add_spring(term, p.k);
    if (p.c != 0.0) series.add_damper(term, p.c);
    std::array<double, 3> y{p.y_0, 0.0, 0.0};
    for (const Entry& e : term.u) {
      const std::array<double, 3>& u = known.prescribed(e.index);
      for (std::size_t i = 0; i < 3; ++i) {
        y[i] += p.k * e.coeff * u[i];
        if (i < 2) y[i] += p.c * e.coeff * static_cast<double>(i + 1) * u[i + 1] / h;
      }
    }
    for (const Entry& e : term.z)
      for (std::size_t i = 0; i < 3; ++i)
        if (y[i] != 0.0) series.right_side(static_cast<int>(i))[e.index] -= e.coeff * y[i];
  }
}

void LawSeries::add_stiffest(TaylorSeries& series) const {
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const ScalarTerm& term = system_.scalars()[j];
    // A smooth law's stretches carry no force of their own.
    double k = std::abs(term.force->closed_stiffness()), c = std::abs(term.force->closed_damping());
    for (const LawPiece& p : laws_[j].pieces) {
      k = std::max(k, std::abs(p.k));
      c = std::max(c, std::abs(p.c));
    }
    series.add_spring(term, k);
    series.add_damper(term, c);
  }
}

void LawSeries::expand(const TaylorSeries& series, const LoadSeries& known, const LawOffsets& offsets,
                       const double* sizes, const ScaleSeries& scale_of) {
  h_ = series.step();
  series_ = &series;
  offsets_ = &offsets;
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const ScalarTerm& term = system_.scalars()[j];
    Law& law = laws_[j];
    law.known.fill(0.0);
    law.known_size.fill(0.0);
    for (const Entry& e : term.u)
      for (std::size_t k = 0; k < 3; ++k) {
        const double part = e.coeff * known.prescribed(e.index)[k];
        law.known[k] += part;
        law.known_size[k] += std::abs(part);
      }
    law.whole = false;
    if (law.scaled) scale_of(static_cast<int>(j), law.scale);
    const std::vector<double>& offset = offsets.offset(static_cast<int>(j));
    if (sizes == nullptr || offset.size() > 1) {
      const std::vector<double>& x = series_of(law);
      law.x_0 = x[0];
      law.x_1 = x[1];
      continue;
    }
    law.x_0 = law.known[0] + (offset.empty() ? 0.0 : offset[0]);
    law.x_1 = law.known[1];
    law.reach = std::abs(law.known[1]) + std::abs(law.known[2]);
    law.rate_reach = 2.0 * std::abs(law.known[2]);
    for (const Entry& e : term.z) {
      law.x_0 += e.coeff * series.coefficient(0, e.index);
      law.x_1 += e.coeff * series.coefficient(1, e.index);
      law.reach += std::abs(e.coeff) * sizes[e.index];
      law.rate_reach += std::abs(e.coeff) * sizes[series.stride() + e.index];
    }
  }
}

/// The series of a law's deflection: summed up when first asked for, since most steps keep clear of its bounds.
const std::vector<double>& LawSeries::series_of(const Law& law) const {
  if (law.whole) return law.x;
  law.whole = true;
  const auto terms = static_cast<std::size_t>(series_->degree()) + 1;
  const std::vector<double>& offset = offsets_->offset(law.number);
  const std::size_t count = std::max(terms, offset.size());
  row_.assign(idx(whole_lanes(static_cast<int>(count))), 0.0);
  std::copy(offset.begin(), offset.end(), row_.begin());
  for (std::size_t k = 0; k < law.known.size(); ++k) row_[k] += law.known[k];
  const auto sums = add_row_terms(series_->stride(), static_cast<int>(terms), series_->coefficients(0),
                                  system_.scalars()[idx(law.number)].z, row_.data());
  law.reach = sums[0];
  law.rate_reach = sums[1];
  // Of an offset's longer series.
  for (auto k = idx(whole_lanes(static_cast<int>(terms))); k < count; ++k) {
    law.reach += std::abs(row_[k]);
    law.rate_reach += static_cast<double>(k) * std::abs(row_[k]);
  }
  law.x.assign(row_.begin(), row_.begin() + static_cast<std::ptrdiff_t>(count));
  return law.x;
}

double LawSeries::size_of_term(int law, std::size_t k) const {
  const Law& l = laws_[idx(law)];
  double size = k < l.known_size.size() ? l.known_size[k] : 0.0;
  if (static_cast<int>(k) <= series_->degree())
    for (const Entry& e : system_.scalars()[idx(law)].z)
      size += std::abs(e.coeff * series_->coefficient(static_cast<int>(k), e.index));
  const std::vector<double>& offset = offsets_->offset(law);
  return k < offset.size() ? size + std::abs(offset[k]) : size;
}

/// What a bound is at least along the step; nothing is known of one that is scaled.
double LawSeries::clearance(const Law& law, const LawBound& b) const {
  if (b.b_v == 0.0) return b.a + b.b_x * law.x_0 - std::abs(b.b_x) * law.reach;
  if (law.scaled) return 0.0;
  const double per_time = b.b_v / h_;
  return b.a + b.b_x * law.x_0 + per_time * law.x_1 - std::abs(b.b_x) * law.reach -
         std::abs(per_time) * law.rate_reach;
}

/// Whether a bound stays above `least` along the step, by what is known of the rows or by the deflection's series.
bool LawSeries::keeps_clear(const Law& law, const LawBound& b, double least, double& clear) const {
  if (clear > least) return true;
  if (law.whole) return false;
  series_of(law);
  clear = clearance(law, b);
  return clear > least;
}

void LawSeries::bound_series(const Law& law, const LawBound& b, std::vector<double>& g) const {
  const std::vector<double>& x = series_of(law);
  const std::size_t terms = x.size();
  g.resize(terms);
  for (std::size_t k = 0; k < terms; ++k) g[k] = b.b_x * x[k];
  g[0] += b.a;
  if (b.b_v == 0.0) return;
  if (law.scaled) multiply_polynomial(law.scale, g);
  for (std::size_t k = 0; k + 1 < terms; ++k) g[k] += b.b_v * static_cast<double>(k + 1) / h_ * x[k + 1];
}

void LawSeries::bound_sizes(int number, const LawBound& b, std::vector<double>& size) const {
  const Law& law = laws_[idx(number)];
  const std::size_t terms = series_of(law).size();
  size.resize(terms);
  for (std::size_t k = 0; k < terms; ++k) size[k] = std::abs(b.b_x) * size_of_term(number, k);
  if (b.b_v == 0.0) return;
  if (law.scaled) {
    size[0] += std::abs(b.a);
    std::vector<double> scale(law.scale.size());
    std::transform(law.scale.begin(), law.scale.end(), scale.begin(), [](double r) { return std::abs(r); });
    multiply_polynomial(scale, size);
  }
  for (std::size_t k = 0; k + 1 < terms; ++k)
    size[k] += std::abs(b.b_v) * static_cast<double>(k + 1) / h_ * size_of_term(number, k + 1);
}

LawSeries::Start LawSeries::start_of(int number, const LawBound& b, int index) {
  Law& law = laws_[idx(number)];
  auto& [g, clear] = law.bounds[idx(index)];
  clear = index != law.root ? clearance(law, b) : 0.0;
  if (index != law.root && keeps_clear(law, b, 0.0, clear)) return Start::holds;
  clear = 0.0;
  bound_series(law, b, g);
  if (index != law.root && g[0] > 0.0) return Start::holds;
  bound_sizes(number, b, sizes_);
  const double whole = std::abs(b.a) + sizes_[0];
  if (index != law.root && g[0] < -kZero * whole) return Start::jumped;
  g[0] = 0.0;
  for (std::size_t k = 1; k < g.size(); ++k) {
    if (std::abs(g[k]) > std::max(kZero * sizes_[k], kFloor * whole))
      return g[k] < 0.0 ? Start::falls : Start::holds;
    g[k] = 0.0;
  }
  return Start::holds;
}

const LawPiece* LawSeries::force_piece(int law) const {
  const auto j = idx(law);
  const ScalarTerm& term = system_.scalars()[j];
  if (laws_[j].expanded) return &term.force->pieces()[idx(laws_[j].piece)];
  return linear_pieces(term).empty() ? nullptr : &current(j);
}

std::optional<LawSeries::Change> LawSeries::change_at_once() {
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const LawPiece& p = current(j);
    laws_[j].bounds.resize(p.bounds.size());
    for (std::size_t i = 0; i < p.bounds.size(); ++i)
      if (const Start start = start_of(static_cast<int>(j), p.bounds[i], static_cast<int>(i));
          start != Start::holds)
        return Change{0.0, static_cast<int>(j), static_cast<int>(i), start == Start::jumped};
  }
  return std::nullopt;
}

std::optional<LawSeries::Change> LawSeries::first_change(double end) {
  std::optional<Change> first;
  for (std::size_t j = 0; j < laws_.size(); ++j)
    for (std::size_t i = 0; i < laws_[j].bounds.size(); ++i)
      if (const auto& bound = laws_[j].bounds[i]; bound.clearance > 0.0) {
        continue;
      } else if (const auto s = first_crossing(bound.g, end)) {
        first = Change{*s, static_cast<int>(j), static_cast<int>(i)};
        end = *s;
      }
  return first;
}

LawSeries::Beside LawSeries::first_change_beside(const TaylorSeries& series, double push) {
  if (push == 0.0) return {first_change(1.0)};
  // Where each bound would be crossed at the earliest.
  Beside found;
  double earliest = 1.0, second = 2.0;
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    double& mobility = laws_[j].root_mobility;
    if (mobility == 0.0)
      for (const Entry& e : system_.scalars()[j].z)
        mobility += std::abs(e.coeff) * std::sqrt(series.mobility(e.index));
    for (std::size_t i = 0; i < laws_[j].bounds.size(); ++i) {
      const LawBound& b = current(j).bounds[i];
      auto& bound = laws_[j].bounds[i];
      double scale = 1.0;
      if (b.b_v != 0.0 && laws_[j].scaled) {
        scale = 0.0;
        for (const double r : laws_[j].scale) scale += std::abs(r);
      }
      const double square = 0.5 * push * mobility * std::abs(b.b_v) / h_,
                   cube = push * mobility * scale * std::abs(b.b_x) / 6.0;
      if (bound.clearance > 0.0) {
        if (keeps_clear(laws_[j], b, square + cube, bound.clearance)) continue;
        bound_series(laws_[j], b, bound.g);
        bound.clearance = 0.0;
      }
      lower_ = bound.g;
      if (lower_.size() < 4) lower_.resize(4, 0.0);
      lower_[2] -= square;
      lower_[3] -= cube;
      const auto s = first_crossing(lower_, 1.0);
      if (!s) continue;
      if (!found.change || *s < earliest) {
        if (found.change) second = earliest;
        earliest = *s;
        found.change = Change{*s, static_cast<int>(j), static_cast<int>(i)};
      } else {
        second = std::min(second, *s);
      }
    }
  }
  if (!found.change) return found;
  const std::vector<double>& g = laws_[idx(found.change->law)].bounds[idx(found.change->bound)].g;
  const auto s = first_crossing(g, 1.0);
  found.unsure = !s || *s >= second || *s - earliest > kNearCrossing;
  if (found.unsure) return found;
  const double before = polynomial_slope(g, earliest), at = polynomial_slope(g, *s);
  found.unsure = !(before < 0.0 && at < 0.0 && before > kAlike * at && at > kAlike * before);
  found.change->s = *s;
  return found;
}

double LawSeries::later(const Change& change, const double* y, const double* rate) const {
  const LawBound& b = current(idx(change.law)).bounds[idx(change.bound)];
  const Law& law = laws_[idx(change.law)];
  const std::vector<double>& g = law.bounds[idx(change.bound)].g;
  // What the motion turns the angle of r is left out: forces are continuous at such a bound.
  const double scale = b.b_v != 0.0 && law.scaled ? polynomial_value(law.scale, change.s) : 1.0;
  double beside = polynomial_value(g, change.s);
  for (const Entry& e : system_.scalars()[idx(change.law)].z)
    beside += e.coeff * (scale * b.b_x * y[e.index] + b.b_v / h_ * rate[e.index]);
  return -beside / polynomial_slope(g, change.s);
}

double LawSeries::clear_of_change(const Change& change, double s) const {
  const Law& law = laws_[idx(change.law)];
  const double rate = std::abs(polynomial_slope(series_of(law), s));
  double away = rate > 0.0 ? kClear * size_of_term(change.law, 0) / rate : kMostClear;
  if (const int bound = s > 0.0 ? change.bound : law.root; bound >= 0) {
    // Where forces are projected the step ends beside the bound by what it was cut too short or too long.
    std::vector<double> g;
    bound_series(law, current(idx(change.law)).bounds[idx(bound)], g);
    const double off = std::abs(polynomial_value(g, s)), falls = std::abs(polynomial_slope(g, s));
    if (off > 0.0) away += falls > 0.0 ? kPastOff * off / falls : kMostClear;
  }
  away = std::min(away, kMostClear);
  return s > 0.0 ? std::max(0.0, s - away) : away;
}

double LawSeries::beyond_end(const Change& change) const {
  std::vector<double> g;  // that of a step which keeps clear of the bound was not asked for
  bound_series(laws_[idx(change.law)], current(idx(change.law)).bounds[idx(change.bound)], g);
  return -polynomial_value(g, 1.0) / polynomial_slope(g, 1.0);
}

void LawSeries::pass(const Change& change) {
  Law& law = laws_[idx(change.law)];
  const LawBound crossed = current(idx(change.law)).bounds[idx(change.bound)];
  law.piece = crossed.next;
  law.root = -1;
  if (change.jumped) return;  // no bound stands at zero
  const std::vector<LawBound>& bounds = current(idx(change.law)).bounds;
  for (std::size_t i = 0; i < bounds.size(); ++i)
    if (opposite(crossed, bounds[i])) law.root = static_cast<int>(i);
}

void LawSeries::forget_roots() {
  for (Law& law : laws_) law.root = -1;
}

bool LawSeries::lossless() const {
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const LawPiece& p = current(j);
    if (p.k != p.elastic_k || p.y_0 != p.elastic_0) return false;
    if (!system_.scalars()[j].u.empty() && system_.any_prescribed_moves()) return false;
  }
  return true;
}

double LawSeries::dissipated(double s) const {
  double sum = 0.0;
  std::vector<double> y;
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const LawPiece& p = current(j);
    if (p.c == 0.0 && p.k == p.elastic_k && p.y_0 == p.elastic_0) continue;
    bound_series(laws_[j], {p.y_0 - p.elastic_0, p.k - p.elastic_k, p.c, 0}, y);
    sum += work_of(y, series_of(laws_[j]), s);
  }
  return sum;
}

double LawSeries::input(double s) const {
  double sum = 0.0;
  std::vector<double> y;
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    if (system_.scalars()[j].u.empty() || !system_.any_prescribed_moves()) continue;
    const LawPiece& p = current(j);
    bound_series(laws_[j], {p.y_0, p.k, p.c, 0}, y);
    sum += work_of(y, laws_[j].known, s);
  }
  return sum;
}

}  // namespace drev
