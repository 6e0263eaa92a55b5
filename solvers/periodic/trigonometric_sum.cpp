#include "solvers/periodic/trigonometric_sum.hpp"

#include <drev/core/error.hpp>
#include <drev/core/ids.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kSameOrder = 1e-9;  // of the highest order: rounding of orders written down
constexpr int kPointsAPeriod = 4;    // of the highest order
constexpr int kFewestPoints = 16;
constexpr int kRefinements = 20;
constexpr double kRounding = 1e-13;       // of the sum of the amplitudes, at the least
constexpr double kAngleTolerance = 4e-4;  // of the distance of points

/// The largest order that all are whole multiples of, by Euclid's algorithm; 0: below `least`.
double common_order(const std::vector<double>& orders, double least, double same) {
  double common = 0.0;
  for (double order : orders) {
    while (order > same) {
      const double rest = std::fmod(common, order);
      common = order;
      order = order - rest < same ? 0.0 : rest;
    }
    if (common < least) return 0.0;
  }
  return common;
}

}  // namespace

TrigonometricSum::TrigonometricSum(const std::vector<double>& orders, const std::string& place) {
  if (orders.empty()) return;
  const double highest = *std::max_element(orders.begin(), orders.end());
  const double least = highest / kMostMultiples;
  base_ = common_order(orders, least * (1.0 - kSameOrder), kSameOrder * highest);
  if (!(base_ > 0.0))
    throw ModelError(
        {{place, "orders", to_text(orders.front()) + " ... " + to_text(orders.back()), "",
          "must be whole multiples of one order, which is at least the highest over " +
              std::to_string(kMostMultiples) + ": they have no common cycle to be summed over"}});
  for (const double order : orders) multiples_.push_back(static_cast<int>(std::lround(order / base_)));
  base_ = highest / std::round(highest / base_);
  for (const int n : multiples_) cubes_.push_back(std::pow(n, 3));
  highest_ = *std::max_element(multiples_.begin(), multiples_.end());
  const int points = std::max(kFewestPoints, kPointsAPeriod * highest_);
  step_ = kTwoPi / points;
  for (const int parity : {0, 1}) {
    for (std::size_t k = 0; k < multiples_.size(); ++k)
      if (multiples_[k] % 2 == parity) by_parity_.push_back(static_cast<int>(k));
    if (parity == 0) even_ = static_cast<int>(by_parity_.size());
  }
  points_ = points;
  for (int p = 0; p <= points / 4; ++p)
    for (const int row : by_parity_) {
      const double angle = step_ * static_cast<double>(static_cast<long>(multiples_[idx(row)]) * p % points);
      cosines_.push_back(std::cos(angle));
      sines_.push_back(std::sin(angle));
    }
  for (int p = 0; p < points; ++p) {
    turned_re_.push_back(std::cos(step_ * p));
    turned_im_.push_back(std::sin(step_ * p));
  }
  dense_ = highest_ <= 4 * static_cast<int>(multiples_.size()) &&
           std::is_sorted(multiples_.begin(), multiples_.end());
  for (LaneArray* rows : {&re_, &im_, &top_re_, &top_im_, &power_re_, &power_im_})
    rows->resize(orders.size());
  samples_.resize(idx(points));
}

double TrigonometricSum::cycle() const { return base_ > 0.0 ? kTwoPi / base_ : 0.0; }

namespace {

/// y at all points, of the sums over a quarter of the cycle:
///   cos n (pi - x) = (-1)^n cos n x, sin n (pi - x) = -(-1)^n sin n x, and both times (-1)^n at x + pi.
DREV_WIDEST void sum_quarters(int points, int orders, int even, const int* row, const double* cosines,
                              const double* sines, const LaneRow* re, const LaneRow* im, LaneRow* y,
                              Lanes& highest, Lanes& lowest) {
  const int quarter = points / 4;
  Lanes most = Lanes{} - std::numeric_limits<double>::infinity(), least = -most;
  for (int p = 0; p <= quarter; ++p, cosines += orders, sines += orders) {
    Lanes ce{}, se{}, co{}, so{};
    for (int k = 0; k < even; ++k) {
      ce += cosines[k] * re[row[k]].v;
      se += sines[k] * im[row[k]].v;
    }
    for (int k = even; k < orders; ++k) {
      co += cosines[k] * re[row[k]].v;
      so += sines[k] * im[row[k]].v;
    }
    const Lanes first = ce + co - (se + so), second = ce - co + (se - so), third = ce - co - (se - so),
                last = ce + co + (se + so);
    y[p].v = first;
    y[2 * quarter - p].v = second;
    y[2 * quarter + p].v = third;
    y[p > 0 ? points - p : 0].v = last;
    const Lanes up = first > second ? first : second, up_2 = third > last ? third : last;
    const Lanes down = first < second ? first : second, down_2 = third < last ? third : last;
    most = up > most ? up : most;
    most = up_2 > most ? up_2 : most;
    least = down < least ? down : least;
    least = down_2 < least ? down_2 : least;
  }
  highest = most;
  lowest = least;
}

constexpr int kWord = 52;  // points in a word of marks: bits of a double's significand

/// Marks the points that may be next to the largest value, and those that may be next to the smallest: bit p % kWord of
/// tops[p / kWord] and of bottoms[p / kWord] in each lane. highest, lowest: of the points. A parabola through three points
/// whose middle is the highest rises above it by an eighth of its second difference at the most. Written with choices
/// between doubles: GCC 12 takes masks of lanes to pieces.
DREV_WIDEST void mark_extremes(int points, const LaneRow* y, const Lanes& slack, const Lanes& highest,
                               const Lanes& lowest, LaneRow* tops, LaneRow* bottoms) {
  const Lanes least = highest - slack, most = lowest + slack, none{};
  Lanes before = y[points - 1].v, here = y[0].v, top{}, bottom{};
  double bit = 1.0;
  for (int p = 0; p < points; ++p) {
    const Lanes after = y[p + 1 < points ? p + 1 : 0].v;
    const Lanes reach = 1.25 * here - 0.125 * (before + after);
    // The least of the three differences that must not be negative; not a number: none.
    const Lanes rise = here - before, fall = here - after, over_least = reach - least, under = most - reach;
    Lanes over = rise < fall ? rise : fall, below = rise > fall ? -rise : -fall;
    over = over < over_least ? over : over_least;
    below = below < under ? below : under;
    top += over >= none ? none + bit : none;
    bottom += below >= none ? none + bit : none;
    bit *= 2.0;
    if (p % kWord == kWord - 1 || p + 1 == points) {
      tops[p / kWord].v = top;
      bottoms[p / kWord].v = bottom;
      top = bottom = none;
      bit = 1.0;
    }
    before = here;
    here = after;
  }
}

/// Value and first three derivatives.
struct Derivatives {
  Lanes y{}, slope{}, bend{}, twist{};
};
/// At an angle, of ascending multiples n; dense: exp(i n angle) by passing through all of them from `one`, exp(i angle),
/// on; else the powers are given.
template <bool dense>
[[gnu::always_inline]] inline void differentiate(int orders, const int* multiples, const LaneRow* re,
                                                 const LaneRow* im, const Lanes& one_re, const Lanes& one_im,
                                                 const LaneRow* given_re, const LaneRow* given_im,
                                                 Derivatives& d) {
  Lanes y{}, slope{}, bend{}, twist{}, power_re = Lanes{} + 1.0, power_im{};
  int at = 0;
  for (int k = 0; k < orders; ++k) {
    for (; dense && at < multiples[k]; ++at) {
      const Lanes turned = power_re * one_re - power_im * one_im;
      power_im = power_re * one_im + power_im * one_re;
      power_re = turned;
    }
    if (!dense) power_re = given_re[k].v, power_im = given_im[k].v;
    const double n = multiples[k];
    const Lanes a = re[k].v * power_re - im[k].v * power_im,
                b = n * (re[k].v * power_im + im[k].v * power_re);
    y += a;
    slope -= b;
    bend -= n * n * a;
    twist += n * n * b;
  }
  d.y = y, d.slope = slope, d.bend = bend, d.twist = twist;
}
DREV_WIDEST void differentiate_dense(int orders, const int* multiples, const LaneRow* re, const LaneRow* im,
                                     const Lanes& one_re, const Lanes& one_im, Derivatives& d) {
  differentiate<true>(orders, multiples, re, im, one_re, one_im, nullptr, nullptr, d);
}
DREV_WIDEST void differentiate_given(int orders, const int* multiples, const LaneRow* re, const LaneRow* im,
                                     const LaneRow* power_re, const LaneRow* power_im, Derivatives& d) {
  const Lanes one{};
  differentiate<false>(orders, multiples, re, im, one, one, power_re, power_im, d);
}

/// exp(i (point + away)) of points whose exp(i point) is known, |away| < 0.6 rad: series to rounding.
DREV_WIDEST void turn_away(const Lanes& point_re, const Lanes& point_im, const Lanes& away, Lanes& re,
                           Lanes& im) {
  const Lanes d = away * away;
  const Lanes c =
      1.0 -
      d / 2.0 * (1.0 - d / 12.0 * (1.0 - d / 30.0 * (1.0 - d / 56.0 * (1.0 - d / 90.0 * (1.0 - d / 132.0)))));
  const Lanes s =
      away *
      (1.0 -
       d / 6.0 *
           (1.0 - d / 20.0 * (1.0 - d / 42.0 * (1.0 - d / 72.0 * (1.0 - d / 110.0 * (1.0 - d / 156.0))))));
  re = point_re * c - point_im * s;
  im = point_re * s + point_im * c;
}

/// The rows of some lanes, times their signs.
DREV_WIDEST void pick_lanes(int orders, const LaneMask& lane, const Lanes& sign, const LaneRow* re,
                            const LaneRow* im, LaneRow* to_re, LaneRow* to_im) {
  for (int k = 0; k < orders; ++k) {
    to_re[k].v = sign * __builtin_shuffle(re[k].v, lane);
    to_im[k].v = sign * __builtin_shuffle(im[k].v, lane);
  }
}

/// sum weight |a|, at the least: |a| <= larger + half of the smaller part.
DREV_WIDEST void bound_sizes(int orders, const double* weights, const LaneRow* re, const LaneRow* im,
                             Lanes& sum) {
  Lanes all{};
  for (int k = 0; k < orders; ++k) {
    Lanes a = re[k].v, b = im[k].v;
    magnitude(a), magnitude(b);
    all += weights[k] * (a > b ? a + 0.5 * b : b + 0.5 * a);
  }
  sum = all;
}

/// Of Halley's step, where it does not turn Newton's round: the step, and the sum behind it.
DREV_WIDEST void halley(const Derivatives& d, Lanes& step, Lanes& behind, Lanes& newton) {
  const Lanes half = Lanes{} + 0.5;
  newton = -d.slope / d.bend;
  const Lanes third = 1.0 + 0.5 * newton * d.twist / d.bend;
  step = newton / (third > half ? third : half);
  behind = d.y + step * (d.slope + 0.5 * step * (d.bend + step * d.twist / 3.0));
}

}  // namespace

/// Of a top's sum and sign.
int TrigonometricSum::place_of(const Top& top) { return 2 * top.lane + (top.sign > 0.0 ? 0 : 1); }

void TrigonometricSum::refine(const int* places, int count, const Lanes& least) {
  const auto orders = static_cast<int>(multiples_.size());
  Lanes away{}, start{}, sign{}, point{}, point_re{}, point_im{}, bound{};
  Lanes value = Lanes{} - std::numeric_limits<double>::infinity();
  LaneMask lane{};
  for (int i = 0; i < kLanes; ++i) {
    const Top& top = tops_[idx(places[i < count ? i : 0])];
    const int nearest = static_cast<int>(std::lround(top.at));
    const int p = nearest < 0 ? nearest + points_ : nearest >= points_ ? nearest - points_ : nearest;
    point[i] = step_ * nearest;
    point_re[i] = turned_re_[idx(p)];
    point_im[i] = turned_im_[idx(p)];
    away[i] = start[i] = step_ * (top.at - nearest);
    sign[i] = top.sign;
    lane[i] = top.lane;
    bound[i] = thirds_[top.lane];
  }
  pick_lanes(orders, lane, sign, re_.data(), im_.data(), top_re_.data(), top_im_.data());
  unsigned open = (1U << static_cast<unsigned>(count)) - 1U;
  for (int round = 0; round < kRefinements && open != 0; ++round) {
    Derivatives d;
    if (dense_) {
      Lanes one_re{}, one_im{};
      turn_away(point_re, point_im, away, one_re, one_im);
      differentiate_dense(orders, multiples_.data(), top_re_.data(), top_im_.data(), one_re, one_im, d);
    } else {
      for (std::size_t k = 0; k < multiples_.size(); ++k)
        for (int i = 0; i < kLanes; ++i) {
          power_re_[k].v[i] = std::cos(multiples_[k] * (point[i] + away[i]));
          power_im_[k].v[i] = std::sin(multiples_[k] * (point[i] + away[i]));
        }
      differentiate_given(orders, multiples_.data(), top_re_.data(), top_im_.data(), power_re_.data(),
                          power_im_.data(), d);
    }
    Lanes step{}, behind{}, newton{};
    halley(d, step, behind, newton);
    for (int i = 0; i < count; ++i) {
      const unsigned bit = 1U << static_cast<unsigned>(i);
      if ((open & bit) == 0) continue;
      value[i] = std::max(value[i], d.y[i]);
      open &= ~bit;
      if (!(d.bend[i] < 0.0)) continue;
      // Newton's parabola, and what the third derivative may add to it: not worth following where that is too little.
      const double reach = std::abs(newton[i]);
      if (d.y[i] + 0.5 * d.slope[i] * newton[i] + bound[i] * reach * reach * reach <
          least[i] - kRounding * bound[i])
        continue;
      if (std::abs(away[i] + step[i] - start[i]) > step_) continue;
      away[i] += step[i];
      if (std::abs(step[i]) < kAngleTolerance * step_)
        value[i] = std::max(value[i], behind[i]);
      else
        open |= bit;
    }
  }
  for (int i = 0; i < count; ++i) {
    Top& top = tops_[idx(places[i])];
    top.found = value[i];
    top.angle = point[i] + away[i];
  }
}

void TrigonometricSum::sample(const Eigen::MatrixXcd& amplitudes, Eigen::Index first, int used) {
  for (std::size_t k = 0; used < kLanes && k < multiples_.size(); ++k) re_[k].v = im_[k].v = Lanes{};
  for (int lane = 0; lane < used; ++lane) {
    const auto column = amplitudes.col(first + lane);
    for (std::size_t k = 0; k < multiples_.size(); ++k) {
      re_[k].v[lane] = column[static_cast<Eigen::Index>(k)].real();
      im_[k].v[lane] = column[static_cast<Eigen::Index>(k)].imag();
    }
  }
  bound_sizes(static_cast<int>(multiples_.size()), cubes_.data(), re_.data(), im_.data(), thirds_);
  // Between three points the sum is above the parabola through them by at most this.
  slack_ = thirds_ * (step_ * step_ * step_ / (9.0 * std::sqrt(3.0)));
  sum_quarters(points_, static_cast<int>(multiples_.size()), even_, by_parity_.data(), cosines_.data(),
               sines_.data(), re_.data(), im_.data(), samples_.data(), highest_sample_, lowest_sample_);
}

void TrigonometricSum::find_tops(int used) {
  constexpr std::size_t kWords = 4 * kMostMultiples / kWord + 1;
  std::array<LaneRow, kWords> tops, bottoms;
  mark_extremes(points_, samples_.data(), slack_, highest_sample_, lowest_sample_, tops.data(),
                bottoms.data());
  for (int lane = 0; lane < kLanes; ++lane) {
    best_[idx(2 * lane)] = highest_sample_[lane];
    best_[idx(2 * lane + 1)] = -lowest_sample_[lane];
  }
  for (const double sign : {1.0, -1.0}) take_marked(used, sign, sign > 0.0 ? tops.data() : bottoms.data());
}

void TrigonometricSum::take_marked(int used, double sign, const LaneRow* marks) {
  for (int lane = 0; lane < used; ++lane) {
    if (!(slack_[lane] > 0.0)) continue;
    for (int first = 0; first < points_; first += kWord)
      for (auto word = static_cast<std::uint64_t>(marks[first / kWord].v[lane]); word != 0;
           word &= word - 1) {
        const int p = first + std::countr_zero(word);
        const double before = samples_[idx(p > 0 ? p - 1 : points_ - 1)].v[lane],
                     here = samples_[idx(p)].v[lane],
                     after = samples_[idx(p + 1 < points_ ? p + 1 : 0)].v[lane];
        const double bend = sign * (2.0 * here - before - after), tilt = 0.5 * sign * (after - before);
        const double shift = bend > 0.0 ? tilt / bend : 0.0;
        Top top{lane, sign, p + shift, sign * here + 0.5 * tilt * shift};
        if (top.value + slack_[lane] >= best_[idx(place_of(top))]) tops_.push_back(top);
      }
  }
}

void TrigonometricSum::put_leaders_first() {
  std::array<int, 2 * kLanes> leaders;
  leaders.fill(-1);
  for (std::size_t i = 0; i < tops_.size(); ++i) {
    int& leader = leaders[idx(place_of(tops_[i]))];
    if (leader < 0 || tops_[i].value > tops_[idx(leader)].value) leader = static_cast<int>(i);
  }
  order_.clear();
  for (const int leader : leaders) {
    if (leader < 0) continue;
    tops_[idx(leader)].leads = true;
    order_.push_back(leader);
  }
  for (std::size_t i = 0; i < tops_.size(); ++i)
    if (!tops_[i].leads) order_.push_back(static_cast<int>(i));
}

void TrigonometricSum::extremes(const Eigen::MatrixXcd& amplitudes, std::vector<SumExtremes>& out) {
  out.assign(static_cast<std::size_t>(amplitudes.cols()), {});
  if (multiples_.empty()) return;
  for (Eigen::Index first = 0; first < amplitudes.cols(); first += kLanes) {
    const int used = static_cast<int>(std::min<Eigen::Index>(kLanes, amplitudes.cols() - first));
    sample(amplitudes, first, used);
    tops_.clear();
    find_tops(used);
    // What the others can reach may then be known to be too little.
    put_leaders_first();
    for (std::size_t next = 0; next < order_.size();) {
      std::array<int, kLanes> places{};
      Lanes least{};
      int count = 0;
      for (; next < order_.size() && count < kLanes; ++next) {
        const Top& top = tops_[idx(order_[next])];
        const double best = best_[idx(place_of(top))];
        if (top.value + slack_[top.lane] < best) continue;
        least[count] = best;
        places[idx(count++)] = order_[next];
      }
      if (count == 0) break;
      refine(places.data(), count, least);
      for (int i = 0; i < count; ++i) {
        const Top& top = tops_[idx(places[idx(i)])];
        SumExtremes& e = out[static_cast<std::size_t>(first + top.lane)];
        const double so_far = top.sign > 0.0 ? e.max : -e.min;
        double& best = best_[idx(place_of(top))];
        best = std::max(best, top.found);
        if (!top.leads && !(top.found > so_far)) continue;
        const double angle = (top.angle - kTwoPi * std::floor(top.angle / kTwoPi)) / base_;
        if (top.sign > 0.0)
          e.max = top.found, e.max_angle = angle;
        else
          e.min = -top.found, e.min_angle = angle;
      }
    }
    for (int lane = 0; lane < used; ++lane) {
      SumExtremes& e = out[static_cast<std::size_t>(first + lane)];
      const auto column = amplitudes.col(first + lane);
      if (!column.allFinite()) {
        e = {};
        e.max = std::numeric_limits<double>::infinity();
        e.min = -e.max;
      } else if (column.isZero(0.0)) {
        e = {};
      }
    }
  }
}

}  // namespace drev
