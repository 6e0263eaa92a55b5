#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/strength/rainflow.hpp>

#include <algorithm>
#include <cmath>

#include "solvers/run/peak_search.hpp"

namespace drev {

void RainflowCounter::add(double value) {
  const std::size_t n = points_.size();
  if (n > 0 && value == points_.back()) return;
  if (n > 1 && (points_[n - 1] > points_[n - 2]) == (value > points_[n - 1])) {
    points_.back() = value;  // the signal continues in the same direction
    count_closed();
    return;
  }
  points_.push_back(value);
  count_closed();
}

void RainflowCounter::count_closed() {
  while (points_.size() >= 3) {
    const std::size_t n = points_.size();
    const double x = std::abs(points_[n - 1] - points_[n - 2]), y = std::abs(points_[n - 2] - points_[n - 3]);
    if (x < y) return;
    const double mean = 0.5 * (points_[n - 2] + points_[n - 3]);
    if (n == 3) {  // Y contains the starting point
      take_({y, mean, 0.5});
      points_.erase(points_.begin());
    } else {
      take_({y, mean, 1.0});
      points_.erase(points_.end() - 3, points_.end() - 1);
    }
  }
}

void RainflowCounter::finish() {
  for (std::size_t i = 1; i < points_.size(); ++i)
    take_({std::abs(points_[i] - points_[i - 1]), 0.5 * (points_[i] + points_[i - 1]), 0.5});
  points_.clear();
}

std::vector<RainflowCycle> count_rainflow(std::span<const double> signal) {
  std::vector<RainflowCycle> cycles;
  RainflowCounter counter([&](const RainflowCycle& cycle) { cycles.push_back(cycle); });
  for (std::size_t i = 0; i < signal.size(); ++i) {
    if (!std::isfinite(signal[i]))
      throw ModelError({{"rainflow count", "signal", to_text(signal[i]), "",
                         "must be finite; value number " + std::to_string(i + 1) + " is not"}});
    counter.add(signal[i]);
  }
  counter.finish();
  return cycles;
}

double damage_of(double range, const SnLine& line) {
  return std::pow(range / line.reference, line.slope) / line.cycles;
}

double miner_sum(std::span<const RainflowCycle> cycles, const SnLine& line) {
  double sum = 0.0;
  for (const RainflowCycle& cycle : cycles) sum += cycle.count * damage_of(cycle.range, line);
  return sum;
}

void RainflowHistogram::add(const RainflowCycle& cycle) {
  constexpr double kAnOctave = 8.0;
  if (!(cycle.range > 0.0)) return;
  Class& c = classes_[static_cast<int>(std::floor(kAnOctave * std::log2(cycle.range)))];
  c.count += cycle.count;
  c.sum += cycle.count * cycle.range;
  c.largest = std::max(c.largest, cycle.range);
  size_ = std::max(size_, std::abs(cycle.mean) + 0.5 * cycle.range);
}

std::vector<RainflowHistogram::Class> RainflowHistogram::classes() const {
  std::vector<Class> list;
  for (const auto& [bin, c] : classes_)
    if (c.largest > kRounding * size_) list.push_back(c);
  return list;
}

double RainflowHistogram::cycles() const {
  double sum = 0.0;
  for (const Class& c : classes()) sum += c.count;
  return sum;
}

double RainflowHistogram::largest() const {
  const std::vector<Class> all = classes();
  return all.empty() ? 0.0 : all.back().largest;
}

RainflowWatch::RainflowWatch(std::vector<RainflowChannel> channels) : last_(channels.size()) {
  for (RainflowChannel& channel : channels) results_.push_back({std::move(channel), {}, 0.0});
  for (Result& result : results_)
    counters_.emplace_back([&result](const RainflowCycle& cycle) {
      result.histogram.add(cycle);
      if (result.of.line.given())
        result.damage += cycle.count * damage_of(cycle.range * result.of.stress_per_unit, result.of.line);
    });
}

bool RainflowWatch::fits(const System& system) const {
  return std::all_of(results_.begin(), results_.end(),
                     [&](const Result& r) { return r.of.channel.is_of(system); });
}

void RainflowWatch::start(const Assembler& assembler, const EvaluatedState& point) {
  for (std::size_t c = 0; c < results_.size(); ++c) {
    last_[c] = results_[c].of.channel.evaluate(assembler, point.state);
    counters_[c].add(last_[c]);
  }
}

void RainflowWatch::restart(const Assembler& assembler, const EvaluatedState& point) {
  start(assembler, point);
}

void RainflowWatch::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  const bool moved = assembler.system().any_prescribed_moves();
  for (std::size_t c = 0; c < results_.size(); ++c) {
    const Channel& channel = results_[c].of.channel;
    const auto sample = [&](const Assembler& at, const EvaluatedState& point) -> PeakSample {
      return {point.state.t, channel.evaluate(at, point.state),
              channel.is_linear() || !moved ? channel.rate(at, point.state) : std::nullopt};
    };
    PeakSample a = sample(assembler, from);
    const PeakSample b = sample(assembler, to);
    a.y = last_[c];
    Peak inside{{std::max(a.y, b.y), a.y > b.y ? a.t : b.t, std::min(a.y, b.y), a.y < b.y ? a.t : b.t}};
    const double high = inside.max, low = inside.min;
    if (motion_ != nullptr)
      search_peak(
          a, b,
          [&](double t) {
            const StepMotion::Point p = motion_->at(t);
            return sample(p.assembler, p.at);
          },
          0.0, inside);
    const bool higher = inside.max > high, lower = inside.min < low;
    if (higher && lower) {
      const bool max_first = inside.max_time < inside.min_time;
      counters_[c].add(max_first ? inside.max : inside.min);
      counters_[c].add(max_first ? inside.min : inside.max);
    } else if (higher || lower) {
      counters_[c].add(higher ? inside.max : inside.min);
    }
    counters_[c].add(b.y);
    last_[c] = b.y;
  }
}

bool RainflowWatch::needs_acceleration() const {
  return std::any_of(results_.begin(), results_.end(), [](const Result& r) {
    return r.of.channel.value_needs_acceleration() || r.of.channel.rate_needs_acceleration();
  });
}

bool RainflowWatch::watches_loads() const {
  return std::any_of(results_.begin(), results_.end(),
                     [](const Result& r) { return r.of.channel.follows_loads(); });
}

const std::vector<RainflowWatch::Result>& RainflowWatch::finish() {
  for (RainflowCounter& counter : counters_) counter.finish();
  return results_;
}

}  // namespace drev
