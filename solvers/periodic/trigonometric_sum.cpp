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
  const auto take = [&](int from, int step) {  // the multiples from, from + step, ...
    for (std::size_t k = 0; k < orders.size(); ++k)
      if (const auto n = static_cast<int>(std::lround(orders[k] / base_)); n % step == from)
        multiples_.push_back(n), rows_.push_back(static_cast<Eigen::Index>(k));
    return static_cast<int>(rows_.size());
  };
  fours_ = take(0, 4);
  even_ = take(2, 4);
  take(1, 2);
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
  for (int p = 0; p <= points / 4; ++p)
    for (const int n : multiples_) {
      cosines_.push_back(turned_re_[idx(n * p % points)]);
      sines_.push_back(turned_im_[idx(n * p % points)]);
    }
  dense_ = highest_ <= 4 * static_cast<int>(multiples_.size());
  for (LaneArray* rows : {&re_, &im_, &top_re_, &top_im_}) rows->resize(orders.size());
  for (std::size_t k = 0; k < multiples_.size(); ++k)
    places_.push_back(dense_ ? multiples_[k] : static_cast<int>(k));
  for (LaneArray* rows : {&power_re_, &power_im_})
    rows->resize(dense_ ? idx(highest_ + 2) : multiples_.size());
  samples_.resize(idx(points + 2 * kBeside));
  for (auto& marks : marks_) marks.resize(idx((points + kMarksAWord - 1) / kMarksAWord));
}

double TrigonometricSum::cycle() const { return base_ > 0.0 ? kTwoPi / base_ : 0.0; }

void TrigonometricSum::find_powers(const LaneRow* point, const LaneRow& angle, const LaneRow& away) {
  if (dense_) {
    run_widest<FindPowers>((highest_ + 2) / 2 * 2, point, &away, power_re_.data(), power_im_.data());
    return;
  }
  for (std::size_t k = 0; k < multiples_.size(); ++k)
    for (int i = 0; i < kLanes; ++i) {
      power_re_[k].v[i] = std::cos(multiples_[k] * (angle.v[i] + away.v[i]));
      power_im_[k].v[i] = std::sin(multiples_[k] * (angle.v[i] + away.v[i]));
    }
}

BracketedMaximum TrigonometricSum::search(const Top& top) const {
  const double middle = step_ * top.point, near = 1e-9 * step_;
  return bracketed_maximum(middle - step_, middle + step_ * top.shift, middle + step_, near,
                           [&](double angle) {
                             double sum = 0.0;
                             for (std::size_t k = 0; k < multiples_.size(); ++k)
                               sum += re_[k].v[top.lane] * std::cos(multiples_[k] * angle) -
                                      im_[k].v[top.lane] * std::sin(multiples_[k] * angle);
                             return top.sign * sum;
                           });
}

void TrigonometricSum::refine(const std::array<int, kLanes>& places, bool in_their_lanes) {
  const auto orders = static_cast<int>(multiples_.size());
  LaneRow away, start, angle, point[2];
  std::array<double, kLanes> value;
  value.fill(-std::numeric_limits<double>::infinity());
  unsigned open = 0;
  for (int i = 0; i < kLanes; ++i) {
    if (places[idx(i)] < 0) continue;
    const Top& top = tops_[idx(places[idx(i)])];
    open |= 1U << static_cast<unsigned>(i);
    angle.v[i] = step_ * top.point;
    point[0].v[i] = turned_re_[idx(top.point)];
    point[1].v[i] = turned_im_[idx(top.point)];
    away.v[i] = start.v[i] = step_ * top.shift;
    if (in_their_lanes) continue;
    for (std::size_t k = 0; k < multiples_.size(); ++k) {
      top_re_[k].v[i] = re_[k].v[top.lane];
      top_im_[k].v[i] = im_[k].v[top.lane];
    }
  }
  const LaneRow *re = in_their_lanes ? re_.data() : top_re_.data(),
                *im = in_their_lanes ? im_.data() : top_im_.data();
  FollowTop::Found d;
  for (int round = 0; round < kRefinements && open != 0; ++round) {
    find_powers(point, angle, away);
    run_widest<FollowTop>(orders, multiples_.data(), places_.data(), re, im, power_re_.data(),
                          power_im_.data(), &d);
    for (unsigned left = open; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      const unsigned bit = 1U << static_cast<unsigned>(i);
      const Top& top = tops_[idx(places[idx(i)])];
      value[idx(i)] = std::max(value[idx(i)], top.sign * d.value.v[i]);
      open &= ~bit;
      const double step = d.step.v[i];
      if (!(top.sign * d.bend.v[i] < 0.0) || std::abs(away.v[i] + step - start.v[i]) > step_) {
        const BracketedMaximum found = search(top);
        value[idx(i)] = std::max(value[idx(i)], found.value);
        away.v[i] = found.at - angle.v[i];
        continue;
      }
      away.v[i] += step;
      if (std::abs(step) < kAngleTolerance * step_)
        value[idx(i)] = std::max(value[idx(i)], top.sign * d.behind.v[i]);
      else
        open |= bit;
    }
  }
  for (int i = 0; i < kLanes; ++i) {
    if (places[idx(i)] < 0) continue;
    Top& top = tops_[idx(places[idx(i)])];
    top.found = value[idx(i)];
    top.angle = angle.v[i] + away.v[i];
  }
}

void TrigonometricSum::sample(const Eigen::MatrixXcd& amplitudes, Eigen::Index first, int used) {
  for (std::size_t k = 0; used < kLanes && k < multiples_.size(); ++k) re_[k].v = im_[k].v = Lanes{};
  std::array<const Complex*, kLanes> columns{};
  for (int lane = 0; lane < used; ++lane) columns[idx(lane)] = amplitudes.col(first + lane).data();
  for (std::size_t k = 0; k < multiples_.size(); ++k)
    for (int lane = 0; lane < used; ++lane) {
      const Complex a = columns[idx(lane)][rows_[k]];
      re_[k].v[lane] = a.real();
      im_[k].v[lane] = a.imag();
    }
  const auto orders = static_cast<int>(multiples_.size());
  LaneRow sizes[3];
  run_widest<BoundSizes>(orders, powers_.data(), re_.data(), im_.data(), sizes);
  thirds_ = sizes[1];
  bounds_[0].v = step_ * step_ / 8.0 * sizes[0].v;
  bounds_[1].v = 2.0 / 3.0 * std::pow(step_, 3) * sizes[1].v;
  rest_.v = LookBetween::kSeventh * std::pow(step_, 7) * sizes[2].v;
  run_widest<SumEighths>(points_, orders, fours_, even_, cosines_.data(), sines_.data(), re_.data(),
                         im_.data(), &samples_[kBeside], ends_.data());
  for (int k = 0; k < kBeside; ++k) {
    samples_[idx(k)] = samples_[idx(points_ + k)];
    samples_[idx(points_ + kBeside + k)] = samples_[idx(kBeside + k)];
  }
}

void TrigonometricSum::find_tops(int used) {
  tops_.clear();
  run_widest<MarkExtremes>(points_, &samples_[kBeside], bounds_.data(), ends_.data(), marks_[0].data(),
                           marks_[1].data());
  for (int side = 0; side < kSigns; ++side)
    for (int lane = 0; lane < used; ++lane) {
      const double sign = side == 0 ? 1.0 : -1.0;
      best_[idx(side * kLanes + lane)] = sign * ends_[idx(side)].v[lane];
      if (!(thirds_.v[lane] > 0.0)) continue;
      for (std::size_t w = 0; w < marks_[0].size(); ++w)
        for (std::uint64_t word = marks_[idx(side)][w].of[lane]; word != 0; word &= word - 1)
          add_top(lane, static_cast<int>(w) * kMarksAWord + std::countr_zero(word), side, sign);
    }
  const std::size_t rows = (tops_.size() + kLanes - 1) / kLanes;
  run_widest<LookBetween>(static_cast<int>(rows), top_rows_.data());
  for (std::size_t i = 0; i < tops_.size(); ++i) {
    const TopRows& found = top_rows_[i / kLanes];
    const auto lane = static_cast<int>(i % kLanes);
    tops_[i].shift = found.shift.v[lane];
    tops_[i].reach = found.reach.v[lane];
    tops_[i].value = found.value.v[lane];
  }
}

void TrigonometricSum::add_top(int lane, int point, int side, double sign) {
  const std::size_t place = tops_.size();
  tops_.push_back({lane, point, side * kLanes + lane, sign});
  if (top_rows_.size() <= place / kLanes) top_rows_.emplace_back();
  TopRows& rows = top_rows_[place / kLanes];
  const auto to = static_cast<int>(place % kLanes);
  for (int k = -kBeside; k <= kBeside; ++k)
    rows.y[kBeside + k].v[to] = sign * samples_[idx(point + kBeside + k)].v[lane];
  rows.rest.v[to] = rest_.v[lane];
}

void TrigonometricSum::follow_leaders() {
  std::array<std::array<int, kLanes>, 2> leaders;
  for (auto& side : leaders) side.fill(-1);
  for (std::size_t i = 0; i < tops_.size(); ++i) {
    int& leader = leaders[idx(tops_[i].which / kLanes)][idx(tops_[i].lane)];
    if (leader < 0 || tops_[i].value > tops_[idx(leader)].value) leader = static_cast<int>(i);
  }
  for (const auto& side : leaders) {
    refine(side, true);
    for (const int place : side)
      if (place >= 0) take_found(place);
  }
}

void TrigonometricSum::take_found(int place) {
  Top& top = tops_[idx(place)];
  top.followed = true;
  double& best = best_[idx(top.which)];
  if (angles_[idx(top.which)] >= 0.0 && !(top.found > best)) return;
  best = std::max(best, top.found);
  values_[idx(top.which)] = top.found;
  angles_[idx(top.which)] = top.angle - kTwoPi * std::floor(top.angle / kTwoPi);
}

void TrigonometricSum::extremes(const Eigen::MatrixXcd& amplitudes, std::vector<SumExtremes>& out) {
  out.assign(static_cast<std::size_t>(amplitudes.cols()), {});
  if (multiples_.empty()) return;
  for (Eigen::Index first = 0; first < amplitudes.cols(); first += kLanes) {
    const int used = static_cast<int>(std::min<Eigen::Index>(kLanes, amplitudes.cols() - first));
    sample(amplitudes, first, used);
    angles_.fill(-1.0);
    values_.fill(0.0);
    find_tops(used);
    follow_leaders();
    // The upper bounds of other tops may now be below the best value.
    for (std::size_t next = 0; next < tops_.size();) {
      std::array<int, kLanes> places;
      places.fill(-1);
      int count = 0;
      for (; next < tops_.size() && count < kLanes; ++next)
        if (!tops_[next].followed && !(tops_[next].reach < best_[idx(tops_[next].which)]))
          places[idx(count++)] = static_cast<int>(next);
      if (count == 0) break;
      refine(places, false);
      for (int i = 0; i < count; ++i) take_found(places[idx(i)]);
    }
    for (int lane = 0; lane < used; ++lane) {
      SumExtremes& e = out[static_cast<std::size_t>(first + lane)];
      if (!std::isfinite(thirds_.v[lane])) {
        e.max = std::numeric_limits<double>::infinity();
        e.min = -e.max;
      } else if (thirds_.v[lane] > 0.0) {
        e.max = values_[idx(lane)];
        e.min = -values_[idx(kLanes + lane)];
        e.max_angle = std::max(0.0, angles_[idx(lane)]) / base_;
        e.min_angle = std::max(0.0, angles_[idx(kLanes + lane)]) / base_;
      }
    }
  }
}

}  // namespace drev
