#pragma once
/// Which orders of the loads excite which modes, and at which speeds they resonate: what the Campbell diagram,
/// the list of criticals and the tracking of orders are made from. Natural frequencies do not depend on
/// speed in drev.
///
/// The orders of a load are those that it states (HarmonicLoad), or those of its torque over two turns of its node.
/// How much order o excites mode m is the static response of the mode to the phase sum over all loads,
///
///   q_om = |sum_l x_l A_lo exp(i phase_lo)| / omega_m^2,   x_m' M x_m = 1,
///
/// times the shape's largest entry [rad or m], with the loads at the speed omega_m / o at which they meet. At resonance
/// it is 1 / (2 zeta_m) times as large.
#include <drev/core/model.hpp>
#include <drev/core/system.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <string>
#include <vector>

namespace drev::app {

/// Where an order meets a natural frequency.
struct Crossing {
  int mode = 0;
  double order = 0.0;   ///< per turn of the reference shaft
  double speed = 0.0;   ///< rad/s, of the reference shaft
  double answer = 0.0;  ///< q_om times the shape's largest entry [rad or m]
};

/// At which loads are looked at where no speed is known [rad/s].
inline constexpr double kTurning = 1.0;

/// The nodes on which torques with orders act, that of the largest range over two turns of its node first.
std::vector<std::string> driven_nodes(const System& system);

/// Name of the node through which the reference motion was given: the reference shaft, whose speed the speeds of a sweep are.
/// Empty: there is none.
std::string reference_node(const Model& model);
/// "of gear, the reference shaft", what speeds are of.
std::string of_reference(const Model& model);

/// Of the reference shaft over the run [rad/s]; zeros where none turns.
struct SpeedRange {
  double slowest = 0.0, fastest = 0.0;                          ///< in either sense, without sign
  double first = 0.0, last = 0.0, lowest = 0.0, highest = 0.0;  ///< with sign
  bool changes() const { return fastest > slowest * (1.0 + 1e-9); }
};
/// Of these speeds, one after the other, at least one [rad/s].
SpeedRange range_of_speeds(const std::vector<double>& speeds);
SpeedRange speed_range(const System& system, double duration);

struct Excitation {
  std::vector<Crossing> crossings;  ///< of all orders and modes, the most excited first
  std::vector<std::string>
      unknown;  ///< elements with a torque whose orders are not known: it does not repeat in two turns
};
/// range: of the run; the loads of a crossing slower than half the slowest speed, or faster than twice the fastest, are those at
/// that speed.
Excitation find_excitation(const System& system, const ModeSet& modes, const SpeedRange& range);

/// The orders worth showing: of each of the lowest modes those that excite it most, resonant in the run's speeds or
/// not far from them; then those that excite most wherever they are resonant, until there are a few. Ascending.
std::vector<double> chief_orders(const std::vector<Crossing>& crossings, const SpeedRange& range);

}  // namespace drev::app
