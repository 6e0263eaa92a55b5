#pragma once
/// The energy balance of a run, of the deviations from nominal motion:
///
///   kinetic + stored - (at the start) = input - dissipated + error
///
/// kinetic 1/2 v'Mv, stored 1/2 z'Kz + the laws' energies. Input: loads and known motions, as the mean of
/// the forces at both ends of a step times the displacement in it, so that average acceleration on a linear
/// system balances to rounding; plus what a mesh stiffness or a transmission error that varies puts in. The
/// error is what the method itself gained (positive) or lost: impacts, numerical damping, too large a step.
/// Newton's convergence says nothing about it. See Krenk 2006, doi:10.1016/j.cma.2005.12.001, for energy
/// balances of Newmark methods.
#include <drev/core/assembler.hpp>
#include <drev/solvers/run/energy_balance.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include "solvers/linear/matrix_product.hpp"

namespace drev {

class EnergyMonitor {
 public:
  EnergyMonitor(const Assembler& assembler, const EvaluatedState& start);
  /// Accounts for one accepted step. False: its energy is not finite, and the balance stays as it was.
  bool step(const EvaluatedState& from, const EvaluatedState& to, double h);
  /// The same where the method itself integrated what was put in and what dissipated in the step [J].
  bool step(const EvaluatedState& to, double input, double dissipated);
  /// The same point after a breakpoint: forces jumped, the state did not. Energy that a law's stored
  /// energy gained by the jump counts as input.
  void restart(const EvaluatedState& before, const EvaluatedState& after);
  const EnergyBalance& balance() const { return balance_; }
  /// Back to a balance kept before a step that is rejected.
  void restore(const EnergyBalance& balance) { balance_ = balance; }

 private:
  double stored(const EvaluatedState& point) const;
  bool enter(const EvaluatedState& to, double input, double dissipated, double stored);

  const Assembler& assembler_;
  MatrixProduct mass_;
  bool damped_ = false;  // there are constant dampers
  EnergyBalance balance_;
};

}  // namespace drev
