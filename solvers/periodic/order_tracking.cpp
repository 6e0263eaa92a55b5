#include <drev/core/assembler.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/order_tracking.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {
constexpr double kPointsOfPeriod = 16.0;  // points in a period of the highest order
constexpr double kSameTime = 1e-6;        // difference of equal times over the interval of points [-]
// Largest relative growth of the interval from one point to the next, and first interval relative to the time
// since the start [-].
constexpr double kGrowth = 0.1;
constexpr std::size_t kMean = 1, kParabola = 3;  // terms of a fit over time
}  // namespace

OrderTracking::OrderTracking(const System& system, const std::vector<std::string>& channels,
                             std::vector<double> orders, double turns, bool own_times,
                             const std::string& shaft)
    : channels_(find_channels(system, channels)),
      width_(turns * kTwoPi),
      spacing_(0.5 * width_),
      own_times_(own_times),
      node_(shaft.empty() ? -1 : system.node(shaft)) {
  tracks_.shaft = shaft;
  const bool free = node_ >= 0 || !system.floating_parts(Contact::closed).empty();
  tracks_.orders = std::move(orders);
  for (const Channel& channel : channels_) {
    tracks_.channels.push_back(channel.name());
    tracks_.units.push_back(channel.unit());
    const bool grows = free && (channel.unit() == "rad" || channel.unit() == "rad/s");
    terms_of_.push_back(grows ? kParabola : kMean);
    most_terms_ = std::max(most_terms_, terms_of_.back());
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
  // Evenly spaced orders follow from each other by one rotation.
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
  const auto [angle, rate] = turning(assembler, point);
  const double speed = std::abs(rate), last = interval_;
  time_ = point.state.t;
  angle_ = angle;
  interval_ = speed > 0.0 && highest_ > 0.0 ? kTwoPi / (kPointsOfPeriod * highest_ * speed) : 0.0;
  // At rest, or where an oscillation stops the shaft for a moment, the speed does not predict the next
  // points.
  if (time_ > first_time_ && (interval_ > 0.0 || last > 0.0)) {
    const double longest = last > 0.0 ? (1.0 + kGrowth) * last : kGrowth * (time_ - first_time_);
    interval_ = interval_ > 0.0 ? std::min(interval_, longest) : longest;
  }
}

std::pair<double, double> OrderTracking::turning(const Assembler& assembler,
                                                 const EvaluatedState& point) const {
  const MotionPoint& phi = assembler.nominal();
  if (node_ < 0) return {phi.value, phi.rate};
  const double ratio = assembler.system().ratio(node_);
  const MotionPoint own = assembler.node_motion(node_, point.state);
  return {ratio * phi.value + own.value, ratio * phi.rate + own.rate};
}

/// Whether the sense of the actual angle is known; starts the first window when it becomes known.
bool OrderTracking::has_begun(double angle) {
  if (sense_ != 0.0) return true;
  if (std::abs(angle - first_angle_) < kBegun * kTwoPi) return false;
  sense_ = angle > first_angle_ ? 1.0 : -1.0;
  return false;
}

/// Whether the nominal speed has another sign than it had when it was last not zero.
bool OrderTracking::reverses_to(double rate) {
  if (rate == 0.0) return false;
  const double before = std::exchange(way_, rate < 0.0 ? -1.0 : 1.0);
  return before * way_ < 0.0;
}

void OrderTracking::open(double begin) {
  next_ = begin + spacing_;
  windows_.push_back({.begin = begin,
                      .sums = std::vector<Complex>(channels_.size() * turns_.size()),
                      .t_0 = time_,
                      .trends = std::vector<std::array<double, kParabola>>(channels_.size()),
                      .waves = std::vector<std::array<Complex, kParabola>>(turns_.size()),
                      .twice = std::vector<Complex>(turns_.size())});
}

void OrderTracking::start(const Assembler& assembler, const EvaluatedState& point) {
  const auto [angle, rate] = turning(assembler, point);
  sense_ = rate < 0.0 ? -1.0 : rate > 0.0 || node_ < 0 ? 1.0 : 0.0;
  turned_ = sense_ * angle;
  tracks_.first_speed = rate;
  first_angle_ = angle;
  first_time_ = point.state.t;
  way_ = 0.0;
  reverses_to(rate);
  interval_ = 0.0;
  windows_.clear();
  look(assembler, point);
  if (sense_ != 0.0) open(turned_);
}

void OrderTracking::step(const Assembler& assembler, const EvaluatedState& /*from*/,
                         const EvaluatedState& to) {
  // Points that other observers requested would make the spacing uneven and the trapezoidal rule far less
  // accurate.
  if (own_times_ && interval_ > 0.0 && to.state.t < next_stop(0.0) - kSameTime * interval_) return;
  const double before = turned_, t_before = time_, angle = turning(assembler, to).first;
  if (!has_begun(angle)) {
    turned_ = sense_ * angle;
    look(assembler, to);
    if (sense_ != 0.0) open(turned_);
    return;
  }
  const bool reverses = node_ < 0 && reverses_to(assembler.nominal().rate);
  // For a nominal angle the sense at the start need not be known.
  turned_ += node_ < 0 ? std::abs(angle - angle_) : sense_ * (angle - angle_);
  std::swap(values_, last_values_);
  std::swap(turns_, last_turns_);
  values_.resize(channels_.size());
  turns_.resize(tracks_.orders.size());
  look(assembler, to);
  const double dphi = turned_ - before, dt = time_ - t_before;
  if (dphi == 0.0 && dt == 0.0) return;
  while (turned_ >= next_) open(next_);
  for (Window& window : windows_) {
    window.reverses = window.reverses || reverses;
    const auto weight = [&](double turned) {
      const double s = (turned - window.begin) / width_;
      return s > 0.0 && s < 1.0 ? std::pow(std::sin(0.5 * kTwoPi * s), 2) : 0.0;
    };
    const double w0 = weight(before), w1 = weight(turned_);
    window.time += 0.5 * (w0 + w1) * dt;
    window.moment += 0.5 * (w0 * t_before + w1 * time_) * dt;
    std::size_t place = 0;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const double f0 = 0.5 * w0 * dphi * last_values_[c], f1 = 0.5 * w1 * dphi * values_[c];
      for (std::size_t k = 0; k < turns_.size(); ++k)
        window.sums[place++] += f0 * last_turns_[k] + f1 * turns_[k];
    }
    add_trends(window, w0, w1, t_before, dphi);
  }
  while (!windows_.empty() && turned_ >= windows_.front().begin + width_) {
    close(windows_.front());
    windows_.erase(windows_.begin());
  }
}

void OrderTracking::add_trends(Window& window, double w0, double w1, double t_before, double dphi) {
  double f0 = 0.5 * w0 * dphi, f1 = 0.5 * w1 * dphi;
  for (std::size_t k = 0; k < turns_.size(); ++k)
    window.twice[k] += f0 * last_turns_[k] * last_turns_[k] + f1 * turns_[k] * turns_[k];
  const double t_0 = t_before - window.t_0, t_1 = time_ - window.t_0;
  for (std::size_t power = 0; power < 2 * most_terms_ - 1; ++power, f0 *= t_0, f1 *= t_1) {
    window.moments[power] += f0 + f1;
    if (power >= most_terms_) continue;
    for (std::size_t c = 0; c < channels_.size(); ++c)
      if (power < terms_of_[c]) window.trends[c][power] += f0 * last_values_[c] + f1 * values_[c];
    for (std::size_t k = 0; k < turns_.size(); ++k)
      window.waves[k][power] += f0 * last_turns_[k] + f1 * turns_[k];
  }
}

/// Least-squares fit of one order beside so many powers of the time, in the channels that have so many: A exp(i p) of
/// A cos(o phi + p).
void OrderTracking::fit(const Window& window, std::size_t order, std::size_t terms) {
  std::vector<std::size_t> fitted;
  for (std::size_t c = 0; c < channels_.size(); ++c)
    if (terms_of_[c] == terms) fitted.push_back(c);
  if (fitted.empty()) return;
  const auto cosine = static_cast<Eigen::Index>(terms), sine = cosine + 1;
  Eigen::MatrixXd normal(sine + 1, sine + 1);  // its lower triangle
  Eigen::MatrixXd right(sine + 1, static_cast<Eigen::Index>(fitted.size()));
  for (std::size_t i = 0; i < terms; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j <= i; ++j) normal(row, static_cast<Eigen::Index>(j)) = window.moments[i + j];
    normal(cosine, row) = window.waves[order][i].real();
    normal(sine, row) = -window.waves[order][i].imag();
  }
  normal(cosine, cosine) = 0.5 * (window.moments[0] + window.twice[order].real());
  normal(sine, sine) = 0.5 * (window.moments[0] - window.twice[order].real());
  normal(sine, cosine) = -0.5 * window.twice[order].imag();
  for (Eigen::Index n = 0; n < right.cols(); ++n) {
    const std::size_t c = fitted[static_cast<std::size_t>(n)];
    for (std::size_t i = 0; i < terms; ++i) right(static_cast<Eigen::Index>(i), n) = window.trends[c][i];
    const Complex sum = window.sums[c * turns_.size() + order];
    right(cosine, n) = sum.real();
    right(sine, n) = -sum.imag();
  }
  const Eigen::MatrixXd found = ldlt_solve(normal, right);
  for (Eigen::Index n = 0; n < right.cols(); ++n) {
    const Complex wave(found(cosine, n), -found(sine, n));
    const std::size_t c = fitted[static_cast<std::size_t>(n)];
    tracks_.amplitude[c][order].push_back(std::abs(wave));
    tracks_.phase[c][order].push_back(std::arg(wave));
  }
}

void OrderTracking::close(const Window& window) {
  const double weights = window.moments[0];
  if (window.reverses || !(weights > 0.0) || !(window.time > 0.0)) return;
  tracks_.time.push_back(window.moment / window.time);
  tracks_.speed.push_back((node_ < 0 ? way_ : sense_) * weights / window.time);
  for (std::size_t k = 0; k < turns_.size(); ++k)
    for (const std::size_t terms : {kMean, kParabola}) fit(window, k, terms);
  if (tracks_.time.size() > kMostWindows) thin();
}

/// Drops every second window if there are too many.
void OrderTracking::thin() {
  spacing_ *= 2.0;
  const auto halve = [](std::vector<double>& values) {
    for (std::size_t i = 0; 2 * i < values.size(); ++i) values[i] = values[2 * i];
    values.resize((values.size() + 1) / 2);
  };
  halve(tracks_.time);
  halve(tracks_.speed);
  for (auto* of : {&tracks_.amplitude, &tracks_.phase})
    for (auto& channel : *of)
      for (auto& order : channel) halve(order);
}

double OrderTracking::next_stop(double /*t*/) const {
  return own_times_ && interval_ > 0.0 ? time_ + interval_ : std::numeric_limits<double>::infinity();
}

bool OrderTracking::needs_acceleration() const {
  return std::any_of(channels_.begin(), channels_.end(),
                     [](const Channel& c) { return c.value_needs_acceleration(); });
}

}  // namespace drev
