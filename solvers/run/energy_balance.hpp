#pragma once
/// EnergyBalance: the energy balance of a run, as energy_monitor.hpp keeps it.

namespace drev {

struct EnergyBalance {
  double kinetic = 0.0;          ///< J, at the end
  double stored = 0.0;           ///< J, at the end
  double input = 0.0;            ///< J, since the start
  double dissipated = 0.0;       ///< J, since the start
  double imbalance = 0.0;        ///< J, at the end: > 0 energy from nothing
  double worst_imbalance = 0.0;  ///< J, largest in size over the run
  double worst_time = 0.0;       ///< s
  double given = 0.0;            ///< J, largest of |input|, dissipated and the start's energy over the run
  double scale = 0.0;            ///< J, largest of input, dissipated, kinetic + stored over the run
  /// worst_imbalance over scale [-]; 0 for a run without energy.
  double relative_error() const { return scale > 0.0 ? worst_imbalance / scale : 0.0; }
};

}  // namespace drev
