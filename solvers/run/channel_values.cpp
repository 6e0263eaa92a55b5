#include <drev/core/assembler.hpp>
#include <drev/solvers/run/channel_values.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace drev {

namespace {

constexpr int kMostHalvings = 12;
// Part of the train's energy at the start that counts as summed up already: less is rounding of the powers [-].
constexpr double kLeast = 1e-9;

constexpr std::size_t kRules = 3;
/// A point >= 0 of the rules of 3, 7 and 15 points on [-1, 1], and its weight in each; 0: it is none of that rule's.
struct RulePoint {
  double at;
  std::array<double, kRules> weight;
};
constexpr std::array<RulePoint, 8> kPoints{{
    {0.0, {8.0 / 9.0, 0.450916538658474142345110087046, 0.225510499798206687386422549155}},
    {0.774596669241483377035853079956,
     {5.0 / 9.0, 0.268488089868333440728569280667, 0.134415255243784220359968764802}},
    {0.434243749346802558002071502844,
     {0.0, 0.401397414775962222905051818618, 0.200628529376989021033931873331}},
    {0.960491268708020283423507092629,
     {0.0, 0.104656226026467265193823857192, 0.0516032829970797396969201205678}},
    {0.223386686428966881628203986843, {0.0, 0.0, 0.219156858401587496403693161643}},
    {0.621102946737226402940687443816, {0.0, 0.0, 0.171511909136391380787353165019}},
    {0.888459232872256998890420167258, {0.0, 0.0, 0.0929271953151245376858942226541}},
    {0.993831963212755022208512841307, {0.0, 0.0, 0.0170017196299402603390274174026}},
}};
constexpr std::array<std::size_t, kRules> kEnds{2, 4,
                                                8};  // points >= 0 of each rule: the first ones of the table

/// Kinetic and stored energy of the train at a point [J].
double energy_at(const Assembler& assembler, const EvaluatedState& point) {
  double sum = 0.0;
  for (const Channel& c : energy_channels(assembler.system()))
    if (c.name().ends_with(".kinetic_J") || c.name().ends_with(".stored_J"))
      sum += std::abs(c.evaluate(assembler, point.state));
  return sum;
}

}  // namespace

ChannelValues::ChannelValues(std::vector<Channel> channels)
    : channels_(std::move(channels)), place_(channels_.size(), -1) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (!channels_[c].over_run()) continue;
    place_[c] = static_cast<int>(integrals_.size());
    integrals_.push_back(c);
  }
  sums_.resize(integrals_.size());
  sizes_.resize(integrals_.size());
}

std::vector<double> ChannelValues::integrands(const Assembler& assembler, const EvaluatedState& point) const {
  std::vector<double> values;
  for (const std::size_t c : integrals_) values.push_back(channels_[c].integrand(assembler, point.state));
  return values;
}

void ChannelValues::start(const Assembler& assembler, const EvaluatedState& point) {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  std::fill(sizes_.begin(), sizes_.end(), integrals_.empty() ? 0.0 : kLeast * energy_at(assembler, point));
  restart(assembler, point);
}

void ChannelValues::restart(const Assembler& assembler, const EvaluatedState& point) {
  if (!integrals_.empty() && !motion_) last_ = integrands(assembler, point);
}

void ChannelValues::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  if (integrals_.empty()) return;
  const double h = to.state.t - from.state.t;
  if (motion_) {
    if (h > 0.0) add(from.state.t, to.state.t, kMostHalvings);
    return;
  }
  const std::vector<double> before = std::move(last_);
  last_ = integrands(assembler, to);
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += 0.5 * h * (before[i] + last_[i]);
}

void ChannelValues::add(double t_0, double t_1, int depth) {
  const double half = 0.5 * (t_1 - t_0), middle = 0.5 * (t_0 + t_1);
  std::array<std::vector<double>, kRules> sum, size;  // of each rule: integrals, and those without signs
  for (auto* of : {&sum, &size})
    for (std::vector<double>& values : *of) values.assign(sums_.size(), 0.0);
  const auto look = [&](double t, const RulePoint& point) {
    const StepMotion::Point inside = motion_->at(t);
    const std::vector<double> y = integrands(inside.assembler, inside.at);
    for (std::size_t r = 0; r < kRules; ++r)
      for (std::size_t i = 0; i < y.size(); ++i) {
        sum[r][i] += half * point.weight[r] * y[i];
        size[r][i] += half * point.weight[r] * std::abs(y[i]);
      }
  };
  // The difference d of two rules is the error of the first; that of the second is less than (200 d)^1.5 (QUADPACK).
  static const double most = std::pow(kTolerance, 2.0 / 3.0) / 200.0;
  const auto settled = [&](std::size_t r) {
    for (std::size_t i = 0; i < sums_.size(); ++i)
      if (std::abs(sum[r][i] - sum[r - 1][i]) > most * (sizes_[i] + size[r][i])) return false;
    return true;
  };
  std::size_t rule = 0;
  for (std::size_t point = 0; rule < kRules; ++rule) {
    for (; point < kEnds[rule]; ++point) {
      look(middle - half * kPoints[point].at, kPoints[point]);
      if (kPoints[point].at > 0.0) look(middle + half * kPoints[point].at, kPoints[point]);
    }
    if (rule > 0 && settled(rule)) break;
  }
  if (rule == kRules && depth > 0 && middle > t_0 && middle < t_1) {
    add(t_0, middle, depth - 1);
    add(middle, t_1, depth - 1);
    return;
  }
  const std::size_t used = std::min<std::size_t>(rule, kRules - 1);
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sums_[i] += sum[used][i];
    sizes_[i] += size[used][i];
  }
}

double ChannelValues::value(std::size_t c, const Assembler& assembler, const EvaluatedState& point) const {
  return place_[c] >= 0 ? sums_[static_cast<std::size_t>(place_[c])]
                        : channels_[c].evaluate(assembler, point.state);
}

bool ChannelValues::needs_acceleration() const {
  return std::any_of(channels_.begin(), channels_.end(),
                     [](const Channel& c) { return c.value_needs_acceleration(); });
}

bool ChannelValues::watches_loads() const {
  return std::any_of(integrals_.begin(), integrals_.end(),
                     [this](std::size_t c) { return channels_[c].follows_loads(); });
}

}  // namespace drev
