#pragma once
/// The computation of `drev run`: modes, static torque over one turn, and the run itself.
///
/// Static torque: largest |torque| over all sections in static equilibrium while the shaft turns once, at
/// kStaticAngles angles (every 0.25 degrees of the shaft); dynamic amplification: largest torque / static
/// torque.
#include <drev/core/channel.hpp>
#include <drev/solvers/reduction/reduction.hpp>
#include <drev/solvers/run/observer.hpp>

#include <functional>
#include <string>
#include <vector>

#include "app/run/run_result.hpp"

namespace drev::app {

inline constexpr int kStaticAngles = 1440;

/// What is run: the model, or a reduction of it.
struct RunPlan {
  std::optional<Reduction> reduction = {};
  Method method = {};
  std::string method_reason = {};
  ReductionNote note = {};
  double time = 0.0;  ///< s, to find it
};
RunPlan plan_run(const RunRequest& request);
inline const System& system_of(const RunRequest& request, const RunPlan& plan) {
  return plan.reduction ? plan.reduction->system : request.model.system;
}

/// observers: what else watches the run of system_of(request, plan). output_fault: asked now and then; what
/// keeps the run's output from being written, which ends the run; empty: nothing.
RunResult compute_run(const RunRequest& request, const RunPlan& plan, std::vector<Observer*> observers,
                      const std::function<std::string()>& output_fault);

/// Forces [N] of meshes, backlash or not, and of whatever else has a gap.
std::vector<Channel> mesh_channels(const System& system);
/// Time of the turn that static torques are sought over, where the shaft's speed is constant; else 0.
double cycle_of(const ModelRequest& model);

}  // namespace drev::app
