#pragma once
/// The computation of `drev run`: modes, static torque over one turn, and the run itself.
///
/// Static torque: largest |torque| over all sections in static equilibrium while the shaft turns once, at
/// 1440 angles (every 0.25 degrees of the shaft); dynamic amplification: largest torque / static torque.
#include "app/history_file.hpp"
#include "app/run_result.hpp"

namespace drev::app {

/// history: where the recorded channels go; may be null.
RunResult compute_run(const RunRequest& request, HistoryFile* history);

}  // namespace drev::app
