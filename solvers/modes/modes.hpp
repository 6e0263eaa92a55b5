#pragma once
/// Undamped modes of a system linearised about a stated contact state:
///
///   K x = omega^2 M x,  x' M x = 1,  f = omega / (2 pi)
///
/// K: stiffness with every contact closed at its mean stiffness, or open. Damping is left out (see
/// damped_modes.hpp). Elements with a complex stiffness k*(f) have Re k* at the mode's frequency, under the load that they carry in
/// time (ViscoelasticStiffness); internal nodes of their chains are at rest.
///
/// Rigid-body modes (omega = 0) are expected from the model's graph: parts tied neither to ground
/// nor to a prescribed node. As many eigenvectors must store no energy within rounding, |x' K x| <= 1e-13 |x|' |K| |x|
/// or omega^2 nothing beside that of the first elastic mode, whatever the units; anything else is an error. No mode is lost either: a
/// Sturm count just above the last mode must agree with the number found, and the search is widened
/// until it does. Shift below zero: K - sigma M is positive definite although K is not.
///
/// Accuracy: the stiffness matrix itself carries rounding, which changes lambda by about eps |x|' |K| |x|,
/// and so omega by up to eps lambda_max / (2 lambda), relative: 3e-5 at 1 N m/rad beside 1e12 N m/rad where
/// both take part. ModeSet::error_Hz has that, and what the mode's residual adds to it.
#include <drev/core/system.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev {

enum class ModesMethod {
  dense,   ///< all eigenpairs of the shifted problem (Eigen)
  lanczos  ///< shift-invert Lanczos: without restarts, or ARPACK's
};
const char* to_text(ModesMethod method);

struct ModesOptions {
  /// Number of elastic modes, the lowest ones. Given: exactly as many, an error if the system has
  /// fewer. Not given: 10, or all where there are fewer (none is no error).
  std::optional<int> count = {};
  Contact contact = Contact::closed;
  /// With the matrices that methods in time have: elements with a complex stiffness as the chain that stands for them there, whose
  /// internal nodes have modes of their own.
  bool in_time = false;
  /// Systems of up to as many unknowns are solved dense, and where Lanczos would need a basis of nearly all.
  /// Measured for 10 modes of a held chain, time dense : Lanczos = 1.06 at 24 unknowns, 1.4 at 38, 3.4 at 80,
  /// 5.7 at 100, 28 at 200 (6.5 ms : 0.23 ms).
  int dense_limit = 20;
};

/// How the modes were found.
struct ModesSummary {
  ModesMethod method = ModesMethod::dense;
  double shift = 0.0;        ///< sigma [(rad/s)^2], < 0
  double sturm_point = 0.0;  ///< s [(rad/s)^2] of the count; 0 if all modes were computed
  int sturm_count = 0;       ///< eigenvalues below s, rigid ones included; agreed with those found
  int widened = 0;           ///< times the search was widened because the count did not agree
  int solves = 0;            ///< with K - sigma M
  int factorizations = 0;
  /// Further modes with the frequency of the last one, which the count asked for cuts off.
  int copies_not_returned = 0;
  double largest_residual = 0.0;  ///< max |K x - lambda M x| / (|K| |x| + lambda |M| |x|)
  std::string brief() const;      ///< one line
};

struct ModeSet {
  Contact contact = Contact::closed;
  int rigid_modes = 0;               ///< modes with f = 0, not among those below
  std::vector<double> frequency_Hz;  ///< elastic modes, ascending
  std::vector<double> error_Hz;      ///< of each, >= 0: what rounding leaves, at most a tenth of it
  /// Column j: mode j over all nodes, with those that ideal gears eliminate and zero where
  /// prescribed. The entry of largest magnitude is positive.
  Eigen::MatrixXd shapes;
  Eigen::MatrixXd vectors;        ///< the same over the unknowns; x' M x = 1
  Eigen::MatrixXd rigid_vectors;  ///< beside elastic modes: the rigid ones over the unknowns, x' M x = 1
  ModesSummary summary;

  int count() const { return static_cast<int>(frequency_Hz.size()); }
  double omega(int mode) const;  ///< rad/s
};

/// Throws ModelError for options out of range; SolverError if the number of rigid modes is not what
/// the graph says, if K has a negative eigenvalue (static instability) or is unsymmetric, if no
/// agreement with the Sturm count is reached, or if rounding leaves an error of more than a tenth of a frequency.
ModeSet solve_modes(const System& system, const ModesOptions& options = {});

/// How many elastic modes solve_modes() can find: fewer than unknowns where internal nodes are at rest or lossy gears are ideal ones.
int elastic_mode_count(const System& system, Contact contact);

}  // namespace drev
