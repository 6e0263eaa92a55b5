#include "app/report/report_history.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace drev::app {

namespace {

constexpr std::size_t kPlaces = 200000, kMostPlaces = 1 << 15;  // two floats each: 2 MB in the page
constexpr std::size_t kTail = 4000000, kMostTail = 1 << 17;
constexpr double kSameTime = 1e-9;  // difference of equal times relative to the interval [-]

/// Part of a step from x0 to x1 (linear) above the edge [-].
double share_above(double x0, double x1, double edge) {
  if (x0 == x1) return x0 > edge ? 1.0 : 0.0;
  const double low = std::min(x0, x1), high = std::max(x0, x1);
  return std::clamp((high - edge) / (high - low), 0.0, 1.0);
}

std::size_t even(std::size_t n) { return n - n % 2; }

}  // namespace

ReportHistory::ReportHistory(const System& system, const std::vector<std::string>& channels, double every)
    : channels_(find_channels(system, channels, OverRun::taken)), every_(every) {
  for (const Channel& channel : channels_.channels())
    series_.push_back({channel.name(), channel.unit(), {}, {}, {}});
  for (const char* name : {"kinetic", "stored"}) series_.push_back({name, "J", {}, {}, {}});
  places_ = even(std::clamp<std::size_t>(kPlaces / series_.size(), 512, kMostPlaces));
  tail_places_ = std::clamp<std::size_t>(kTail / series_.size(), 1024, kMostTail);
  for (const std::string& name : system.floating_parts(Contact::closed))
    if (const int node = system.node(name); drifting_ < 0 && system.ratio(node) != 0.0) {
      drifting_ = node;
      drifting_ratio_ = system.ratio(node);
    }
  for (std::size_t j = 0; j < system.scalars().size(); ++j)
    if (const auto gap = system.scalars()[j].force->gap()) {
      terms_.push_back(j);
      gaps_.push_back(*gap);
      bands_.push_back({system.element_instances()[idx(index(system.scalars()[j].element))].name, {}, {}});
    }
}

void ReportHistory::start(const Assembler& assembler, const EvaluatedState& point) {
  start_ = point.state.t;
  channels_.start(assembler, point);
  sample(assembler, point);
}

void ReportHistory::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  const double h = to.state.t - from.state.t;
  channels_.step(assembler, from, to);
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const double x0 = from.inputs[terms_[i]].x, x1 = to.inputs[terms_[i]].x;
    bands_[i].front.back() += static_cast<float>(h * share_above(x0, x1, gaps_[i].high));
    bands_[i].back.back() += static_cast<float>(h * share_above(-x0, -x1, -gaps_[i].low));
  }
  end_ = to.state.t;
  if (every_ == 0.0 || to.state.t >= next_stop(0.0) - kSameTime * every_) sample(assembler, to);
}

double ReportHistory::next_stop(double /*t*/) const {
  if (every_ == 0.0) return std::numeric_limits<double>::infinity();
  return start_ + static_cast<double>(samples_) * every_;
}

void ReportHistory::sample(const Assembler& assembler, const EvaluatedState& point) {
  const State& state = point.state;
  if (in_group_ == 0) open_group(state.t);
  const bool full = tail_times_.size() == tail_places_;
  const std::size_t place = full ? oldest_ : tail_times_.size();
  if (!full) {
    tail_times_.push_back(0.0);
    angle_.push_back(0.0);
    for (Series& series : series_) series.tail.push_back(0.0);
  }
  tail_times_[place] = state.t;
  angle_[place] = assembler.nominal().value;
  if (drifting_ >= 0) angle_[place] += assembler.node_motion(drifting_, state).value / drifting_ratio_;
  for (std::size_t s = 0; s < series_.size(); ++s) {
    double value = 0.0;
    if (s < channel_count()) {
      value = channels_.value(s, assembler, point);
    } else if (s == channel_count()) {
      assembler.multiply_mass(state.v, product_);
      value = 0.5 * state.v.dot(product_);
    } else {
      value = 0.5 * state.z.dot(point.kz) + point.general_energy;
      for (const ScalarResponse& r : point.responses) value += r.stored_energy;
    }
    Series& series = series_[s];
    series.tail[place] = value;
    const auto single = static_cast<float>(value);
    series.low.back() = std::min(series.low.back(), single);
    series.high.back() = std::max(series.high.back(), single);
  }
  if (full) oldest_ = (oldest_ + 1) % tail_places_;
  end_ = state.t;
  ++samples_;
  if (++in_group_ == group_) in_group_ = 0;
}

double ReportHistory::mean_speed(double from) const {
  double turned = 0.0, time = 0.0;
  const double length = end_ - from;
  for (std::size_t i = 1; i < tail_size(); ++i) {
    const double t0 = tail_time(i - 1), t1 = tail_time(i);
    if (t0 < from) continue;
    const double weight = std::pow(std::sin(0.5 * kTwoPi * (0.5 * (t0 + t1) - from) / length), 2);
    turned += weight * (angle_[tail_place(i)] - angle_[tail_place(i - 1)]);
    time += weight * (t1 - t0);
  }
  return time > 0.0 ? std::abs(turned / time) : 0.0;
}

void ReportHistory::open_group(double t) {
  if (times_.size() == places_) join_neighbours();
  times_.push_back(t);
  for (Series& series : series_) {
    series.low.push_back(std::numeric_limits<float>::infinity());
    series.high.push_back(-std::numeric_limits<float>::infinity());
  }
  for (Band& band : bands_) {
    band.front.push_back(0.0F);
    band.back.push_back(0.0F);
  }
}

void ReportHistory::join_neighbours() {
  const std::size_t half = times_.size() / 2;
  const auto join = [half](auto& values, auto both) {
    for (std::size_t i = 0; i < half; ++i) values[i] = both(values[2 * i], values[2 * i + 1]);
    values.resize(half);
  };
  join(times_, [](double a, double) { return a; });
  for (Series& series : series_) {
    join(series.low, [](float a, float b) { return std::min(a, b); });
    join(series.high, [](float a, float b) { return std::max(a, b); });
  }
  for (Band& band : bands_) {
    join(band.front, [](float a, float b) { return a + b; });
    join(band.back, [](float a, float b) { return a + b; });
  }
  group_ *= 2;
}

}  // namespace drev::app
