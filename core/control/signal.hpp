#pragma once
/// Signals: what a controller or an importer of a model sees of it. A channel (channel.hpp), or
///
///   time_s                                                          time t [s]
///   NODE.actual_angle_rad, NODE.actual_speed_rad_per_s              n phi + q, n phi' + q' of a rotational node
///   NODE.actual_position_m, NODE.actual_velocity_m_per_s            the same of a translational one
#include <drev/core/channel.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev {

class Signal {
 public:
  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }
  /// Value at a state; the assembler must stand at the state's time.
  double evaluate(const Assembler& assembler, const State& state) const;

 private:
  friend std::vector<Signal> find_signals(const System& system, const std::vector<std::string>& names);
  std::string name_, unit_;
  std::optional<Channel> channel_ = {};
  int node_ = -1;  ///< of actual motion; none and no channel: the time
  bool rate_ = false;
};

/// Signals by name. Throws ModelError that lists every unknown name with the nearest known one.
std::vector<Signal> find_signals(const System& system, const std::vector<std::string>& names);

}  // namespace drev
