// LoadSeries: the knots of tables that angles pass inside a step.
#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/contact/roots.hpp"
#include "solvers/exact/load_series.hpp"
#include "solvers/series/series_kernels.hpp"

namespace drev {

namespace {

// Error of the motion inside a step by the rest of a kink in it, relative to jump h |theta'| h^2/(2 m), at most.
constexpr double kKinkInside = 1e-4;
constexpr int kMostListed = 1 << 30;  // kinks counted over all listings before their count starts again

/// The way of a load over knots between which it is straight: behind one it differs by jump (theta - knot).
struct StraightWay {
  double bound, angle_slope, jump = 0.0;
  void take(double slope) { jump = slope - std::exchange(angle_slope, slope); }
  double force() const { return jump; }
  double bends() const { return 0.0; }
  double chord() const { return std::abs(jump); }
  double slope() const { return std::abs(jump); }
};
struct TableWay : StraightWay {
  const TableStretches& table;
  TableStretches::Place place;
  bool pass(bool rises, double) {
    table.step(place, rises);
    bound = rises ? table.high(place) : table.low(place);
    take(table.slope(place));
    return true;
  }
};
/// The same of a load that is asked for each stretch.
struct StretchWay : StraightWay {
  const StraightLoads& loads;
  StraightLoads::Load& load;
  double t;
  bool pass(bool rises, double) {
    const LoadStretch& ahead = loads.look_beyond(load, t, bound, rises);
    bound = rises ? ahead.high : ahead.low;
    take(ahead.angle_slope);
    return ahead.time_slope == load.stretch.time_slope;
  }
};

/// The way of a load over knots between which it is a cubic. Bounds of what it differs behind a knot, over a turn: |f| <= chord turn,
/// |f'| <= slope.
struct CubicWay {
  double bound;
  ExpandedLoads& loads;
  ExpandedLoads::Load& load;
  CubicPiece piece;
  double about, most_chord = 0.0, most_slope = 0.0;
  std::span<const double> behind = {};
  bool pass(bool rises, double turn) {
    const CubicPiece next = load.knots->piece(bound, rises ? 1.0 : -1.0, load.piece_speed);
    const auto differs = loads.behind_knot(load, piece, about, bound, next, turn);
    piece = next;
    about = bound;
    bound = rises ? next.high : next.low;
    if (!differs) return false;
    behind = *differs;
    most_chord = most_slope = 0.0;
    double power = 1.0;
    for (std::size_t q = 0; q < behind.size(); ++q, power *= turn) {
      most_chord += std::abs(behind[q]) * power;
      most_slope += static_cast<double>(q + 1) * std::abs(behind[q]) * power;
    }
    return true;
  }
  std::span<const double> force() const { return behind; }
  /// How far the slope behind the knot comes from that at the knot.
  double bends() const { return most_slope - std::abs(behind[0]); }
  double chord() const { return most_chord; }
  double slope() const { return most_slope; }
};

}  // namespace

void LoadSeries::expand_kinks(const TaylorSeries& series, std::size_t most) {
  const std::size_t of_motion = idx(series.degree()) + 1,
                    terms = std::min(most, std::max<std::size_t>(of_motion, 3));
  kinks_.expand(series.coefficients(0), stride_, std::min(terms, of_motion), terms, phi_);
}

double LoadSeries::find_kinks(TaylorSeries& series) {
  of_kinks_.clear();
  if (straight_.empty() && !expanded_.knotted()) return 0.0;
  find_ranges(series);
  list_kinks(series, 1.0, true);
  expand_kinks(series, TaylorSeries::kMaxDegree + 1);
  kinks_.add_to(of_kinks_);
  double contraction = 0.0;
  for_knotted(
      [&](const PlacedLoad& l, double, double) { contraction = std::max(contraction, l.contraction); });
  return contraction;
}

void LoadSeries::find_ranges(TaylorSeries& series) {
  ranges_.resize(idx(3 * stride_));
  series.ranges(ranges_.data(), ranges_.data() + stride_);
}

bool LoadSeries::list_sweep_kinks(TaylorSeries& series, double end, const double* z_end) {
  if (end == 1.0)
    find_ranges(series);
  else
    for (int i = 0; i < system_.size(); ++i) ranges_[idx(i)] = z_end[i] - series.coefficient(0, i);
  if (!list_kinks(series, end, false)) return false;
  if (kinks_.all_turn()) return true;
  // The work of a load whose angle follows no motion is known where its row is not moved by another kink before.
  for (int i = 0; i < kinks_.count(); ++i)
    for (int k = 0; k < kinks_.count(); ++k)
      if (i != k && kinks_.row(i) == kinks_.row(k) && !kink_sizes_.load_of(i).feedback) return false;
  return true;
}

/// Lists the kinks that a load passes on its way to the angle `end` at a first rate by s. way: the bound of its piece ahead; pass()
/// goes on behind it, over a turn of the angle, and tells what the load differs there; false: a kink of none of this kind. False: it
/// leaves a piece at one.
template <class Way>
bool LoadSeries::list_kinks_of(PlacedLoad& l, Way& way, double rate, double end, const TaylorSeries& series,
                               bool projected) {
  const bool rises = rate > 0.0;
  double steepest = 0.0;
  while (rises ? end > way.bound : end < way.bound) {
    const double knot = way.bound;
    if (!way.pass(rises, std::abs(end - knot)) || !(rises ? way.bound > knot : way.bound < knot)) {
      l.watched = true;
      break;
    }
    if (projected) {
      const double inside =
          kKinkInside * std::abs(l.coeff * way.chord() * rate) * relative_move(series, l.row);
      l.watched = inside > kMostInside && !of_part_;
      if (l.watched) break;
      kinks_inside_ = std::max(kinks_inside_, inside);
    }
    kinks_.add(l, knot, way.force(), end);
    kink_sizes_.add(l, rate, way.chord(), way.slope());
    if (l.feedback)
      slope_behind_ = std::max(slope_behind_, l.coeff * l.coeff * series.reach(l.row) * way.bends());
    shared_rows_ |= std::exchange(last_kink_[idx(l.row)], listed_before_ + kinks_.count()) > listed_before_;
    steepest += way.slope();
  }
  if (l.feedback && projected)
    l.contraction = 0.5 * h_ * h_ * l.coeff * l.coeff * steepest * series.mobility(l.row);
  return !l.watched;
}

/// Lists the kinks that loads pass up to s = to in kinks_; ranges_ holds how far the unknowns come. projected: a kink
/// that leaves too much inside the step ends it. False: some angle may turn back in the step, or leave it at such a kink. In a
/// part of a step that holds none does, whatever the bounds say of its series: with projected kinks they are loose.
bool LoadSeries::list_kinks(const TaylorSeries& series, double to, bool projected) {
  listed_before_ += kinks_.count();
  if (listed_before_ > kMostListed) {
    std::fill(last_kink_.begin(), last_kink_.end(), 0);
    listed_before_ = 0;
  }
  kinks_.clear();
  kink_sizes_.clear();
  kinks_inside_ = slope_behind_ = 0.0;
  shared_rows_ = false;
  bool all = true;
  const double *turns = ranges_.data(), *sizes = turns + stride_, *bends = sizes + stride_;
  for (const StraightLoads::Near& near : straight_.near_knots(series, to, phi_, turns)) {
    StraightLoads::Load& l = straight_.load_of(near);
    if (!near.monotone && !of_part_) {
      l.watched = true;
      all = false;
      continue;
    }
    const double bound = near.rate > 0.0 ? l.stretch.high : l.stretch.low;
    if (l.table >= 0) {
      TableWay way{{bound, l.stretch.angle_slope}, straight_.table_of(l), l.place};
      all &= list_kinks_of(l, way, near.rate, near.end, series, projected);
      l.ahead_place = way.place;
    } else {
      l.ahead = l.stretch;
      StretchWay way{{bound, l.stretch.angle_slope}, straight_, l, t_};
      all &= list_kinks_of(l, way, near.rate, near.end, series, projected);
    }
  }
  if (projected || !all) straight_.mark_near();
  if (expanded_.knotted()) {
    for (ExpandedLoads::Load& l : expanded_.loads()) {
      if (!l.acts || l.knots == nullptr) continue;
      l.watched = false;
      l.contraction = 0.0;
      const auto row = idx(l.row);
      const double feedback = l.feedback ? std::abs(l.coeff) : 0.0, ratio = std::abs(l.ratio);
      // |theta(s) - theta(0)| <= sum |theta_k|: far from any knot, whatever the path.
      const double reach = ratio * (std::abs(phi_[1]) + std::abs(phi_[2])) + feedback * sizes[row];
      if (l.angle + reach < l.piece.high && l.angle - reach > l.piece.low) continue;
      const double rate = angle_term(l, series, 1);
      l.watched = !of_part_ && 2.0 * ratio * std::abs(phi_[2]) + feedback * bends[row] >
                                   KinkSizes::kMonotone * std::abs(rate);
      if (l.watched) {
        all = false;
        continue;
      }
      const double end =
          l.angle + l.ratio * to * (phi_[1] + to * phi_[2]) + (l.feedback ? l.coeff * turns[row] : 0.0);
      CubicWay way{rate > 0.0 ? l.piece.high : l.piece.low, expanded_, l, l.piece, l.about};
      all &= list_kinks_of(l, way, rate, end, series, projected);
    }
  }
  kink_sizes_.find(h_);
  return all;
}

/// Work of a kink whose angle follows no motion: by Gauss's nodes along the series, and by parts on what kinks add.
double LoadSeries::given_kink_work(const TaylorSeries& series, int kink, double end) const {
  const PlacedLoad& l = kink_sizes_.load_of(kink);
  const GaussRule& rule = gauss_rule();
  const double place = kinks_.place(kink), length = end - place, turn = l.angle - kinks_.knot(kink);
  double sum = 0.0;
  for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
    const double s = place + length * rule.s[q];
    double rate = 0.0;
    for (int k = series.degree(); k > 0; --k) rate = rate * s + k * series.coefficient(k, l.row);
    sum += rule.weight[q] * length * kinks_.force(kink, turn + l.ratio * s * (phi_[1] + s * phi_[2])).value *
           rate;
  }
  // int f y' ds = sum_k (-1)^k f^(k)(e) int (e - s)^k/k! y' ds, by parts: y moves before the knot only where other rows' kinks do.
  std::array<double, TaylorSeries::kSweptParts> terms;
  kinks_.force_terms(
      kink,
      {kinks_.end(kink) - kinks_.knot(kink), l.ratio * (phi_[1] + 2.0 * end * phi_[2]), l.ratio * phi_[2]},
      terms);
  double factor = 1.0;  // (-1)^k k!
  for (int k = 0; k < TaylorSeries::kSweptParts; factor *= -static_cast<double>(++k))
    sum += factor * terms[idx(k)] * series.swept(k)[l.row];
  return sum;
}

double LoadSeries::kink_work(const TaylorSeries& series, double s) const {
  const double *y = series.swept(0), *y_sum = series.swept(1), *y_sum_2 = series.swept(2);
  double sum = expanded_.swept_work(series, s);
  sum += work_by_parts(stride_, p_.data(), s, y, y_sum, y_sum_2);  // of what acts along the series
  sum += kinks_.work(phi_[1] + 2.0 * s * phi_[2], 2.0 * phi_[2], y, y_sum, y_sum_2);
  for (int i = 0; !kinks_.all_turn() && i < kinks_.count(); ++i)
    if (!kink_sizes_.load_of(i).feedback) sum += given_kink_work(series, i, s);
  return sum;
}

void LoadSeries::append_knots(double end, std::vector<double>& s) const {
  for (int i = 0; i < kinks_.count(); ++i)
    if (const double place = kinks_.place(i); place < end) s.push_back(place);
  for (const double place : smooth_.knot_places())
    if (place < end) s.push_back(place);
  for (const LoadTerm* term : on_prescribed_) {
    const NodeMap& map = system_.node_map(term->node);
    std::array<double, 3> theta = phi_;
    for (std::size_t k = 0; k < 3; ++k) {
      theta[k] *= system_.ratio(term->node);
      if (term->load->depends_on_motion()) theta[k] += map.coeff * u_[idx(map.prescribed)][k];
    }
    const double side = theta[1] < 0.0 ? -1.0 : 1.0;
    for (double angle = theta[0];;) {
      const LoadStretch stretch = term->load->stretch(t_, angle, side).value_or(LoadStretch{});
      const double bound = side > 0.0 ? stretch.high : stretch.low;
      const std::array<double, 3> g{side * (bound - theta[0]), -side * theta[1], -side * theta[2]};
      if (!std::isfinite(bound) || !(side * (bound - angle) > 0.0)) break;
      const std::optional<double> place = first_crossing(g, end);
      if (!place) break;
      s.push_back(*place);
      angle = bound;
    }
  }
}

}  // namespace drev
