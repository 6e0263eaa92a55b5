#pragma once
/// Results as named channels with units. Names:
///
///   NODE.angle_rad, NODE.speed_rad_per_s, NODE.acceleration_rad_per_s2      deviation from nominal motion
///   NODE.position_m, NODE.velocity_m_per_s, NODE.acceleration_m_per_s2      translational nodes
///   NODE_A-NODE_B.twist_rad (.distance_m)                                   q_A - q_B
///   NODE.reaction_Nm (.reaction_N)                                          prescribed nodes
///   ELEMENT.torque_Nm, ELEMENT.force_N                                      force the element carries
///   ELEMENT.slip_speed_rad_per_s (_m_per_s), ELEMENT.state, ELEMENT.heat_J    dry friction (friction.hpp)
///   ELEMENT.deflection_m (_rad)                                             x of a scalar element
///
/// Signs: a shaft's or spring's torque is k (q_b - q_a) + c (q_b' - q_a'), Rayleigh damping not included; a
/// mesh's force is positive on the front flank (x > 0); a load's torque is as it enters the right-hand side;
/// an ideal gear's torque is the one it applies to its second node; a reaction is the torque that must be
/// applied to the prescribed node to make it move as given.
#include <drev/core/state.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev {

class Assembler;

class Channel {
 public:
  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }
  /// Value at a state; the assembler must stand at the state's time.
  double evaluate(const Assembler& assembler, const State& state) const;
  /// Its rate of change at a state: of motions, deflections and forces of laws that follow x and x' alone;
  /// none for others (accelerations, reactions, loads, ideal gears, laws that follow a phase).
  std::optional<double> rate(const Assembler& assembler, const State& state) const;

  /// Whether evaluate() reads the state's accelerations, or rate() does.
  bool value_needs_acceleration() const;
  /// Whether the value jumps or kinks where a load does.
  bool follows_loads() const {
    return kind_ == Kind::load || kind_ == Kind::friction || value_needs_acceleration();
  }
  bool rate_needs_acceleration() const { return kind_ == Kind::force || kind_ == Kind::rate || !v_.empty(); }

  /// For a value that is sum z_row z + sum v_row v and nothing else.
  bool is_linear() const { return direct_; }
  const std::vector<Entry>& z_row() const { return z_; }
  const std::vector<Entry>& v_row() const { return v_; }
  /// The force between two flanks.
  bool along_line_of_action() const { return along_line_of_action_; }
  /// The scalar term whose force, or deflection, it is; else -1.
  int force_of() const { return kind_ == Kind::force ? index_ : -1; }
  int deflection_of() const { return kind_ == Kind::deflection ? index_ : -1; }

 private:
  friend class ChannelFinder;
  double over_unknowns(const State& state) const;
  enum class Kind {
    value,
    rate,
    acceleration,
    difference,
    reaction,
    output,
    force,
    deflection,
    load,
    ideal_ratio,
    friction,
    slip
  };
  std::string name_, unit_;
  Kind kind_ = Kind::value;
  int index_ = 0, second_ = 0;
  bool along_line_of_action_ = false;
  /// Where the value is linear in the unknowns: its rows over z and v, so that no node is looked up.
  bool direct_ = false;
  std::vector<Entry> z_, v_;
  std::vector<Entry> u_, u_rate_;  ///< of an output, over known motions
};

/// Every channel of a system, in the order of its nodes and elements (differences left out).
std::vector<Channel> all_channels(const System& system);

/// Channels by name; a difference is found too. Throws ModelError that lists every unknown name with the
/// nearest known one.
std::vector<Channel> find_channels(const System& system, const std::vector<std::string>& names);
Channel find_channel(const System& system, const std::string& name);

/// Torque that must act on prescribed node k beside the model's own terms to move it as given.
double reaction(const Assembler& assembler, const State& state, int k);

}  // namespace drev
