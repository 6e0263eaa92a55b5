#pragma once
/// Steady vibration by orders over speed of a drivetrain that is linear, or linearised with every contact
/// closed: at each speed w of the reference shaft and each order o
///
///   (K + i o w C - (o w)^2 M) z_o = p_o(w)        K z_0 = mean p(w) - d w
///
/// are solved exactly, by one complex elimination for each frequency
/// (solvers/linear/complex_elimination.hpp). p_o: order content of the loads over the nominal angle phi; M,
/// C, K: matrices of the model, with the loads' mean slopes at w (a propeller's law acts as a damper); d w:
/// drag of the nominal speeds. Sections are torques or forces of elements, or other channels that are linear
/// in the motion:
///
///   y(phi) = mean + Re sum_o a_o exp(i o phi)
///
/// maximum, minimum and half range = (maximum - minimum) / 2 are those of the sum of all orders with their
/// phases over the whole cycle, without the mean; the extremes are located on the sum, not sampled. Heat:
/// mean power that the element's own damper turns into heat, sum_o (o w)^2 / 2 Re(damper force per rate,
/// times rate).
///
/// Parts that float freely: their vibration is determined, but their mean torque must balance, or they speed
/// up. The unbalanced mean torque is reported. Mean torques are then those of the train that speeds up at
/// that rate, unless the torque at one node is taken to balance it (`balance`). A part that only dampers tie
/// to the rest (a damper's ring) runs at the mean speed at which the damper torques balance.
///
/// Refused: loads that depend on time, prescribed motions, elements with tangents of their own, transmission
/// errors. With closed contacts (close_contacts) a mesh has its mean stiffness; the variation of stiffness
/// over the mesh cycle and separation of teeth are left out; SweepSection::separates() tells where teeth
/// would separate.
///
/// Accuracy: rounding times the condition number of the dynamic stiffness: a relative error of about 1e-12
/// near resonances with a damping ratio of 1e-3.
/// Source: E. J. Nestorides, A Handbook on Torsional Vibration, Cambridge, 1958 (steady state by orders, phase
/// vector sums).
#include <drev/core/system.hpp>
#include <drev/solvers/modes/damped_modes.hpp>

#include <complex>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace drev {

struct LinearSweepOptions {
  std::vector<double> speeds = {};  ///< speeds of the reference shaft [rad/s], > 0, ascending
  /// Orders per revolution of the reference shaft, > 0, ascending; empty: 0.5, 1, ... 12.
  std::vector<double> orders = {};
  std::vector<std::string> sections = {};  ///< channels; empty: torque or force of every element that has one
  bool close_contacts = false;             ///< false: a model with nonlinear laws is refused
  /// false: orders without a common cycle are taken, too; maxima, minima and half ranges of their sums are then not numbers.
  bool needs_cycle = true;
  bool refine = true;        ///< true: find the peaks between the speeds, and the critical speeds
  int threads = 0;           ///< largest number of threads; 0: one per processor, if worth it
  std::string balance = {};  ///< node whose torque balances the mean torques; empty: none
  /// Called between speeds by the thread that asked for the sweep; what it throws ends the sweep.
  std::function<void()> pause = {};
};

struct SweepSection {
  std::string name, unit;
  std::string twist_unit;      ///< unit of the element's twist; empty: it has no twist
  Eigen::MatrixXcd amplitude;  ///< complex amplitudes, orders x speeds; not finite at an undamped resonance
  Eigen::MatrixXcd twist;      ///< complex amplitudes of the element's twist or deflection, orders x speeds
  /// Values at each speed; maximum and minimum without the mean; angles of the reference shaft [rad].
  Vector mean, maximum, minimum, maximum_angle, minimum_angle;
  Vector twist_mean, twist_half_range;
  Vector heat;  ///< mean heat at each speed [W]; 0 for a section without a damper
  /// Largest local maximum of the heat between the speeds [W] and its speed [rad/s]; not a number: none was located.
  double heat_peak = std::numeric_limits<double>::quiet_NaN(), heat_peak_speed = heat_peak;
  bool contact = false;
  Vector half_range() const { return 0.5 * (maximum - minimum); }
  /// Whether the closed contact's force changes its sign in the cycle, with extremes without the mean.
  bool separates(double its_mean, double its_maximum, double its_minimum) const {
    return contact && (its_mean + its_maximum) * (its_mean + its_minimum) <= 0.0;
  }
  /// The same at speed number s.
  bool separates(Eigen::Index s) const { return separates(mean[s], maximum[s], minimum[s]); }
};

/// A speed at which a section's half range has a local maximum.
struct SweepPeak {
  int section = 0;
  double speed = 0.0;       ///< speed of the reference shaft [rad/s]
  double half_range = 0.0;  ///< half range in the section's unit; infinite: nothing damps it
  bool at_end = false;      ///< true: at the first or last speed; it may rise further beyond
  /// Values of the section at that speed, as in SweepSection; not a number: not known.
  double mean = std::numeric_limits<double>::quiet_NaN(), maximum = mean, minimum = mean;
  double twist_half_range = mean, heat = mean;
};

/// Values of all sections at a speed beside those of the sweep, as in SweepSection; not a number: not known.
struct SweepPoint {
  double speed = 0.0;                   ///< speed of the reference shaft [rad/s]
  Vector mean, maximum, minimum, heat;  ///< infinite extremes: nothing damps the section
  double half_range(int section) const { return 0.5 * (maximum[section] - minimum[section]); }
};

/// An order that meets a damped natural frequency within the speeds.
struct SweepCritical {
  int mode = 0;  ///< number of the elastic mode, from 0
  double order = 0.0;
  /// Speed at which the order's amplitude is largest in `section`, within half the mode's width; on the flank of another
  /// mode, where it has no top of its own, speed at which the order meets the mode's frequency [rad/s].
  double speed = 0.0;
  double frequency_Hz = 0.0,
         damping_ratio = 0.0;  ///< damped natural frequency and damping ratio at that speed
  /// Section in which the mode's own part of the order's amplitude is largest, of those with the first one's unit.
  int section = 0;
  double amplitude = 0.0;   ///< amplitude of the order in `section` at that speed; infinite: nothing damps it
  double half_range = 0.0;  ///< half range of `section` at that speed
  /// The mode's own part of that amplitude: of the motion r / |Re lambda| with its residue r, without what other modes and
  /// the quasi-static torque add. Infinite: nothing damps it.
  double own_amplitude = 0.0;
  /// What speed, amplitude and own_amplitude are in each section. In those beside `section` the first two are from the pole and
  /// a parabola for the rest; where the mode's own part is below a tenth of the amplitude, the speed is that at which the order
  /// meets the mode. Empty: not known.
  struct InSection {
    double speed = 0.0, amplitude = 0.0, own_amplitude = 0.0;
    bool is_mode() const { return own_amplitude > kOwnPart * amplitude; }
  };
  static constexpr double kOwnPart = 0.1;  ///< smallest own part of an amplitude whose top is the mode's [-]
  std::vector<InSection> in_sections = {};
};

/// The elastic modes over the speeds, tracked by their shapes. One column where nothing depends on the speed.
struct SweepModes {
  Vector speeds;            ///< rad/s
  Eigen::MatrixXcd lambda;  ///< eigenvalues, modes x speeds [1/s], Im > 0; 0: no oscillation
  /// lambda of a mode at a speed, interpolated linearly between columns; 0: it does not oscillate at both of these.
  std::complex<double> at(Eigen::Index mode, double speed) const;
};

struct LinearSweep {
  std::vector<double> speeds, orders;
  double cycle =
      0.0;  ///< cycle of the sum of all orders [rad of the reference shaft]; not a number: they have none
  std::vector<SweepSection> sections;
  std::vector<SweepPeak> peaks;  ///< peaks by section, then by size; at most 10 for each section
  /// By ascending speed, if options.refine is set: where an order meets a mode and half the mode's width below and above. Every
  /// resonance has points, whether or not its peak is among `peaks`.
  std::vector<SweepPoint> points;
  std::vector<SweepCritical> criticals;  ///< critical speeds, ascending
  SweepModes modes;                      ///< modes, if options.refine is set
  /// What modes and criticals lack, or why they are missing, although options.refine is set.
  std::string modes_note;
  /// Of these modes, and of real lambda up to 400 unknowns, the one that grows fastest: with a rate > 0 the steady vibration is a
  /// solution of the equations that the train leaves.
  Growth growth;
  /// Speed at which it does [rad/s]; not a number: it grows at any speed alike.
  double growth_speed = std::numeric_limits<double>::quiet_NaN();
  /// Unbalanced mean torque of each floating part, referred to the reference shaft [N m]: [part][speed].
  std::vector<Vector> unbalanced;
  /// For each speed: several amplitudes of the elements that follow them satisfy the equations, and the largest is shown.
  std::vector<char> several_amplitudes;
  std::vector<std::string> floating_parts;  ///< name of one node of each floating part
  std::vector<double> unbalanced_scale;     ///< for each part: largest sum over its loads of |mean torque|
  Vector input_power, dissipated_power;     ///< of the vibration at each speed [W]; equal within rounding
  struct LeftOut {
    std::string load;
    double share = 0.0;  ///< part of its alternating rms torque that is in no order [-], 0 to 1
  };
  std::vector<LeftOut> left_out;  ///< loads with a share above 0.1 % at the highest speed
  /// The load with the largest share there, 0: the orders hold all of every load. It is a part of a load: what it would add to a
  /// half range may be a far larger part, where orders left out meet natural frequencies.
  LeftOut most_left_out;
};

/// A value and its speed [rad/s]; not a number: it is not known at any speed.
struct SweepLargest {
  double value = std::numeric_limits<double>::quiet_NaN(), speed = value;
};
/// Largest values of a section at the speeds and at the peaks that were located between them. A twist is that at the
/// peaks of the half range; heat is that of `points`, too, and has a peak of its own.
SweepLargest largest_half_range(const LinearSweep& sweep, int section);
SweepLargest largest_twist(const LinearSweep& sweep, int section);
SweepLargest largest_heat(const LinearSweep& sweep, int section);

/// Throws ModelError with all faults of options and model; SolverError where the stiffness matrix cannot be
/// eliminated.
LinearSweep sweep_linear(const System& system, const LinearSweepOptions& options);

/// The damping that speed-dependent loads (a propeller's law) add to C while the reference shaft turns at
/// `speed` [rad/s], > 0: the mean of -dp/dtheta' over the cycle, as values on System::pattern(). Throws
/// ModelError for loads that have no orders.
Vector load_damping(const System& system, double speed);

}  // namespace drev
