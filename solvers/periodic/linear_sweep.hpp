#pragma once
/// Steady vibration by orders over speed of a drivetrain that is linear, or linearised with every contact
/// closed: at each speed w of the reference shaft and each order o
///
///   (K + i o w C - (o w)^2 M) z_o = p_o(w)        K z_0 = mean p(w) - d w
///
/// one complex elimination a frequency, exact (solvers/linear/complex_elimination.hpp). p_o: order content of
/// the loads over the nominal angle phi; M, C, K: the model's, with the loads' mean slopes at w (a propeller's
/// law is a damper); d w: drag of the nominal speeds. Sections are torques or forces of elements, or other
/// channels that are linear in the motion:
///
///   y(phi) = mean + Re sum_o a_o exp(i o phi)
///
/// maximum, minimum and half range = (maximum - minimum) / 2 are of the sum over the whole cycle, phase by
/// phase, without the mean; the extremes are located on the sum, not sampled. Heat: mean power that the
/// element's own damper turns into heat, sum_o (o w)^2 / 2 Re(damper force per rate, times rate).
///
/// Parts that float freely: their vibration is as it is; their mean torque must balance, or they speed up. What
/// is left over is reported. Mean torques are then those of the train that speeds up at that rate, unless the
/// torque at one node is taken to balance it (`balance`). A part that dampers alone tie to the rest (a damper's
/// ring) runs at the mean speed at which their torques balance.
///
/// Not taken, and refused: loads in time, given motions, elements with tangents of their own, transmission
/// errors. Closed contacts (Contact::closed asked for): mean stiffness; how it varies over the mesh, and that
/// teeth may separate, is left out; SweepSection::separates() says where they would.
///
/// Accuracy: rounding times the condition of the dynamic stiffness: 1e-12 near resonances of damping 1e-3.
/// Source: E. J. Nestorides, A Handbook on Torsional Vibration, Cambridge, 1958 (steady state by orders, phase
/// vector sums).
#include <drev/core/system.hpp>

#include <complex>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drev {

struct LinearSweepOptions {
  std::vector<double> speeds = {};  ///< of the reference shaft, > 0, ascending [rad/s]
  /// Per revolution of the reference shaft, > 0, ascending; empty: 0.5, 1, ... 12.
  std::vector<double> orders = {};
  std::vector<std::string> sections = {};  ///< channels; empty: torque or force of every element that has one
  bool close_contacts = false;  ///< false: a model with laws that are not straight lines is refused
  bool refine = true;           ///< find the peaks between the speeds, and the criticals
  int threads = 0;              ///< at most; 0: one a processor where there is enough to do
  std::string balance = {};     ///< node whose mean torque takes up what is left over; empty: none
  /// Called between speeds by the thread that asked for the sweep; what it throws ends the sweep.
  std::function<void()> pause = {};
};

struct SweepSection {
  std::string name, unit;
  std::string twist_unit;      ///< of its element; empty: it has no twist
  Eigen::MatrixXcd amplitude;  ///< orders x speeds; not finite at an undamped resonance
  Eigen::MatrixXcd twist;      ///< the same of the element's twist or deflection; none without one
  Vector mean, maximum, minimum, maximum_angle, minimum_angle;  ///< over speeds; angles [rad] of the shaft
  Vector twist_mean, twist_half_range;
  Vector heat;  ///< W; 0 of what damps nothing
  bool contact = false;
  Vector half_range() const { return 0.5 * (maximum - minimum); }
  /// Whether the closed contact's force changes its sign in the cycle at speed number s.
  bool separates(Eigen::Index s) const {
    return contact && (mean[s] + maximum[s]) * (mean[s] + minimum[s]) <= 0.0;
  }
};

/// A speed at which a section's half range has a local maximum.
struct SweepPeak {
  int section = 0;
  double speed = 0.0;       ///< rad/s
  double half_range = 0.0;  ///< in the section's unit
  bool at_end = false;      ///< at the first or last speed: it may go on rising beyond
};

/// An order that meets a damped natural frequency within the speeds.
struct SweepCritical {
  int mode = 0;  ///< from 0, of the elastic modes
  double order = 0.0;
  double speed = 0.0;  ///< rad/s, where the order's amplitude is largest in `section`
  double frequency_Hz = 0.0, damping_ratio = 0.0;  ///< of the mode, damped, at that speed
  int section = 0;  ///< in which the order's amplitude is largest beside the section's largest half range
  double amplitude = 0.0;   ///< of the order there; infinite: neither the mode nor anything else damps it
  double half_range = 0.0;  ///< of the section at that speed
};

/// The elastic modes over the speeds, followed by their shapes. One column where nothing follows the speed.
struct SweepModes {
  Vector speeds;            ///< rad/s
  Eigen::MatrixXcd lambda;  ///< modes x speeds [1/s], Im > 0; 0 where the mode does not swing
  /// lambda at a speed: straight between columns.
  std::complex<double> at(Eigen::Index mode, double speed) const;
};

struct LinearSweep {
  std::vector<double> speeds, orders;
  double cycle = 0.0;  ///< of the sum of all orders [rad of the reference shaft]
  std::vector<SweepSection> sections;
  std::vector<SweepPeak> peaks;          ///< by section, then by size; of those beside the largest, at most 9
  std::vector<SweepCritical> criticals;  ///< by speed
  SweepModes modes;                      ///< where options.refine
  std::string modes_note;                ///< why there are none, although asked for
  /// Mean torque that is left over, referred to the reference shaft, of each part that floats: [part][speed].
  std::vector<Vector> unbalanced;
  std::vector<std::string> floating_parts;  ///< a node of each
  std::vector<double> unbalanced_scale;     ///< of each part: largest sum over its loads of |mean torque|
  Vector input_power, dissipated_power;     ///< of the vibration, over speeds [W]; equal but for rounding
  struct LeftOut {
    std::string load;
    double share = 0.0;  ///< of the rms of what alternates in it that is in none of the orders, 0 to 1
  };
  std::vector<LeftOut> left_out;  ///< loads of which more than 0.1 % is, at the highest speed
};

/// Throws ModelError with everything that is wrong with options and model; SolverError where the stiffness
/// cannot be eliminated.
LinearSweep sweep_linear(const System& system, const LinearSweepOptions& options);

/// What loads that follow the speed (a propeller's law) add to C while the reference shaft turns at `speed`
/// [rad/s], > 0: -dp/dtheta', its mean over the cycle, values on System::pattern(). Throws ModelError for loads
/// that have no orders.
Vector load_damping(const System& system, double speed);

}  // namespace drev
