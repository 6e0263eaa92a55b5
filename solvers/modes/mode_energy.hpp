#pragma once
/// Where the energy of damped modes is, element by element:
///
///   kinetic   |lambda|^2 x' M_e x / 4      elastic   x' K_e x / 4      dissipated   |lambda|^2 x' C_e x / 2
///
/// means over a cycle that neither grows nor decays, x: complex shape over the nodes of element e, x': its
/// conjugate transpose; each as a share of the sum over all elements. Contacts in the state of the modes.
/// Rayleigh damping is that of its own element.
#include <drev/solvers/modes/damped_modes.hpp>

#include <string>
#include <vector>

namespace drev {

struct ModeEnergy {
  std::vector<std::string> elements;  ///< those that have any of it in any mode
  /// Shares, elements x modes: each column's sum is 1, or 0 where there is no energy of the kind.
  Eigen::MatrixXd kinetic, elastic, dissipated;
};

ModeEnergy mode_energy(const System& system, const DampedModeSet& modes);

}  // namespace drev
