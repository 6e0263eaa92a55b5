#pragma once
/// Reduction: a system with fewer unknowns, z = R y, that every solver but lockstep runs
/// (ritz_projection.hpp).
///
/// Modal: R = [Phi X]. Phi: rigid and lowest elastic modes, contacts closed. X: what the modes left out give
/// under a constant force, for the row b of each law, for prescribed nodes that move, and for the loads,
///
///   X = (I - Phi Phi' M) K^+ (I - M Phi Phi') [b ... f ...]
///
/// M- and K-orthogonalised, so that R' M R = I and R' K R, contacts closed, is diagonal. Closed contacts'
/// shapes hold the rigid motions of the parts that they tie, so that open contacts let parts go freely. Loads
/// are sampled over two turns of the reference shaft (and up to the last breakpoint); of their shapes as many
/// are taken as leave static_accuracy, in the energy norm, to the others.
/// Source: J. M. Dickens, J. M. Nakagawa, M. J. Wittbrodt, A critique of mode acceleration and modal
/// truncation augmentation methods for modal response analysis, Computers & Structures 62, 1997,
/// doi:10.1016/S0045-7949(96)00315-X.
///
/// Craig-Bampton: the nodes kept are coordinates, with the static shape -K_ii^-1 K_ib of each and the lowest
/// modes with all of them held. M is not diagonal then: modal is the faster, this the one that keeps nodes
/// for general elements.
/// Source: R. R. Craig, M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA Journal 6,
/// 1968, doi:10.2514/3.4741.
///
/// Both are Ritz bases: no frequency, contacts closed, is below the full system's.
#include <drev/core/ritz_projection.hpp>

#include <string>
#include <vector>

namespace drev {

struct ReductionOptions {
  enum class Kind { modal, craig_bampton } kind = Kind::modal;
  int modes = 0;          ///< elastic modes, or modes with nodes held; 0: those up to up_to_Hz
  double up_to_Hz = 0.0;  ///< Hz; either this or modes
  /// Nodes kept as coordinates, craig_bampton only; those of laws, their phases and general elements always
  /// are.
  std::vector<std::string> keep = {};
  bool static_correction = true;  ///< modal: with X, else with Phi alone
  double static_accuracy = 1e-3;  ///< of the static shapes of loads, 1e-12 to 1
};

struct Reduction {
  System system;
  int modes = 0;                   ///< elastic modes kept, or modes with the kept nodes held
  int static_shapes = 0;           ///< columns of X, or nodes kept
  double first_left_out_Hz = 0.0;  ///< infinite where none is left out
  double static_error = 0.0;       ///< reached under the sampled loads, in the energy norm; modal only
  Eigen::MatrixXd basis = {};      ///< R: a row for each unknown of the full system
  std::string what = {};           ///< one sentence for a summary, without full stop
};

/// Throws ModelError for options out of range and for what ritz_projection() refuses, SolverError as
/// solve_modes() does and where a part hangs on no kept node.
Reduction reduce(const System& system, const ReductionOptions& options);

}  // namespace drev
