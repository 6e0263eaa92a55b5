#include "core/control/signal.hpp"

#include <drev/core/assembler.hpp>

#include <algorithm>

namespace drev {

namespace {

constexpr const char* kTime = "time_s";
constexpr const char* kRates[] = {".actual_speed_rad_per_s", ".actual_velocity_m_per_s"};
constexpr const char* kValues[] = {".actual_angle_rad", ".actual_position_m"};

}  // namespace

double Signal::evaluate(const Assembler& assembler, const State& state) const {
  if (channel_) return channel_->evaluate(assembler, state);
  if (node_ < 0) return state.t;
  const MotionPoint q = assembler.node_motion(node_, state);
  const double n = assembler.system().ratio(node_);
  const MotionPoint& phi = assembler.nominal();
  return rate_ ? q.rate + n * phi.rate : q.value + n * phi.value;
}

std::vector<Signal> find_signals(const System& system, const std::vector<std::string>& names) {
  const std::vector<std::string>& nodes = system.node_names();
  std::vector<Signal> found(names.size());
  std::vector<std::string> channels;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Signal& signal = found[i];
    signal.name_ = names[i];
    if (names[i] == kTime) {
      signal.unit_ = "s";
      continue;
    }
    for (const bool rate : {false, true})
      for (const bool turns : {true, false}) {
        const std::string end = (rate ? kRates : kValues)[turns ? 0 : 1];
        if (!names[i].ends_with(end)) continue;
        const auto node =
            std::find(nodes.begin(), nodes.end(), names[i].substr(0, names[i].size() - end.size()));
        const auto place = static_cast<int>(node - nodes.begin());
        if (node == nodes.end() || (system.node_kind(place) == NodeKind::rotational) != turns) continue;
        signal.node_ = place;
        signal.rate_ = rate;
        signal.unit_ = rate ? (turns ? "rad/s" : "m/s") : (turns ? "rad" : "m");
      }
    if (signal.node_ < 0) channels.push_back(names[i]);
  }
  std::vector<Channel> all = find_channels(system, channels);
  auto next = all.begin();
  for (Signal& signal : found) {
    if (signal.node_ >= 0 || signal.name_ == kTime) continue;
    signal.unit_ = next->unit();
    signal.channel_ = std::move(*next++);
  }
  return found;
}

}  // namespace drev
