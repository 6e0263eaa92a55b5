#pragma once
/// Average acceleration with constant step written for the Chain alone, and nothing beside the motion:
/// tridiagonal LDL' factored once, table look-up with the twist fed back and iterated, and where there are
/// meshes (at most two) their contact as a problem of their forces alone. The least that a run can take;
/// no energy, no peaks, nothing recorded, no input checked.
#include "tests/benchmark/peers/chain.hpp"

namespace peers {

struct FloorRun {
  double seconds = 0.0;  ///< processor time
  long steps = 0, load_passes = 0, contact_passes = 0;
  std::vector<double> z, v;  ///< at the end [rad, rad/s]
};

/// From rest, undeflected. Loads are converged to load_tolerance of the largest force so far, as drev's are.
FloorRun run_step_floor(const Chain& chain, double step, double t_end, double load_tolerance = 1e-10);

}  // namespace peers
