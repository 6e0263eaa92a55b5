#pragma once
/// Dormand and Prince's RK5(4) written for the Chain alone: arrays of fixed size, first stage taken
/// over from the last, error control by the same norm as SUNDIALS', contact changes located on the
/// dense output and the step done again to end there.
#include "tests/benchmark/peers/chain.hpp"

namespace peers {

struct LeanOptions {
  double rtol = 1e-6, t_end = 5.0;
  bool changes = true;  ///< locate contact changes
  bool knots = false;   ///< locate the knots of the load tables
  int samples = 0;
};
PeerRun run_lean_rk5(const Chain& chain, const LeanOptions& options);
/// In extended precision, all changes located: an independent check of a reference.
PeerRun run_long_rk5(const Chain& chain, const LeanOptions& options);

}  // namespace peers
