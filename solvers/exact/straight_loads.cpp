#include "solvers/exact/straight_loads.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

namespace {
constexpr double kOnKnot = 1e-13;  // an angle stands on a knot, relative to the angle and to 1 rad at least
}  // namespace

struct StraightLoads::Move {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, double* x, double nominal, double rate, const double* z,
                                         const double* v) {
    for (int i = 0; i < stride; i += kLanes) {
      L feedback, ratio, a;
      load(x + kFeedback * stride + i, feedback);
      load(x + kRatio * stride + i, ratio);
      load(z + i, a);
      a *= feedback;
      store(a, x + kDeviation * stride + i);
      store(nominal * ratio + a, x + kAngle * stride + i);
      load(v + i, a);
      store(rate * ratio + feedback * a, x + kSpeed * stride + i);
    }
  }
};

/// p_0 ... p_2, right_0 and slopes += of the loads of a layer.
struct StraightLoads::Terms {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, const double* x, double t, double h, const double* phi,
                                         double* p, double* right, double* slopes) {
    for (int i = 0; i < stride; i += kLanes) {
      L coeff, feedback, ratio, slope, rate, a, b, sum;
      load(x + kCoeff * stride + i, coeff);
      load(x + kAngleSlope * stride + i, slope);
      load(x + kTimeSlope * stride + i, rate);
      load(x + kAngle * stride + i, a);
      load(x + kAngle0 * stride + i, b);
      a = slope * (a - b);
      load(x + kTime0 * stride + i, b);
      a += rate * (t - b);
      load(x + kTorque * stride + i, b);
      load(p + i, sum);
      sum += coeff * (a + b);
      store(sum, p + i);
      load(x + kRatio * stride + i, ratio);
      ratio *= slope;
      load(p + stride + i, sum);
      sum += coeff * (h * rate + phi[1] * ratio);
      store(sum, p + stride + i);
      load(p + 2 * stride + i, sum);
      sum += coeff * (phi[2] * ratio);
      store(sum, p + 2 * stride + i);
      // The slope acts on the change of the deviation over the step.
      load(x + kFeedback * stride + i, feedback);
      slope *= feedback;
      load(x + kDeviation * stride + i, a);
      load(right + i, sum);
      sum = sum - slope * a;
      store(sum, right + i);
      load(slopes + i, sum);
      sum += feedback * slope;
      store(sum, slopes + i);
    }
  }
};

/// Flags the loads whose angle passes its nearest bound, or may where it is not monotone.
struct StraightLoads::Reach {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, const double* x, double to, const double* phi,
                                         const double* first, const double* turns, double* turned,
                                         unsigned* flags) {
    const double linear = phi[1], square = phi[2], turn = to * (linear + to * square);
    const double bend = 2.0 * __builtin_fabs(square),
                 most_turn = __builtin_fabs(linear) + __builtin_fabs(square);
    for (int i = 0; i < stride; i += kLanes) {
      L ratio, feedback, angle, a, low, high;
      load(x + kRatio * stride + i, ratio);
      load(x + kFeedback * stride + i, feedback);
      load(x + kAngle * stride + i, angle);
      load(x + kLow * stride + i, low);
      load(x + kHigh * stride + i, high);
      load(first + i, a);
      L rate = linear * ratio + feedback * a;
      load(turns + i, a);
      const L end = angle + turn * ratio + feedback * a;
      store(rate, turned + i);
      store(end, turned + stride + i);
      magnitude(rate);
      magnitude(ratio);
      magnitude(feedback);
      load(turns + stride + i, a);
      const L reach = most_turn * ratio + feedback * a;
      load(turns + 2 * stride + i, a);
      const L others = bend * ratio + feedback * a;
      L passes = end - high, may = angle + reach - high;
      raise(passes, low - end);
      raise(may, low - (angle - reach));
      rate = KinkSizes::kMonotone * rate - others;
      store(rate, turned + 2 * stride + i);
      choose(rate, may, passes, a);
      flags[i / kLanes] = not_below_zero(a);
    }
  }
};

/// Flags those whose angle stands nearer to a bound than rounding.
struct StraightLoads::BesideKnot {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, const double* x, unsigned* flags) {
    for (int i = 0; i < stride; i += kLanes) {
      L angle, near, a, one{};
      one = 1.0 + one;
      load(x + kAngle * stride + i, angle);
      near = angle;
      magnitude(near);
      raise(near, one);
      near = kOnKnot * near;
      load(x + kHigh * stride + i, a);
      L most = near - (a - angle);
      load(x + kLow * stride + i, a);
      raise(most, near - (angle - a));
      flags[i / kLanes] = not_below_zero(most);
    }
  }
};

/// 1/2 sum slope (feedback (b - a))^2.
struct StraightLoads::SlopeWork {
  template <class L>
  [[gnu::always_inline]] static double run(int stride, const double* x, const double* a, const double* b) {
    L sum{};
    for (int i = 0; i < stride; i += kLanes) {
      L turn, y, slope;
      load(b + i, turn);
      load(a + i, y);
      turn = turn - y;
      load(x + kFeedback * stride + i, y);
      turn *= y;
      load(x + kAngleSlope * stride + i, slope);
      sum += slope * (turn * turn);
    }
    return 0.5 * sum_of(sum);
  }
};

StraightLoads::StraightLoads(const System& system)
    : system_(system),
      stride_(TaylorSeries::stride(system)),
      rows_(idx(stride_)),
      rates_(idx(stride_)),
      slopes_(idx(stride_)),
      turned_(idx(3 * stride_)),
      flags_(idx(stride_ / kLanes)) {}

void StraightLoads::add(const LoadTerm& term, const TaylorSeries& series) {
  Load& l = loads_.emplace_back(system_, term);
  l.find_reach(series);
  if (const auto table = term.load->table()) {
    const auto known =
        std::find_if(tables_.begin(), tables_.end(), [&](const auto& t) { return t.is_of(*table); });
    l.table = static_cast<int>(known - tables_.begin());
    l.phase = table->phase;
    if (known == tables_.end()) tables_.emplace_back(*table);
  }
  while (l.layer < layers_.size() && layers_[l.layer].load[idx(l.row)] >= 0) ++l.layer;
  if (l.layer == layers_.size()) {
    Layer& layer = layers_.emplace_back();
    layer.values.assign(idx(kQuantities * stride_), 0.0);
    layer.load.assign(idx(stride_), -1);
    std::fill_n(values(layer, kLow), stride_, -std::numeric_limits<double>::infinity());
    std::fill_n(values(layer, kHigh), stride_, std::numeric_limits<double>::infinity());
  }
  layers_[l.layer].load[idx(l.row)] = static_cast<int>(loads_.size()) - 1;
  value(l, kCoeff) = l.coeff;
  value(l, kFeedback) = l.feedback ? l.coeff : 0.0;
  value(l, kRatio) = l.ratio;
}

void StraightLoads::find_rows(const Vector& z, LaneVector& rows) const {
  const int n = system_.size();
  std::copy_n(z.data(), n, rows.data());
  for (int j = 0; j < system_.loaded_rows(); ++j) rows[idx(n + j)] = system_.rows().row(j).dot(z);
}

void StraightLoads::move(const MotionPoint& nominal, const Vector& z, const Vector& v) {
  if (loads_.empty()) return;
  find_rows(v, rates_);
  find_rows(z, rows_);
  for (Layer& layer : layers_)
    run_widest<Move>(stride_, layer.values.data(), nominal.value, nominal.rate,
                     static_cast<const double*>(rows_.data()), static_cast<const double*>(rates_.data()));
  stale_ = true;
}

void StraightLoads::move_as(const StraightLoads& other) {
  loads_ = other.loads_;
  layers_ = other.layers_;
  near_ = other.near_;
  stale_ = other.stale_;
  marked_ = other.marked_;
}

void StraightLoads::refresh(Load& l) {
  const double* from = &value(l, static_cast<Quantity>(0));
  l.angle = from[kAngle * stride_];
  l.deviation = from[kDeviation * stride_];
  l.speed = from[kSpeed * stride_];
}

std::vector<StraightLoads::Load>& StraightLoads::loads() {
  if (stale_)
    for (Load& l : loads_) refresh(l);
  stale_ = false;
  return loads_;
}

/// Writes the load's stretch to its row.
void StraightLoads::place(Load& l) {
  double* to = &value(l, static_cast<Quantity>(0));
  const auto put = [&](Quantity q, double x) { to[q * stride_] = x; };
  put(kLow, l.stretch.low);
  put(kHigh, l.stretch.high);
  put(kTorque, l.stretch.torque);
  put(kAngleSlope, l.stretch.angle_slope);
  put(kTimeSlope, l.stretch.time_slope);
  put(kAngle0, l.angle_0);
  put(kTime0, l.t_0);
}

void StraightLoads::look_up(Load& l, double t, double direction) {
  l.t_0 = t;
  l.angle_0 = l.angle;
  if (l.table >= 0) {
    const TableStretches& table = tables_[idx(l.table)];
    l.place = table.find(l.angle, l.phase, direction);
    table.read(l.place, l.stretch);
    if (table.bounded()) l.angle_0 = l.stretch.low;
  } else {
    l.stretch = l.term->load->stretch(t, l.angle, direction).value_or(LoadStretch{});
  }
  place(l);
}

const LoadStretch& StraightLoads::look_beyond(Load& l, double t, double bound, bool rises) const {
  l.ahead_angle_0 = bound;
  return l.ahead = l.term->load->stretch(t, bound, rises ? 1.0 : -1.0).value_or(LoadStretch{});
}

void StraightLoads::locate(double t) {
  near_.clear();
  for (Load& l : loads()) {
    l.watched = false;
    look_up(l, t, l.speed);
  }
}

/// Calls with each load of a layer that is flagged.
template <class Each>
void StraightLoads::for_flagged(const Layer& layer, const Each& each) {
  const int* load = layer.load.data();
  for (unsigned flagged : flags_) {
    for (; flagged != 0; flagged &= flagged - 1) each(load[std::countr_zero(flagged)]);
    load += kLanes;
  }
}

void StraightLoads::advance_other(Load& l) {
  l.stretch = l.ahead;
  l.angle_0 = l.ahead_angle_0;
  place(l);
}

/// Many a step: no more than what changes, each number by itself.
void StraightLoads::advance_table(Load& l) {
  const TableStretches& table = table_of(l);
  const double low = table.low(l.ahead_place), high = table.high(l.ahead_place),
               slope = table.slope(l.ahead_place);
  double* to = &value(l, static_cast<Quantity>(0));
  const auto put = [&](Quantity q, double x) { to[q * stride_] = x; };
  put(kLow, l.stretch.low = low);
  put(kHigh, l.stretch.high = high);
  put(kAngle0, l.angle_0 = low);
  put(kAngleSlope, l.stretch.angle_slope = slope);
  put(kTorque, l.stretch.torque = table.torque(l.ahead_place));
  l.place.number = l.ahead_place.number;
  l.place.turns = l.ahead_place.turns;
}

void StraightLoads::advance(double t, bool whole) {
  if (whole)
    for (const Near& near : near_) {
      Load& l = load_of(near);
      if (l.watched) continue;
      l.table >= 0 ? advance_table(l) : advance_other(l);
    }
  for (Layer& layer : layers_) {
    run_widest<BesideKnot>(stride_, static_cast<const double*>(layer.values.data()), flags_.data());
    for_flagged(layer, [&](int k) {
      Load& l = loads_[idx(k)];
      refresh(l);
      const double near = kOnKnot * std::max(1.0, std::abs(l.angle));
      const double above = l.angle - l.stretch.low, below = l.stretch.high - l.angle;
      if (l.speed > 0.0 ? below > near : above > near) return;
      // From rest LoadSeries::pass_knot() knows where it goes.
      if (l.speed == 0.0 && above >= -near && below >= -near) return;
      look_up(l, t, l.speed);
    });
  }
}

void StraightLoads::add_to(TaylorSeries& series, double t, double h, const std::array<double, 3>& phi,
                           double* p) {
  if (loads_.empty()) return;
  std::fill(slopes_.begin(), slopes_.end(), 0.0);
  for (const Layer& layer : layers_)
    run_widest<Terms>(stride_, static_cast<const double*>(layer.values.data()), t, h, phi.data(), p,
                      series.right_side(0), slopes_.data());
  series.add_row_slopes(slopes_.data());
}

const std::vector<StraightLoads::Near>& StraightLoads::near_knots(const TaylorSeries& series, double to,
                                                                  const std::array<double, 3>& phi,
                                                                  const double* turns) {
  if (std::exchange(marked_, false))
    for (const Near& near : near_) {
      Load& l = load_of(near);
      l.watched = false;
      l.contraction = 0.0;
    }
  near_.clear();
  for (const Layer& layer : layers_) {
    run_widest<Reach>(stride_, static_cast<const double*>(layer.values.data()), to, phi.data(),
                      series.coefficients(1), turns, turned_.data(), flags_.data());
    const double* angle = layer.values.data() + idx(kAngle * stride_);
    for_flagged(layer, [&](int k) {
      Load& l = loads_[idx(k)];
      l.angle = angle[l.row];
      const double* turned = turned_.data() + l.row;
      near_.push_back({k, turned[2 * stride_] >= 0.0, turned[0], turned[stride_]});
    });
  }
  return near_;
}

double StraightLoads::slope_work(const TaylorSeries& series, const Vector& z) {
  double sum = 0.0;
  if (loads_.empty()) return sum;
  find_rows(z, rows_);
  for (const Layer& layer : layers_)
    sum += run_widest<SlopeWork>(stride_, static_cast<const double*>(layer.values.data()),
                                 series.coefficients(0), static_cast<const double*>(rows_.data()));
  return sum;
}

}  // namespace drev
