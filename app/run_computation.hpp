#pragma once
/// The computation of `drev run`: modes, static torque over one turn, and the run itself.
///
/// Static torque: largest |torque| over all sections in static equilibrium while the shaft turns once, at
/// 1440 angles (every 0.25 degrees of the shaft); dynamic amplification: largest torque / static torque.
#include "app/history_file.hpp"
#include "app/report_history.hpp"
#include "app/run_result.hpp"

namespace drev::app {

/// history: where the recorded channels go; report: what the report keeps of them. Both may be null.
RunResult compute_run(const RunRequest& request, HistoryFile* history, ReportHistory* report);

/// Forces [N] of meshes, backlash or not, and of whatever else has a gap.
std::vector<Channel> mesh_channels(const System& system);
/// Time of the turn that static torques are sought over, where the shaft's speed is constant; else 0.
double cycle_of(const ModelRequest& model);

}  // namespace drev::app
