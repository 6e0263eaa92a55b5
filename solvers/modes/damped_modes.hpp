#pragma once
/// Damped modes of a system linearised about a stated contact state:
///
///   (lambda^2 M + lambda C + K) x = 0,   lambda = -xi w +- i w sqrt(1 - xi^2)
///
/// w = |lambda|: undamped circular frequency for proportional damping; xi = -Re lambda / |lambda|:
/// damping ratio. C holds the dampers, Rayleigh damping and, closed, the contacts' damping. Solved
/// dense as
///
///   d/dt (w_0 y, y') = (w_0 y', -K^ y - C^ y')      M = L L',  y = V' L' q,  w_0^2 = |K^|
///
/// V splits off the rigid-body motions: their angles do not enter, so that each gives one lambda =
/// 0 that is exact (and left out) and one for its rate, -c/J where something drags on it. Without
/// the split the double zero of a free drivetrain would come out as +- 1e-8 w_0.
///
/// Where stiffnesses and inertias spread so widely that elastic motions cannot be told from rigid ones beside
/// |K^|, y are the undamped modes (modes.hpp), each with its own w_0 = omega_j.
///
/// Accuracy: about eps w_0 (eps max omega_j), absolute; half the digits at critical damping (a double lambda).
/// Real parts within 4 eps w_0 are 0, and all are where nothing damps and the tangents are symmetric. A real lambda
/// of several motions at once stays real, though rounding splits it into a pair.
///
/// Elements with a complex stiffness k*(f) add it to K at the frequency Im lambda / (2 pi) of each mode, under the load that they carry
/// in time (ViscoelasticStiffness), and internal nodes of their chains are at rest; real lambda have Re k*(0). Only where the tangents
/// are symmetric: otherwise they are as in time.
///
/// Source: F. Tisseur, K. Meerbergen, The quadratic eigenvalue problem, SIAM Review 43(2), 2001,
/// doi:10.1137/S0036144500381988.
#include <drev/core/system.hpp>

#include <complex>
#include <string>
#include <vector>

namespace drev {

struct DampedModesOptions {
  Contact contact = Contact::closed;
  /// Largest number of unknowns n; time grows with n^3. Measured: 0.1 s at 100, 4 s at 400.
  int size_limit = 1500;
  /// Added to C, values on System::pattern(); empty: nothing. That of loads which follow the speed:
  /// load_damping() of solvers/periodic/linear_sweep.hpp.
  Vector damping = {};
  /// With the matrices that methods in time have: elements with a complex stiffness as the chain that stands for them there, which
  /// has real lambda of its own.
  bool in_time = false;
};

/// One oscillating mode: a pair of conjugate lambda.
struct DampedMode {
  std::complex<double> lambda;        ///< 1/s, the one with Im > 0
  double frequency_Hz = 0.0;          ///< of the oscillation, Im lambda / (2 pi)
  double natural_frequency_Hz = 0.0;  ///< |lambda| / (2 pi): undamped only where damping is proportional
  double damping_ratio = 0.0;         ///< xi; negative: the mode grows
};

struct DampedModeSet {
  Contact contact = Contact::closed;
  int rigid_modes = 0;            ///< lambda = 0 that belong to the angles of free parts, left out below
  std::vector<DampedMode> modes;  ///< by natural frequency, ascending
  /// Real lambda [1/s], descending (slowest decay first): overdamped modes, and one for each
  /// rigid-body motion's rate (0 where nothing drags on it).
  std::vector<double> real_lambda;
  /// Column j: modes[j] over all nodes; the entry of largest magnitude is 1.
  Eigen::MatrixXcd shapes;
  Eigen::MatrixXcd vectors;  ///< the same over the unknowns, each column in a scale of its own
  bool in_time = true;       ///< of matrices as methods in time have them (DampedModesOptions)

  /// Gives the modes other lambda [1/s], Im >= 0, and the shapes of `vectors`. Real parts within `rounding` [1/s], one for each mode, are 0.
  void set_modes(const System& system, const Eigen::VectorXcd& lambda, const Vector& rounding = {});
};

/// Throws ModelError above size_limit, SolverError where solve_modes() refuses so wide a spread, or the
/// eigensolver does not converge.
DampedModeSet solve_damped_modes(const System& system, const DampedModesOptions& options = {});

/// A mode that grows: nothing that depends on it reaches a steady state.
struct Growth {
  double rate = 0.0;          ///< Re lambda [1/s]; 0: none grows by more than rounding
  double frequency_Hz = 0.0;  ///< 0: it does not swing
  /// Takes a mode with this lambda, Im >= 0, if it grows faster.
  void note(std::complex<double> lambda);
  std::string text() const;  ///< "a mode at 2.5 Hz grows at 0.3 1/s (Re lambda)"
};

/// The mode that grows fastest. Of real lambda none counts where a part floats: they are of mean speeds, too.
Growth fastest_growth(const System& system, const DampedModeSet& modes);

/// The same, contacts closed, `damping` as in DampedModesOptions. Modes are solved for only where the matrices can feed energy in
/// (K or C not symmetric, or C not positive semidefinite), with 400 unknowns at the most: beyond, none is found. Throws as
/// solve_damped_modes() does.
Growth find_growth(const System& system, const Vector& damping);

/// Where the energy of damped modes is, element by element:
///
///   kinetic   |lambda|^2 x' M_e x / 4      elastic   x' K_e x / 4      dissipated   |lambda|^2 x' C_e x / 2
///
/// means over a cycle that neither grows nor decays, x: complex shape over the nodes of element e, x': its
/// conjugate transpose; each as a share of the sum over all elements. Contacts in the state of the modes.
/// Rayleigh damping is that of its own element.
struct ModeEnergy {
  std::vector<std::string> elements;  ///< those that have any of it in any mode
  /// Shares, elements x modes: each column's sum is 1, or 0 where there is no energy of the kind.
  Eigen::MatrixXd kinetic, elastic, dissipated;
};

ModeEnergy mode_energy(const System& system, const DampedModeSet& modes);

/// What is left of a motion of its own that counts as settled [-].
inline constexpr double kSettledPart = 1e-3;

/// How long what the start of a run excited takes to die away.
struct Settling {
  double time = 0.0;   ///< s; infinite: it never settles, or it is not known
  std::string reason;  ///< which motion takes the longest, or why not; a sentence without full stop
};

/// When what was let go from a deflection is down to kSettledPart, by the slowest of the damped modes, contacts closed, and
/// of the rates of free parts that something drags on: ln(1 / kSettledPart) times the time constant -1 / Re lambda where
/// eigenvalues are far apart, up to a third more where two are about one. A free rotation that nothing drags on carries no
/// torque, and is left out. Of 400 unknowns at most: beyond, time is infinite and reason says so.
Settling settling_time(const System& system);

}  // namespace drev
