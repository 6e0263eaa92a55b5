#include <drev/core/assembler.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/order_tracking.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

namespace {
constexpr double kPointsOfPeriod = 16.0;  // of the highest order
constexpr double kSameTime = 1e-6;        // of an interval
}  // namespace

OrderTracking::OrderTracking(const System& system, const std::vector<std::string>& channels,
                             std::vector<double> orders, double turns, bool own_times)
    : channels_(find_channels(system, channels)), width_(turns * kTwoPi), own_times_(own_times) {
  tracks_.orders = std::move(orders);
  for (const Channel& channel : channels_) {
    tracks_.channels.push_back(channel.name());
    tracks_.units.push_back(channel.unit());
  }
  for (const double order : tracks_.orders) highest_ = std::max(highest_, order);
  for (auto* values : {&tracks_.amplitude, &tracks_.phase})
    values->assign(channels_.size(), std::vector<std::vector<double>>(tracks_.orders.size()));
  values_.resize(channels_.size());
  turns_.resize(tracks_.orders.size());
}

void OrderTracking::look(const Assembler& assembler, const EvaluatedState& point) {
  for (std::size_t c = 0; c < channels_.size(); ++c)
    values_[c] = channels_[c].evaluate(assembler, point.state);
  // Orders of even spacing are a rotation each.
  Complex wave = 1.0, rotation = 1.0;
  double before = 0.0, spacing = 0.0;
  for (std::size_t k = 0; k < turns_.size(); ++k) {
    if (tracks_.orders[k] - before != spacing) {
      spacing = tracks_.orders[k] - before;
      rotation = std::polar(1.0, -spacing * turned_);
    }
    turns_[k] = wave = wave * rotation;
    before = tracks_.orders[k];
  }
  const double speed = std::abs(assembler.nominal().rate);
  interval_ = speed > 0.0 && highest_ > 0.0 ? kTwoPi / (kPointsOfPeriod * highest_ * speed) : 0.0;
  time_ = point.state.t;
  angle_ = assembler.nominal().value;
}

void OrderTracking::open(double begin) {
  windows_.push_back({.begin = begin, .sums = std::vector<Complex>(channels_.size() * turns_.size())});
}

void OrderTracking::start(const Assembler& assembler, const EvaluatedState& point) {
  const MotionPoint& phi = assembler.nominal();
  turned_ = phi.rate < 0.0 ? -phi.value : phi.value;
  windows_.clear();
  look(assembler, point);
  open(turned_);
}

void OrderTracking::step(const Assembler& assembler, const EvaluatedState& /*from*/,
                         const EvaluatedState& to) {
  // Points that others asked for would make the spacing uneven, and the trapezoidal rule far worse.
  if (own_times_ && interval_ > 0.0 && to.state.t < next_stop(0.0) - kSameTime * interval_) return;
  const double before = turned_, t_before = time_;
  turned_ += std::abs(assembler.nominal().value - angle_);
  std::swap(values_, last_values_);
  std::swap(turns_, last_turns_);
  values_.resize(channels_.size());
  turns_.resize(tracks_.orders.size());
  look(assembler, to);
  const double dphi = turned_ - before, dt = time_ - t_before;
  if (!(dphi > 0.0)) return;
  while (turned_ >= windows_.back().begin + 0.5 * width_) open(windows_.back().begin + 0.5 * width_);
  for (Window& window : windows_) {
    const auto weight = [&](double turned) {
      const double s = (turned - window.begin) / width_;
      return s > 0.0 && s < 1.0 ? std::pow(std::sin(0.5 * kTwoPi * s), 2) : 0.0;
    };
    const double w0 = weight(before), w1 = weight(turned_);
    window.weights += 0.5 * (w0 + w1) * dphi;
    window.time += 0.5 * (w0 + w1) * dt;
    window.moment += 0.5 * (w0 * t_before + w1 * time_) * dt;
    std::size_t place = 0;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const double f0 = 0.5 * w0 * dphi * last_values_[c], f1 = 0.5 * w1 * dphi * values_[c];
      for (std::size_t k = 0; k < turns_.size(); ++k)
        window.sums[place++] += f0 * last_turns_[k] + f1 * turns_[k];
    }
  }
  while (turned_ >= windows_.front().begin + width_) {
    close(windows_.front());
    windows_.erase(windows_.begin());
  }
}

void OrderTracking::close(const Window& window) {
  if (!(window.weights > 0.0) || !(window.time > 0.0)) return;
  tracks_.time.push_back(window.moment / window.time);
  tracks_.speed.push_back(window.weights / window.time);
  std::size_t place = 0;
  for (std::size_t c = 0; c < channels_.size(); ++c)
    for (std::size_t k = 0; k < turns_.size(); ++k, ++place) {
      tracks_.amplitude[c][k].push_back(2.0 * std::abs(window.sums[place]) / window.weights);
      tracks_.phase[c][k].push_back(std::arg(window.sums[place]));
    }
}

double OrderTracking::next_stop(double /*t*/) const {
  return own_times_ && interval_ > 0.0 ? time_ + interval_ : std::numeric_limits<double>::infinity();
}

bool OrderTracking::needs_acceleration() const {
  return std::any_of(channels_.begin(), channels_.end(),
                     [](const Channel& c) { return c.value_needs_acceleration(); });
}

}  // namespace drev
