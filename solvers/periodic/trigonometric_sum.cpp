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
constexpr int kPointsAPeriod = 4;    // points in a period of the highest order
constexpr int kFewestPoints = 16;
constexpr int kRefinements = 20;
constexpr double kAngleTolerance = 5e-3;  // last step d over distance of points [-]: (n d)^6/720 is rounding

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
  for (const int parity : {0, 1}) {
    for (std::size_t k = 0; k < orders.size(); ++k)
      if (const auto n = static_cast<int>(std::lround(orders[k] / base_)); n % 2 == parity)
        multiples_.push_back(n), rows_.push_back(static_cast<Eigen::Index>(k));
    if (parity == 0) even_ = static_cast<int>(rows_.size());
  }
  base_ = highest / std::round(highest / base_);
  for (const int n : multiples_) cubes_.push_back(std::pow(n, 3)), sevenths_.push_back(std::pow(n, 7));
  highest_ = *std::max_element(multiples_.begin(), multiples_.end());
  const int points = std::max(kFewestPoints, kPointsAPeriod * highest_);
  step_ = kTwoPi / points;
  points_ = points;
  for (int p = 0; p < points; ++p) {
    turned_re_.push_back(std::cos(step_ * p));
    turned_im_.push_back(std::sin(step_ * p));
  }
  for (int p = 0; p <= points / 4 + 1; ++p)  // one more, since points are processed in pairs
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
  for (LaneArray* marks : {&top_marks_, &bottom_marks_}) marks->resize(idx(points / kMarksAWord + 1));
}

double TrigonometricSum::cycle() const { return base_ > 0.0 ? kTwoPi / base_ : 0.0; }

/// Place of a top's sum and sign in best_, values_ and angles_.
int TrigonometricSum::place_of(const Top& top) { return (top.sign > 0.0 ? 0 : kLanes) + top.lane; }

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
  LaneRow sizes[2];
  run_widest<BoundSizes>(orders, cubes_.data(), sevenths_.data(), re_.data(), im_.data(), sizes);
  thirds_ = sizes[0];
  // Largest excess of the sum, within half a step, over the parabola through three points and over the
  // polynomial through seven.
  const double third = step_ * step_ * step_ / (9.0 * std::sqrt(3.0)),
               seventh = LookBetween::kSeventh * std::pow(step_, 7);
  for (int lane = 0; lane < kLanes; ++lane) {
    slack_.v[lane] = third * sizes[0].v[lane];
    rest_.v[lane] = seventh * sizes[1].v[lane];
  }
  run_widest<SumQuarters>(points_, orders, even_, cosines_.data(), sines_.data(), re_.data(), im_.data(),
                          &samples_[kBeside], ends_.data());
  for (int k = 0; k < kBeside; ++k) {
    samples_[idx(k)] = samples_[idx(points_ + k)];
    samples_[idx(points_ + kBeside + k)] = samples_[idx(kBeside + k)];
  }
}

void TrigonometricSum::find_tops(int used) {
  run_widest<MarkExtremes>(points_, &samples_[kBeside], &slack_, ends_.data(), top_marks_.data(),
                           bottom_marks_.data());
  for (int lane = 0; lane < kLanes; ++lane) {
    best_[idx(lane)] = ends_[0].v[lane];
    best_[idx(kLanes + lane)] = -ends_[1].v[lane];
  }
  for (const double sign : {1.0, -1.0})
    take_marked(used, sign, sign > 0.0 ? top_marks_.data() : bottom_marks_.data());
}

void TrigonometricSum::take_marked(int used, double sign, const LaneRow* marks) {
  for (int lane = 0; lane < used; ++lane) {
    if (!(slack_.v[lane] > 0.0)) continue;
    for (int first = 0; first < points_; first += kMarksAWord)
      for (auto word = static_cast<std::uint64_t>(marks[first / kMarksAWord].v[lane]); word != 0;
           word &= word - 1) {
        const int p = first + std::countr_zero(word);
        const double before = sample_at(p - 1, lane), here = sample_at(p, lane),
                     after = sample_at(p + 1, lane);
        const double bend = sign * (2.0 * here - before - after), tilt = 0.5 * sign * (after - before);
        // Place of the parabola's maximum within half a step.
        const double shift = std::abs(tilt) < 0.5 * bend ? tilt / bend : std::copysign(0.5, tilt);
        Top top{lane, p, sign, shift, sign * here + shift * (tilt - 0.5 * bend * shift) + slack_.v[lane]};
        if (top.reach >= best_[idx(place_of(top))]) tops_.push_back(top);
      }
  }
}

void TrigonometricSum::look_between() {
  constexpr int kSides = LookBetween::kSides;
  std::array<LaneRow, 2 * kSides + 1> y;
  LaneRow at, reach, rest, value;
  for (std::size_t first = 0; first < tops_.size(); first += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, tops_.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const Top& top = tops_[first + i];
      const auto lane = static_cast<int>(i);
      for (int k = -kSides; k <= kSides; ++k)
        y[idx(kSides + k)].v[lane] = top.sign * sample_at(top.point + k, top.lane);
      at.v[lane] = top.shift, reach.v[lane] = top.reach, rest.v[lane] = rest_.v[top.lane];
    }
    run_widest<LookBetween>(y.data(), &rest, &at, &reach, &value);
    for (std::size_t i = 0; i < count; ++i) {
      tops_[first + i].shift = at.v[static_cast<int>(i)];
      tops_[first + i].reach = reach.v[static_cast<int>(i)];
      tops_[first + i].value = value.v[static_cast<int>(i)];
    }
  }
}

void TrigonometricSum::follow_leaders() {
  std::array<std::array<int, kLanes>, 2> leaders;
  for (auto& side : leaders) side.fill(-1);
  for (std::size_t i = 0; i < tops_.size(); ++i) {
    int& leader = leaders[tops_[i].sign > 0.0 ? 0 : 1][idx(tops_[i].lane)];
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
  const int which = place_of(top);
  double& best = best_[idx(which)];
  if (angles_[idx(which)] >= 0.0 && !(top.found > best)) return;
  best = std::max(best, top.found);
  values_[idx(which)] = top.found;
  angles_[idx(which)] = top.angle - kTwoPi * std::floor(top.angle / kTwoPi);
}

void TrigonometricSum::extremes(const Eigen::MatrixXcd& amplitudes, std::vector<SumExtremes>& out) {
  out.assign(static_cast<std::size_t>(amplitudes.cols()), {});
  if (multiples_.empty()) return;
  for (Eigen::Index first = 0; first < amplitudes.cols(); first += kLanes) {
    const int used = static_cast<int>(std::min<Eigen::Index>(kLanes, amplitudes.cols() - first));
    sample(amplitudes, first, used);
    tops_.clear();
    angles_.fill(-1.0);
    values_.fill(0.0);
    find_tops(used);
    look_between();
    follow_leaders();
    // The upper bounds of other tops may now be below the best value.
    for (std::size_t next = 0; next < tops_.size();) {
      std::array<int, kLanes> places;
      places.fill(-1);
      int count = 0;
      for (; next < tops_.size() && count < kLanes; ++next)
        if (!tops_[next].followed && !(tops_[next].reach < best_[idx(place_of(tops_[next]))]))
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
