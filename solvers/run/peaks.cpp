#include <drev/core/assembler.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>
#include <limits>

#include "solvers/linear/lane_pair.hpp"
#include "solvers/run/cubic_peak.hpp"
#include "solvers/run/peak_search.hpp"

namespace drev {

namespace {
constexpr double kNear = 0.05;  // distance from the range so far, over it, of steps that may hold a new peak
constexpr double kMostBulge = 0.15;  // > 4/27: cubic_reach()
constexpr double kSame = 1e-13;      // rounding of a torque of friction over its peak
constexpr double kShort = 1e-6;      // length over the longest step: nothing moves in shorter ones
}  // namespace

Peaks::Peaks(std::vector<Channel> channels, bool inside_steps)
    : channels_(std::move(channels)),
      peaks_(channels_.size()),
      watched_(channels_.size()),
      inside_steps_(inside_steps) {
  for (std::size_t c = 0; c < channels_.size(); ++c)
    if (channels_[c].is_linear() && channels_[c].z_row().size() <= 2 && channels_[c].v_row().empty())
      add_pair(c);
    else
      others_.push_back(c);
  for (std::size_t i = 0; i < pairs_.first.size(); i += kLanes) {
    const auto follow = [i](const std::vector<int>& index) {
      const auto from = index.begin() + static_cast<std::ptrdiff_t>(i);
      return std::adjacent_find(from, from + kLanes, [](int a, int b) { return b != a + 1; }) ==
             from + kLanes;
    };
    pairs_.in_a_row.push_back(follow(pairs_.first) && follow(pairs_.second) ? 1 : 0);
  }
}

void Peaks::add_pair(std::size_t c) {
  const std::size_t i = pairs_.channel.size();
  watched_[c].pair = static_cast<int>(i);
  pairs_.channel.push_back(c);
  const auto room = static_cast<std::size_t>(whole_lanes(static_cast<int>(i) + 1));
  for (auto* list : {&pairs_.first, &pairs_.second}) list->resize(room, 0);
  for (auto* list : {&pairs_.coeff_1, &pairs_.coeff_2, &pairs_.last, &pairs_.ahead, &pairs_.last_rate,
                     &pairs_.ahead_rate, &pairs_.beyond})
    list->resize(room, 0.0);
  pairs_.max.resize(room, std::numeric_limits<double>::infinity());
  pairs_.min.resize(room, -std::numeric_limits<double>::infinity());
  const std::vector<Entry>& row = channels_[c].z_row();
  if (!row.empty()) pairs_.first[i] = row[0].index, pairs_.coeff_1[i] = row[0].coeff;
  if (row.size() == 2) pairs_.second[i] = row[1].index, pairs_.coeff_2[i] = row[1].coeff;
}

double Peaks::value(std::size_t c, const Assembler& assembler, const EvaluatedState& point) const {
  const int pair = watched_[c].pair;
  return pair >= 0 ? pairs_.sum(pair, point.state.z.data()) : channels_[c].evaluate(assembler, point.state);
}

/// The same at the end of a step of a StepMotion, whose laws were evaluated there.
double Peaks::end_value(std::size_t c, const Assembler& assembler, const EvaluatedState& point) const {
  if (const int law = channels_[c].force_of(); law >= 0) return point.responses[idx(law)].y;
  if (const int law = channels_[c].deflection_of(); law >= 0) return point.inputs[idx(law)].x;
  return value(c, assembler, point);
}

std::optional<double> Peaks::rate(std::size_t c, const Assembler& assembler,
                                  const EvaluatedState& point) const {
  if (const int pair = watched_[c].pair; pair >= 0) return pairs_.sum(pair, point.state.v.data());
  if (const int law = channels_[c].deflection_of(); law >= 0) return point.inputs[idx(law)].x_dot;
  // Known motions are those of the assembler's time, which may be another than the point's.
  const System& system = assembler.system();
  const int law = channels_[c].force_of();
  const bool by_phase = law >= 0 && system.scalars()[idx(law)].phase_node >= 0;
  if (!channels_[c].is_linear() &&
      (system.any_prescribed_moves() || (by_phase && assembler.nominal().acceleration != 0.0)))
    return std::nullopt;
  if (law >= 0)
    return channels_[c].force_rate(assembler, point.state, point.inputs[idx(law)], point.responses[idx(law)]);
  return channels_[c].rate(assembler, point.state);
}

bool Peaks::watches_loads() const {
  return std::any_of(channels_.begin(), channels_.end(), [](const Channel& c) { return c.follows_loads(); });
}

void Peaks::find_rows(const System& system) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const int law = channels_[c].deflection_of();
    if (law < 0) continue;
    const ScalarTerm& term = system.scalars()[idx(law)];
    const bool moves_alone =
        term.phase_node >= 0 || term.varies;  // by more than known motions, of degree 2 in time
    if (!moves_alone) watched_[c].row = term.z;
  }
}

double Peaks::along(std::size_t c, const Vector& x, const Vector& x_dot) const {
  double y = 0.0;
  for (const Entry& e : channels_[c].z_row()) y += e.coeff * x[e.index];
  for (const Entry& e : channels_[c].v_row()) y += e.coeff * x_dot[e.index];
  return y;
}

bool Peaks::may_pass(std::size_t c, const EvaluatedState& from, const EvaluatedState& to,
                     const double* beyond_cubic) {
  const Watched& w = watched_[c];
  const double h = to.state.t - from.state.t;
  Interval reach;
  double beyond = 0.0;
  if (channels_[c].is_linear()) {
    // Its rate reads the acceleration, which is the rate's rate.
    reach = cubic_reach(w.last, along(c, from.state.v, from.state.a), along(c, to.state.z, to.state.v),
                        along(c, to.state.v, to.state.a), h);
    for (const Entry& e : channels_[c].z_row()) beyond += std::abs(e.coeff) * beyond_cubic[e.index];
    for (const Entry& e : channels_[c].v_row())
      beyond += std::abs(e.coeff) * beyond_cubic[to.state.z.size() + e.index];
    if (within_peaks(c, reach.low, reach.high, beyond)) return false;
    return !can_seek(c, along(c, from.state.v, from.state.a) * along(c, to.state.v, to.state.a) < 0.0);
  } else if (const int law = channels_[c].deflection_of(); law >= 0 && !w.row.empty()) {
    for (const Entry& e : w.row) beyond += std::abs(e.coeff) * beyond_cubic[e.index];
    const ScalarInput &a = from.inputs[idx(law)], &b = to.inputs[idx(law)];
    reach = cubic_reach(a.x, a.x_dot, b.x, b.x_dot, h);
  } else if (const int law = channels_[c].force_of(); law >= 0) {
    const auto force = motion_->force_reach(law);
    if (force && within_peaks(c, force->low, force->high, 0.0)) return false;
    const auto range = motion_->force_range(law);
    if (!range) return true;
    reach = {range->low, range->high};
    beyond = range->error;
  } else if (const auto range = motion_->friction_range(channels_[c].friction_place())) {
    // Most often it is constant, at its own peak but for rounding.
    reach = {range->low, range->high};
    beyond = range->error - kSame * std::max(std::abs(peaks_[c].max), std::abs(peaks_[c].min));
  } else {
    return true;
  }
  return !within_peaks(c, reach.low, reach.high, beyond);
}

/// Values and rates at the step's end, and how far the value may come beyond its peaks: most are so far from them that no slope at
/// an end leads there. Returns the most of any; not a number where some value is none.
struct Peaks::Pairs::Beyond {
  template <bool kInARow, class L>
  [[gnu::always_inline]] static void take(const double* x, const int* index, L& to) {
    if constexpr (kInARow)
      load(x + index[0], to);
    else
      gather(x, index, to);
  }
  template <bool kInARow, class L>
  [[gnu::always_inline]] static void some(Pairs& pairs, std::size_t i, const double* z, const double* v,
                                          const double* beyond_cubic, double most_bulge, L& any,
                                          L& not_finite) {
    const int *first = pairs.first.data() + i, *second = pairs.second.data() + i;
    L c_1, c_2, x_1{}, x_2{}, bulge, last, bound;
    load(pairs.coeff_1.data() + i, c_1);
    load(pairs.coeff_2.data() + i, c_2);
    take<kInARow>(z, first, x_1);
    take<kInARow>(z, second, x_2);
    const L ahead = c_1 * x_1 + c_2 * x_2;
    store(ahead, pairs.ahead.data() + i);
    take<kInARow>(v, first, x_1);
    take<kInARow>(v, second, x_2);
    L rate = c_1 * x_1 + c_2 * x_2;
    store(rate, pairs.ahead_rate.data() + i);
    magnitude(rate);
    load(pairs.last_rate.data() + i, bulge);
    magnitude(bulge);
    bulge = most_bulge * (bulge + rate);
    take<kInARow>(beyond_cubic, first, x_1);
    take<kInARow>(beyond_cubic, second, x_2);
    magnitude(c_1);
    magnitude(c_2);
    bulge += c_1 * x_1 + c_2 * x_2;
    load(pairs.last.data() + i, last);
    load(pairs.max.data() + i, bound);
    L most = ahead + bulge - bound;
    raise(most, last + bulge - bound);
    load(pairs.min.data() + i, bound);
    raise(most, bound - (ahead - bulge));
    raise(most, bound - (last - bulge));
    store(most, pairs.beyond.data() + i);
    raise(any, most);
    not_finite += 0.0 * (ahead + bulge);
  }
  template <class L>
  [[gnu::always_inline]] static double run(Pairs* pairs, const double* z, const double* v,
                                           const double* beyond_cubic, double most_bulge) {
    L any{}, not_finite{};
    for (std::size_t i = 0; i < pairs->first.size(); i += kLanes)
      if (pairs->in_a_row[i / kLanes] != 0)
        some<true>(*pairs, i, z, v, beyond_cubic, most_bulge, any, not_finite);
      else
        some<false>(*pairs, i, z, v, beyond_cubic, most_bulge, any, not_finite);
    return largest_of(any) + sum_of(not_finite);
  }
};

/// may_pass() of any channel of two entries. If none may, their values and rates at the step's end are kept.
bool Peaks::pairs_may_pass(const EvaluatedState& from, const EvaluatedState& to, const double* beyond_cubic) {
  const auto count = static_cast<int>(pairs_.channel.size());
  const double h = to.state.t - from.state.t;
  if (!last_rates_)
    for (int i = 0; i < count; ++i) pairs_.last_rate[idx(i)] = pairs_.sum(i, from.state.v.data());
  if (run_widest<Pairs::Beyond>(&pairs_, to.state.z.data(), to.state.v.data(), beyond_cubic,
                                kMostBulge * h) <= 0.0)
    return false;
  for (std::size_t i = 0; i < pairs_.channel.size(); ++i) {
    if (pairs_.beyond[i] <= 0.0) continue;
    const double beyond = std::abs(pairs_.coeff_1[i]) * beyond_cubic[pairs_.first[i]] +
                          std::abs(pairs_.coeff_2[i]) * beyond_cubic[pairs_.second[i]];
    const Interval reach =
        cubic_reach(pairs_.last[i], pairs_.last_rate[i], pairs_.ahead[i], pairs_.ahead_rate[i], h);
    if (within_peaks(pairs_.channel[i], reach.low, reach.high, beyond)) continue;
    if (!can_seek(pairs_.channel[i], pairs_.last_rate[i] * pairs_.ahead_rate[i] < 0.0)) return true;
  }
  return false;
}

/// A linear channel that may pass its peaks, whose motion in the step at hand tells that it does not, or where it turns; opposite:
/// its rates at both ends are. False: points inside have to tell.
bool Peaks::can_seek(std::size_t c, bool opposite) {
  const auto range = motion_->range(channels_[c].z_row(), channels_[c].v_row());
  if (!range) return false;
  if (within_peaks(c, range->low, range->high, range->error)) return true;
  // What is left open of the motion may hide a turn of that height.
  if (range->turns != (opposite ? 1 : 0) || range->error > kRangeError * (peaks_[c].max - peaks_[c].min))
    return false;
  sought_.push_back({c, opposite ? range : std::nullopt});
  return true;
}

/// The peak of a channel at the end of the step at hand, and about its turn inside.
void Peaks::seek(const Sought& sought) {
  const std::size_t c = sought.channel;
  Peak& p = peaks_[c];
  p.note(last(c), ahead_t_);
  if (sought.turn) {
    // By Newton's rule, whose slope is that of the rates where kinks bend the motion.
    const double length = ahead_t_ - begin_t_;
    double bend = sought.turn->bend / (length * length);
    PeakSample at = look_at(c, begin_t_ + sought.turn->turn * length);
    for (int i = 0; i < kMostLooks; ++i) {
      p.note(at.y, at.t);
      const double rate = at.rate.value_or(0.0), t = std::clamp(at.t - rate / bend, begin_t_, ahead_t_);
      if (!(std::abs(rate * (t - at.t)) > kLeastGain * (p.max - p.min))) break;
      const PeakSample closer = look_at(c, t);
      bend = (closer.rate.value_or(0.0) - rate) / (closer.t - at.t);
      at = closer;
    }
  }
  set_bounds(c);
}

bool Peaks::looks_inside(const EvaluatedState& from, const EvaluatedState& to, const double* beyond_cubic) {
  passed_over_ = false;
  if (!inside_steps_) return false;
  sought_.clear();
  for (const std::size_t c : others_)
    if (may_pass(c, from, to, beyond_cubic)) return true;
  if (pairs_may_pass(from, to, beyond_cubic)) return true;
  passed_over_ = true;
  begin_t_ = from.state.t;
  ahead_t_ = to.state.t;
  return false;
}

void Peaks::start(const Assembler& assembler, const EvaluatedState& point) {
  find_rows(assembler.system());
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double y = value(c, assembler, point);
    peaks_[c] = {{y, point.state.t, y, point.state.t}};
    last(c) = y;
    set_bounds(c);
  }
  passed_over_ = last_rates_ = false;
}

void Peaks::restart(const Assembler& assembler, const EvaluatedState& point) {
  passed_over_ = last_rates_ = false;
  for (const std::size_t c : others_) {  // angles do not jump
    last(c) = value(c, assembler, point);
    peaks_[c].note(last(c), point.state.t);
    set_bounds(c);
  }
}

void Peaks::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  const double length = to.state.t - from.state.t;
  longest_ = std::max(longest_, length);
  if (passed_over_ && to.state.t < ahead_t_) return;
  last_rates_ = passed_over_;
  if (passed_over_) {
    pairs_.last.swap(pairs_.ahead);
    pairs_.last_rate.swap(pairs_.ahead_rate);
    for (const std::size_t c : others_) {
      const double y = last(c) = end_value(c, assembler, to);
      // A force may jump at the step's end.
      if (within_peaks(c, y, y, 0.0)) continue;
      peaks_[c].note(y, to.state.t);
      set_bounds(c);
    }
    for (const Sought& sought : sought_) seek(sought);
    passed_over_ = false;
    return;
  }
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const Watched& w = watched_[c];
    const double y = value(c, assembler, to), before = last(c);
    const double higher = std::max(y, before), lower = std::min(y, before);
    last(c) = y;
    if (higher <= w.high && lower >= w.low) continue;
    Peak& p = peaks_[c];
    p.note(y, to.state.t);
    const double near = kNear * (p.max - p.min);
    if (inside_steps_ && length > kShort * longest_ && (higher > p.max - near || lower < p.min + near))
      look_inside(c, assembler, from, to, before, y);
    set_bounds(c);
  }
}

void Peaks::set_bounds(std::size_t c) {
  const Peak& p = peaks_[c];
  const double near = inside_steps_ ? kNear * (p.max - p.min) : 0.0;
  watched_[c].low = p.min + near;
  watched_[c].high = p.max - near;
  if (const int pair = watched_[c].pair; pair >= 0) {
    pairs_.max[idx(pair)] = p.max;
    pairs_.min[idx(pair)] = p.min;
  }
}

bool Peaks::needs_acceleration() const {
  return std::any_of(channels_.begin(), channels_.end(), [this](const Channel& c) {
    return c.value_needs_acceleration() || (inside_steps_ && c.rate_needs_acceleration());
  });
}

PeakSample Peaks::look_at(std::size_t c, double t) {
  const StepMotion::Point inside = motion_->at(t);
  return {t, value(c, inside.assembler, inside.at), rate(c, inside.assembler, inside.at)};
}

void Peaks::look_inside(std::size_t c, const Assembler& assembler, const EvaluatedState& from,
                        const EvaluatedState& to, double y_0, double y_1) {
  Peak& p = peaks_[c];
  const PeakSample a{from.state.t, y_0, rate(c, assembler, from)};
  const PeakSample b{to.state.t, y_1, rate(c, assembler, to)};
  if (motion_)
    return search_peak(
        a, b, [&](double t) { return look_at(c, t); }, p.max - p.min, p);
  // Shown by a caller that has no motion: the cubic itself.
  if (!a.rate || !b.rate) return;
  const double h = b.t - a.t;
  if (const auto inside = cubic_peak(a.y, *a.rate, b.y, *b.rate, h))
    p.note(inside->value, a.t + inside->s * h);
}

std::size_t Peaks::largest() const {
  std::size_t best = 0;
  for (std::size_t c = 1; c < peaks_.size(); ++c)
    if (peaks_[c].amplitude() > peaks_[best].amplitude()) best = c;
  return best;
}

}  // namespace drev
