#pragma once
/// The computation of `drev run`: its start, modes, static torque over one turn, and the run itself. Dynamic
/// amplification: largest torque of the figures' span over the static torque (static_force.hpp).
#include <drev/core/channel.hpp>
#include <drev/solvers/reduction/reduction.hpp>
#include <drev/solvers/run/observer.hpp>

#include <functional>
#include <string>
#include <vector>

#include "app/run/run_result.hpp"

namespace drev::app {

/// What is run: the model from where it starts, or a reduction of it.
struct RunPlan {
  std::optional<FoundStart> start = {};  ///< none: the model's initial conditions
  std::string no_start = {};             ///< why what was asked for is not there; empty: it is
  std::optional<Reduction> reduction = {};
  Method method = {};
  std::string method_reason = {};
  ReductionNote note = {};
  double time = 0.0;  ///< s, to find it
};
RunPlan plan_run(const RunRequest& request);
/// Where any method is right: takes the one that a trial finds far cheaper (try_methods()), and with controlled steps, or where
/// the run would take long (kLongRun), a reduction that adds a tenth of the tolerance of controlled steps.
void settle_method(RunRequest& request);
/// The whole model, from where it starts.
inline const System& started_system(const RunRequest& request, const RunPlan& plan) {
  return plan.start ? plan.start->system : request.model.system;
}
inline const System& system_of(const RunRequest& request, const RunPlan& plan) {
  return plan.reduction ? plan.reduction->system : started_system(request, plan);
}

/// Elements with a loss factor whose chain in time (viscoelastic_stiffness.hpp) is far softer under a mean torque than the stiffness
/// that they state; a sentence without full stop for each.
std::vector<std::string> soft_chain_warnings(const System& system);

/// observers: what else watches the run of system_of(request, plan). output_fault: asked now and then; what
/// keeps the run's output from being written, which ends the run; empty: nothing.
RunResult compute_run(const RunRequest& request, const RunPlan& plan, std::vector<Observer*> observers,
                      const std::function<std::string()>& output_fault);

/// Forces [N] of meshes, backlash or not, and of whatever else has a gap.
std::vector<Channel> mesh_channels(const System& system);
/// Time of the turn that static torques are sought over, where the shaft's speed is constant; else 0.
double cycle_of(const ModelRequest& model);
/// Time of the cycles that spectra are over: that turn, or two turns where it is not stated.
double spectrum_cycle(const ModelRequest& model);

}  // namespace drev::app
