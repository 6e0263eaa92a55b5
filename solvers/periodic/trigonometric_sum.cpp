#include "solvers/periodic/trigonometric_sum.hpp"

#include <drev/core/error.hpp>
#include <drev/core/ids.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "solvers/periodic/trigonometric_kernels.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kSameOrder = 1e-9;  // rounding of orders as text, relative to the highest order [-]
constexpr int kPointsAPeriod = 6;    // points in a period of the highest order
constexpr int kFewestPoints = 32;
constexpr double kNone =
    std::numeric_limits<double>::quiet_NaN();  // base order of orders without a common cycle
constexpr int kRefinements = 20;
constexpr double kAngleTolerance =
    7.5e-3;  // last step d over distance of points [-]: (n d)^6/720 is rounding

/// The largest order of which all are integer multiples, by Euclid's algorithm; 0: it is below `least`.
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

TrigonometricSum::TrigonometricSum(const std::vector<double>& orders, const std::string& place,
                                   bool needs_cycle) {
  if (orders.empty()) return;
  const double highest = *std::max_element(orders.begin(), orders.end());
  const double least = highest / kMostMultiples;
  base_ = common_order(orders, least * (1.0 - kSameOrder), kSameOrder * highest);
  if (!(base_ > 0.0) && !needs_cycle) {
    base_ = kNone;
    return;
  }
  if (!(base_ > 0.0))
    throw ModelError({{place, "orders", to_text(orders.front()) + " ... " + to_text(orders.back()), "",
                       "must be whole multiples of one order, which is at least the highest over " +
                           std::to_string(kMostMultiples) +
                           ": they have no common cycle to be summed over. 2/3 needs all its digits"}});
  const auto take = [&](int from, int step) {  // the multiples from, from + step, ...
    for (std::size_t k = 0; k < orders.size(); ++k)
      if (const auto n = static_cast<int>(std::lround(orders[k] / base_)); n % step == from)
        multiples_.push_back(n), rows_.push_back(static_cast<Eigen::Index>(k));
    return static_cast<int>(rows_.size());
  };
  fours_ = take(0, 4);
  even_ = take(2, 4);
  ones_ = take(1, 4);
  take(3, 4);
  base_ = highest / std::round(highest / base_);
  for (const int n : multiples_) powers_.push_back({std::pow(n, 2), std::pow(n, 3), std::pow(n, 7)});
  highest_ = *std::max_element(multiples_.begin(), multiples_.end());
  const int points = (std::max(kFewestPoints, kPointsAPeriod * highest_) + 7) / 8 * 8;
  step_ = kTwoPi / points;
  points_ = points;
  for (int p = 0; p < points; ++p) {
    turned_re_.push_back(std::cos(step_ * p));
    turned_im_.push_back(std::sin(step_ * p));
  }
  for (int p = 0; p <= points / 8 + 1; ++p)
    for (const int n : multiples_) {
      cosines_.push_back(turned_re_[idx(n * p % points)]);
      sines_.push_back(turned_im_[idx(n * p % points)]);
    }
  dense_ = highest_ <= 4 * static_cast<int>(multiples_.size());
  // One row more, which stays 0: that of the multiples that are none of the orders.
  for (LaneArray* rows : {&re_, &im_, &top_re_, &top_im_}) rows->resize((orders.size() + 1) * kSumSets);
  places_.resize(orders.size());
  if (dense_) places_of_n_.assign(idx(highest_ + 2), static_cast<int>(orders.size()));
  for (std::size_t k = 0; k < multiples_.size(); ++k) {
    places_[idx(static_cast<int>(rows_[k]))] = static_cast<int>(k);
    if (dense_) places_of_n_[idx(multiples_[k])] = static_cast<int>(k);
  }
  if (!dense_)
    for (LaneArray* rows : {&power_re_, &power_im_}) rows->resize(multiples_.size());
  samples_.resize(idx(points + 2 * kBeside) * kSumSets);
  for (auto& marks : marks_) marks.resize(idx((points + kMarksAWord - 1) / kMarksAWord) * kSumSets);
  // From sums of n^2 |a|, n^3 |a| and n^7 |a|: the bounds of MarkExtremes, and that of the polynomial's error.
  shares_ = {step_ * step_ / 8.0, 2.0 / 3.0 * std::pow(step_, 3), LookBetween::kSeventh * std::pow(step_, 7)};
}

double TrigonometricSum::cycle() const { return base_ == 0.0 ? 0.0 : kTwoPi / base_; }

void TrigonometricSum::step(const LaneRow* re, const LaneRow* im, FollowedTops& tops) {
  for (std::size_t k = 0; !dense_ && k < multiples_.size(); ++k)
    for (int i = 0; i < kLanes; ++i) {
      power_re_[k].v[i] = std::cos(multiples_[k] * (tops.angle.v[i] + tops.away.v[i]));
      power_im_[k].v[i] = std::sin(multiples_[k] * (tops.angle.v[i] + tops.away.v[i]));
    }
  const LaneRow *power_re = dense_ ? nullptr : power_re_.data(),
                *power_im = dense_ ? nullptr : power_im_.data();
  run_widest<FollowTop>(dense_ ? (highest_ + 1) / 2 * 2 : static_cast<int>(multiples_.size()),
                        places_of_n_.data(), multiples_.data(), re, im, power_re, power_im,
                        kAngleTolerance * step_, step_, &tops);
}

BracketedMaximum TrigonometricSum::search(const Top& top, double shift) const {
  const double middle = step_ * top.point, near = 1e-9 * step_;
  const int lane = top.sum % kLanes;
  return bracketed_maximum(middle - step_, middle + step_ * shift, middle + step_, near, [&](double angle) {
    double sum = 0.0;
    Complex wave = 1.0, spacing = 1.0;
    for (std::size_t k = 0; k < multiples_.size(); ++k) {
      // Multiples of even spacing are a rotation each.
      const int before = k > 0 ? multiples_[k - 1] : 0, gap = multiples_[k] - before;
      if (k < 2 || gap != before - multiples_[k - 2]) spacing = std::polar(1.0, gap * angle);
      wave = {wave.real() * spacing.real() - wave.imag() * spacing.imag(),
              wave.real() * spacing.imag() + wave.imag() * spacing.real()};
      const auto row = k * kSumSets + idx(top.sum / kLanes);
      sum += re_[row].v[lane] * wave.real() - im_[row].v[lane] * wave.imag();
    }
    return sign_of(top) * sum;
  });
}

void TrigonometricSum::follow(const int* places, const LaneRow* re, const LaneRow* im) {
  FollowedTops tops;
  double *state = numbers(&tops.state), *value = numbers(&tops.value), *away = numbers(&tops.away),
         *start = numbers(&tops.start), *angle = numbers(&tops.angle);
  for (int i = 0; i < kLanes; ++i) {
    if (places[i] < 0) continue;
    const Top& top = tops_[idx(places[i])];
    state[i] = FollowedTops::kOpen;
    numbers(&tops.point[0])[i] = turned_re_[idx(top.point)];
    numbers(&tops.point[1])[i] = turned_im_[idx(top.point)];
    angle[i] = step_ * top.point;
    numbers(&tops.sign)[i] = sign_of(top);
    start[i] = step_ * numbers(&top_rows_[idx(places[i] / kLanes)].shift)[places[i] % kLanes];
  }
  tops.away = tops.start;
  tops.value.v = Lanes{} - std::numeric_limits<double>::infinity();
  bool any = true;
  for (int round = 0; round < kRefinements && any; ++round) {
    step(re, im, tops);
    any = std::find(state, state + kLanes, FollowedTops::kOpen) != state + kLanes;
  }
  for (int i = 0; i < kLanes; ++i) {
    if (places[i] < 0) continue;
    Top& top = tops_[idx(places[i])];
    double found = value[i], at = angle[i] + away[i];
    if (state[i] == FollowedTops::kLost) {
      const BracketedMaximum searched = search(top, start[i] / step_);
      found = std::max(found, searched.value);
      at = searched.at;
    }
    top.followed = true;
    const auto which = idx(top.which);
    if (angles_[which] >= 0.0 && !(found > best_[which])) continue;
    best_[which] = std::max(best_[which], found);
    values_[which] = found;
    angles_[which] = at < 0.0 ? at + kTwoPi : at >= kTwoPi ? at - kTwoPi : at;
  }
}

void TrigonometricSum::sample(std::span<const Complex* const> sums) {
  const int used = static_cast<int>(sums.size());
  sets_ = (used + kLanes - 1) / kLanes;
  const auto orders = static_cast<int>(multiples_.size());
  for (int set = 0; set < sets_; ++set) {
    const int count = std::min(kLanes, used - set * kLanes);
    std::array<const double*, kLanes> columns;  // unused lanes repeat the first
    for (int lane = 0; lane < kLanes; ++lane)
      columns[idx(lane)] =
          reinterpret_cast<const double*>(sums[idx(set * kLanes + (lane < count ? lane : 0))]);
    run_widest<TakeColumns>(orders, columns.data(), places_.data(), &re_[idx(set)], &im_[idx(set)]);
    for (int k = orders / 4 * 4; k < orders; ++k)
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto row = idx(places_[idx(k)] * kSumSets + set);
        re_[row].v[lane] = columns[idx(lane)][2 * k];
        im_[row].v[lane] = columns[idx(lane)][2 * k + 1];
      }
  }
  run_widest<BoundSizes>(sets_, orders, powers_.data(), re_.data(), im_.data(), bounds_.data());
  for (std::size_t set = 0; set < kSumSets; ++set) {
    thirds_[set] = bounds_[kSumSets + set];
    for (std::size_t b = 0; b < shares_.size(); ++b) bounds_[b * kSumSets + set].v *= shares_[b];
  }
  LaneRow* samples = &samples_[kBeside * kSumSets];
  run_widest<SumEighths>(sets_, points_, orders, fours_, even_, ones_, cosines_.data(), sines_.data(),
                         re_.data(), im_.data(), samples, ends_.data());
  std::copy_n(samples, kBeside * kSumSets, samples + points_ * kSumSets);
  std::copy_n(samples + (points_ - kBeside) * kSumSets, kBeside * kSumSets, samples_.data());
}

void TrigonometricSum::find_tops(int used) {
  run_widest<MarkExtremes>(sets_, points_, &samples_[kBeside * kSumSets], bounds_.data(), ends_.data(),
                           marks_[0].data(), marks_[1].data());
  tops_.clear();
  for (int side = 0; side < kSigns; ++side)
    for (int sum = 0; sum < used; ++sum) {
      if (!(numbers(thirds_.data())[sum] > 0.0)) continue;
      const int which = side * kSums + sum;
      best_[idx(which)] = (side == 0 ? 1.0 : -1.0) * numbers(ends_.data())[which];
      const LaneWord* words = &marks_[idx(side)][idx(sum / kLanes)];
      for (int first = 0; first < points_; first += kMarksAWord, words += kSumSets)
        for (std::uint64_t word = words->of[sum % kLanes]; word != 0; word &= word - 1)
          tops_.push_back({sum, first + std::countr_zero(word), which});
    }
  gather_tops();
  run_widest<LookBetween>(static_cast<int>(top_rows_.size()), top_rows_.data());
  leaders_.fill(-1);
  for (int i = 0; i < static_cast<int>(tops_.size()); ++i) {
    int& leader = leaders_[idx(tops_[idx(i)].which)];
    const auto value = [&](int top) { return numbers(&top_rows_[idx(top / kLanes)].value)[top % kLanes]; };
    if (leader < 0 || value(i) > value(leader)) leader = i;
  }
}

void TrigonometricSum::gather_tops() {
  top_rows_.resize((tops_.size() + kLanes - 1) / kLanes);
  const double *samples = numbers(samples_.data()), *excess = numbers(bounds_.data()) + 2 * kSums;
  for (std::size_t i = 0; i < tops_.size(); ++i) {
    const Top& top = tops_[i];
    double* to = numbers(top_rows_[i / kLanes].y) + i % kLanes;
    const double* from = samples + top.point * kSums + top.sum;
    for (int k = 0; k <= 2 * kBeside; ++k) to[k * kLanes] = from[k * kSums];
    numbers(&top_rows_[i / kLanes].sign)[i % kLanes] = sign_of(top);
    numbers(&top_rows_[i / kLanes].rest)[i % kLanes] = excess[top.sum];
  }
}

void TrigonometricSum::follow_others() {
  // The upper bounds of other tops may now be below the best value.
  for (std::size_t next = 0; next < tops_.size();) {
    std::array<int, kLanes> places;
    places.fill(-1);
    int count = 0;
    for (; next < tops_.size() && count < kLanes; ++next) {
      const Top& top = tops_[next];
      if (top.followed || numbers(&top_rows_[next / kLanes].reach)[next % kLanes] < best_[idx(top.which)])
        continue;
      for (std::size_t k = 0; k < multiples_.size(); ++k) {
        const auto row = k * kSumSets + idx(top.sum / kLanes);
        top_re_[k * kSumSets].v[count] = re_[row].v[top.sum % kLanes];
        top_im_[k * kSumSets].v[count] = im_[row].v[top.sum % kLanes];
      }
      places[idx(count++)] = static_cast<int>(next);
    }
    if (count > 0) follow(places.data(), top_re_.data(), top_im_.data());
  }
}

void TrigonometricSum::extremes(std::span<const Complex* const> sums, std::vector<SumExtremes>& out) {
  out.assign(sums.size(), std::isnan(base_) ? SumExtremes{kNone, kNone, kNone, kNone} : SumExtremes{});
  if (multiples_.empty()) return;
  for (std::size_t first = 0; first < sums.size(); first += kSums) {
    const std::size_t used = std::min<std::size_t>(kSums, sums.size() - first);
    sample(sums.subspan(first, used));
    angles_.fill(-1.0);
    values_.fill(0.0);
    find_tops(static_cast<int>(used));
    for (int side = 0; side < kSigns; ++side)
      for (int set = 0; set < sets_; ++set)
        follow(&leaders_[idx(side * kSums + set * kLanes)], &re_[idx(set)], &im_[idx(set)]);
    follow_others();
    for (std::size_t i = 0; i < used; ++i) {
      SumExtremes& e = out[first + i];
      const double thirds = numbers(thirds_.data())[i];
      if (!std::isfinite(thirds)) {
        e.max = std::numeric_limits<double>::infinity();
        e.min = -e.max;
      } else if (thirds > 0.0) {
        e.max = values_[i];
        e.min = -values_[kSums + i];
        e.max_angle = std::max(0.0, angles_[i]) / base_;
        e.min_angle = std::max(0.0, angles_[kSums + i]) / base_;
      }
    }
  }
}

void TrigonometricSum::extremes(const Eigen::MatrixXcd& amplitudes, std::vector<SumExtremes>& out) {
  std::vector<const Complex*> sums;
  for (Eigen::Index c = 0; c < amplitudes.cols(); ++c) sums.push_back(amplitudes.col(c).data());
  extremes(sums, out);
}

}  // namespace drev
