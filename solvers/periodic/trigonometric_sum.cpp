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
                              const double* sines, const LaneRow* re, const LaneRow* im, LaneRow* y) {
  const int quarter = points / 4;
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
    y[p].v = ce + co - (se + so);
    y[2 * quarter - p].v = ce - co + (se - so);
    y[2 * quarter + p].v = ce - co - (se - so);
    if (p > 0) y[points - p].v = ce + co + (se + so);
  }
}

constexpr int kWord = 52;  // points in a word of marks: bits of a double's significand

/// Marks the points that may be next to the largest value of sign y: bit p % kWord of marks[p / kWord] in each lane.
/// highest: of the points. A parabola through three points whose middle is the highest rises above it by an eighth of
/// its second difference at the most. Written with choices between doubles: GCC 12 takes masks of lanes to pieces.
DREV_WIDEST void mark_tops(int points, double sign, const LaneRow* y, const Lanes& slack, Lanes& highest,
                           LaneRow* marks) {
  Lanes most = sign * y[0].v;
  for (int p = 1; p < points; ++p) {
    const Lanes here = sign * y[p].v;
    most = here > most ? here : most;
  }
  highest = most;
  const Lanes least = most - slack, none{};
  Lanes before = sign * y[points - 1].v, here = sign * y[0].v, word{};
  double bit = 1.0;
  for (int p = 0; p < points; ++p) {
    const Lanes after = sign * y[p + 1 < points ? p + 1 : 0].v;
    const Lanes reach = 1.25 * here - 0.125 * (before + after);
    // The least of the three differences that must not be negative; not a number: none.
    const Lanes over_before = here - before, over_after = here - after, over_least = reach - least;
    Lanes over = over_before < over_after ? over_before : over_after;
    over = over < over_least ? over : over_least;
    word += over >= none ? none + bit : none;
    bit *= 2.0;
    if (p % kWord == kWord - 1 || p + 1 == points) {
      marks[p / kWord].v = word;
      word = none;
      bit = 1.0;
    }
    before = here;
    here = after;
  }
}

/// exp(i n angle) of ascending multiples n, by passing through all of them; one: exp(i angle).
DREV_WIDEST void turn(int orders, const int* multiples, const Lanes& one_re, const Lanes& one_im, LaneRow* re,
                      LaneRow* im) {
  Lanes power_re = Lanes{} + 1.0, power_im{};
  int at = 0;
  for (int k = 0; k < orders; ++k) {
    for (; at < multiples[k]; ++at) {
      const Lanes turned = power_re * one_re - power_im * one_im;
      power_im = power_re * one_im + power_im * one_re;
      power_re = turned;
    }
    re[k].v = power_re;
    im[k].v = power_im;
  }
}

/// Value and first three derivatives.
struct Derivatives {
  Lanes y{}, slope{}, bend{}, twist{};
};
DREV_WIDEST void differentiate(int orders, const int* multiples, const LaneRow* re, const LaneRow* im,
                               const LaneRow* power_re, const LaneRow* power_im, Derivatives& d) {
  Lanes y{}, slope{}, bend{}, twist{};
  for (int k = 0; k < orders; ++k) {
    const double n = multiples[k];
    const Lanes a = re[k].v * power_re[k].v - im[k].v * power_im[k].v,
                b = re[k].v * power_im[k].v + im[k].v * power_re[k].v;
    y += a;
    slope -= n * b;
    bend -= n * n * a;
    twist += n * n * n * b;
  }
  d.y = y, d.slope = slope, d.bend = bend, d.twist = twist;
}

}  // namespace

/// Of a top's sum and sign.
int TrigonometricSum::place_of(const Top& top) { return 2 * top.lane + (top.sign > 0.0 ? 0 : 1); }

void TrigonometricSum::refine(const int* places, int count, const Lanes& least) {
  const auto orders = static_cast<int>(multiples_.size());
  Lanes angle{}, start{}, value = Lanes{} - std::numeric_limits<double>::infinity();
  for (int i = 0; i < kLanes; ++i) {
    const Top& top = tops_[idx(places[i < count ? i : 0])];
    angle[i] = start[i] = step_ * top.at;
    for (std::size_t k = 0; k < multiples_.size(); ++k) {
      top_re_[k].v[i] = top.sign * re_[k].v[top.lane];
      top_im_[k].v[i] = top.sign * im_[k].v[top.lane];
    }
  }
  unsigned open = (1U << static_cast<unsigned>(count)) - 1U;
  for (int round = 0; round < kRefinements && open != 0; ++round) {
    Lanes one_re{}, one_im{};
    for (int i = 0; i < count; ++i) {
      one_re[i] = std::cos(angle[i]);
      one_im[i] = std::sin(angle[i]);
      for (std::size_t k = 0; !dense_ && k < multiples_.size(); ++k) {
        power_re_[k].v[i] = std::cos(multiples_[k] * angle[i]);
        power_im_[k].v[i] = std::sin(multiples_[k] * angle[i]);
      }
    }
    if (dense_) turn(orders, multiples_.data(), one_re, one_im, power_re_.data(), power_im_.data());
    Derivatives d;
    differentiate(orders, multiples_.data(), top_re_.data(), top_im_.data(), power_re_.data(),
                  power_im_.data(), d);
    for (int i = 0; i < count; ++i) {
      const unsigned bit = 1U << static_cast<unsigned>(i);
      if ((open & bit) == 0) continue;
      value[i] = std::max(value[i], d.y[i]);
      open &= ~bit;
      if (!(d.bend[i] < 0.0)) continue;
      // Halley's step, where it does not turn Newton's round.
      const double newton = -d.slope[i] / d.bend[i], third = 1.0 + 0.5 * newton * d.twist[i] / d.bend[i];
      const double step = newton / std::max(third, 0.5);
      // Newton's parabola, and what the third derivative may add to it: not worth following where that is too little.
      const double reach = std::abs(newton), bound = thirds_[tops_[idx(places[i])].lane];
      if (d.y[i] + 0.5 * d.slope[i] * newton + bound * reach * reach * reach < least[i] - kRounding * bound)
        continue;
      if (std::abs(angle[i] + step - start[i]) > step_) continue;
      angle[i] += step;
      if (std::abs(step) < kAngleTolerance * step_)
        value[i] = std::max(
            value[i], d.y[i] + step * (d.slope[i] + 0.5 * step * (d.bend[i] + step * d.twist[i] / 3.0)));
      else
        open |= bit;
    }
  }
  for (int i = 0; i < count; ++i) {
    Top& top = tops_[idx(places[i])];
    top.found = value[i];
    top.angle = angle[i];
  }
}

void TrigonometricSum::sample(const Eigen::MatrixXcd& amplitudes, Eigen::Index first, int used) {
  Lanes third{};
  for (std::size_t k = 0; k < multiples_.size(); ++k) {
    Lanes re{}, im{}, size{};
    for (int lane = 0; lane < used; ++lane) {
      const Complex a = amplitudes(static_cast<Eigen::Index>(k), first + lane);
      re[lane] = a.real();
      im[lane] = a.imag();
      size[lane] = std::sqrt(std::norm(a));
    }
    re_[k].v = re;
    im_[k].v = im;
    third += cubes_[k] * size;
  }
  // Between three points the sum is above the parabola through them by at most this.
  thirds_ = third;
  slack_ = third * (step_ * step_ * step_ / (9.0 * std::sqrt(3.0)));
  sum_quarters(points_, static_cast<int>(multiples_.size()), even_, by_parity_.data(), cosines_.data(),
               sines_.data(), re_.data(), im_.data(), samples_.data());
}

void TrigonometricSum::find_tops(int used, double sign) {
  std::array<LaneRow, 4 * kMostMultiples / kWord + 1> marks;
  Lanes highest{};
  mark_tops(points_, sign, samples_.data(), slack_, highest, marks.data());
  for (int lane = 0; lane < kLanes; ++lane) best_[idx(2 * lane + (sign > 0.0 ? 0 : 1))] = highest[lane];
  for (int lane = 0; lane < used; ++lane) {
    if (!(slack_[lane] > 0.0)) continue;
    for (int first = 0; first < points_; first += kWord)
      for (auto word = static_cast<std::uint64_t>(marks[idx(first / kWord)].v[lane]); word != 0;
           word &= word - 1) {
        const int p = first + std::countr_zero(word);
        const double before = samples_[idx(p > 0 ? p - 1 : points_ - 1)].v[lane],
                     here = samples_[idx(p)].v[lane],
                     after = samples_[idx(p + 1 < points_ ? p + 1 : 0)].v[lane];
        const double bend = sign * (2.0 * here - before - after), tilt = 0.5 * sign * (after - before);
        const double shift = bend > 0.0 ? tilt / bend : 0.0;
        Top top{lane, sign, p + shift, sign * here + 0.5 * tilt * shift};
        if (top.value + slack_[lane] >= highest[lane]) tops_.push_back(top);
      }
  }
}

void TrigonometricSum::extremes(const Eigen::MatrixXcd& amplitudes, std::vector<SumExtremes>& out) {
  out.assign(static_cast<std::size_t>(amplitudes.cols()), {});
  if (multiples_.empty()) return;
  for (Eigen::Index first = 0; first < amplitudes.cols(); first += kLanes) {
    const int used = static_cast<int>(std::min<Eigen::Index>(kLanes, amplitudes.cols() - first));
    sample(amplitudes, first, used);
    tops_.clear();
    for (const double sign : {1.0, -1.0}) find_tops(used, sign);
    // The highest of each sum and sign first; what the others can reach may then be known to be too little.
    std::sort(tops_.begin(), tops_.end(), [](const Top& a, const Top& b) { return a.value > b.value; });
    unsigned led = 0;
    for (Top& top : tops_) {
      top.leads = (led & (1U << place_of(top))) == 0;
      led |= 1U << place_of(top);
    }
    std::stable_partition(tops_.begin(), tops_.end(), [](const Top& top) { return top.leads; });
    for (std::size_t next = 0; next < tops_.size();) {
      std::array<int, kLanes> places{};
      Lanes least{};
      int count = 0;
      for (; next < tops_.size() && count < kLanes; ++next) {
        const double best = best_[idx(place_of(tops_[next]))];
        if (tops_[next].value + slack_[tops_[next].lane] < best) continue;
        least[count] = best;
        places[idx(count++)] = static_cast<int>(next);
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
