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
///   ELEMENT.power_W, ELEMENT.dissipation_W    power that the element gives the train; that it turns into heat
///   ELEMENT.stored_J, ELEMENT.kinetic_J       elastic energy in it; kinetic energy of its inertia
///   ELEMENT.work_J, ELEMENT.dissipated_J      power and dissipation summed up since the start of the run
///
/// Power and kinetic energy are of the actual speeds, nominal and deviation together: power > 0 of what drives, < 0
/// of what takes; dissipation >= 0 of passive elements. Over any time work = -dissipated - change of stored, of
/// elements that do not vary by themselves (equations: core/energy/element_energy.hpp). Elements that neither store,
/// lose nor give have none. Of dry friction dissipated_J is heat_J.
///
/// Signs: a shaft's or spring's torque is k (q_b - q_a) + c (q_b' - q_a'), Rayleigh damping not included; a
/// mesh's force is positive on the front flank (x > 0); a load's torque is as it enters the right-hand side;
/// an ideal gear's torque is the one it applies to its second node; a reaction is the torque that must be
/// applied to the prescribed node to make it move as given.
#include <drev/core/scalar_force.hpp>
#include <drev/core/state.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drev {

class Assembler;
class ElementEnergy;

class Channel {
 public:
  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }
  /// Whether it was found in this system or one that it is a copy of: in others its places mean something else.
  bool is_of(const System& system) const;
  /// Value at a state; the assembler must stand at the state's time. Throws SolverError where over_run().
  double evaluate(const Assembler& assembler, const State& state) const;
  /// Its rate of change at a state: of motions, deflections, forces of laws that follow x and x' alone, or x and the angle of
  /// their phase node by a formula (AngleScaledForce), and the energy stored in those of x and x' alone; none for others
  /// (accelerations, reactions, loads, ideal gears, other laws that follow a phase).
  std::optional<double> rate(const Assembler& assembler, const State& state) const;
  /// The same of the force of a law whose input and response at that state are known; the assembler may stand at another time,
  /// if no known motion but a constant speed moves it.
  std::optional<double> force_rate(const Assembler& assembler, const State& state, const ScalarInput& input,
                                   const ScalarResponse& response) const;

  /// Whether it is an integral over the run of its integrand() [W]: no state holds its value, but a Recorder
  /// (recorder.hpp) and ChannelValues (channel_values.hpp) do.
  bool over_run() const { return kind_ == Kind::integral; }
  double integrand(const Assembler& assembler, const State& state) const;
  /// Whether it is one of the channels of energy and power.
  bool of_energy() const { return energy_ != nullptr; }

  /// Whether evaluate() reads the state's accelerations, or rate() does.
  bool value_needs_acceleration() const {
    return inertial_ || kind_ == Kind::acceleration || kind_ == Kind::reaction || kind_ == Kind::ideal_ratio;
  }
  /// Whether the value jumps or kinks where a load does.
  bool follows_loads() const {
    return kind_ == Kind::load || kind_ == Kind::friction || driven_ || value_needs_acceleration();
  }
  bool rate_needs_acceleration() const {
    return (kind_ == Kind::force && damped_) || kind_ == Kind::rate || !v_.empty();
  }

  /// For a value that is sum z_row z + sum v_row v and nothing else.
  bool is_linear() const { return direct_; }
  const std::vector<Entry>& z_row() const { return z_; }
  const std::vector<Entry>& v_row() const { return v_; }
  /// The force between two flanks.
  bool along_line_of_action() const { return along_line_of_action_; }
  /// The scalar term whose force, or deflection, it is; else -1.
  int force_of() const { return kind_ == Kind::force ? index_ : -1; }
  int deflection_of() const { return kind_ == Kind::deflection ? index_ : -1; }
  /// Of dry friction: its place in State::history; else -1.
  int friction_place() const { return kind_ == Kind::friction ? index_ : -1; }

 private:
  friend class ChannelFinder;
  double over_unknowns(const State& state) const {
    double y = 0.0;
    for (const Entry& e : z_) y += e.coeff * state.z[e.index];
    for (const Entry& e : v_) y += e.coeff * state.v[e.index];
    return y;
  }
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
    slip,
    energy,
    integral
  };
  std::string name_, unit_;
  std::shared_ptr<const void> layout_;  ///< System::layout()
  Kind kind_ = Kind::value;
  int index_ = 0, second_ = 0;
  bool along_line_of_action_ = false;
  /// Where the value is linear in the unknowns: its rows over z and v, so that no node is looked up.
  bool direct_ = false;
  std::vector<Entry> z_, v_;
  std::vector<Entry> u_, u_rate_;  ///< of an output, over known motions
  /// Of energy and integral: whose, what it gives, and whether loads have a part in it.
  std::shared_ptr<const ElementEnergy> energy_;
  double (ElementEnergy::*of_energy_)(const Assembler&, const State&) const = nullptr;
  bool driven_ = false;
  bool damped_ = false;    ///< of a force that has a rate: it follows the rate of the deflection
  bool moved_ = false;     ///< of a force: by an angle, with no rate that is known
  bool inertial_ = false;  ///< of a load, or its energy: inertias that follow an angle may be among it
};

/// Whether all of them are of it.
bool are_of(const System& system, const std::vector<Channel>& channels);
/// Every channel of a system, in the order of its nodes and elements (differences and energies left out).
std::vector<Channel> all_channels(const System& system);
/// Those of energy and power, in the order of the elements.
std::vector<Channel> energy_channels(const System& system);

/// Whether channels that are integrals over the run are taken.
enum class OverRun { refused, taken };

/// Channels by name; a difference is found too. '*' in a name stands for any characters: all that fit are meant, each
/// once (of energies where the name ends in _W or _J). Throws ModelError that lists every unknown name with the nearest
/// known one, every pattern that nothing fits, and every integral over the run where these are refused.
std::vector<Channel> find_channels(const System& system, const std::vector<std::string>& names,
                                   OverRun integrals = OverRun::refused);
/// The one that is meant.
Channel find_channel(const System& system, const std::string& name);

/// Torque that must act on prescribed node k beside the model's own terms to move it as given.
double reaction(const Assembler& assembler, const State& state, int k);

}  // namespace drev
