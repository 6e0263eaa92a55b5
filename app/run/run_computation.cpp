#include "app/run/run_computation.hpp"

#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/reduction/reduction_trial.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/statics.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/base/interrupt.hpp"
#include "app/base/progress.hpp"

namespace drev::app {

namespace {

class Timer {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::optional<Largest> largest_of(const std::vector<Channel>& channels, const std::vector<Peak>& peaks) {
  std::optional<Largest> largest;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const double value = peaks[c].amplitude();
    if (!std::isfinite(value)) return {};
    if (!largest || value > largest->value)
      largest = Largest{value, channels[c].name(), channels[c].unit(), peaks[c].time()};
  }
  return largest;
}

void add_modes(const System& system, RunResult& result) {
  const Timer timer;
  try {
    result.modes = solve_modes(system, {});
  } catch (const SolverError& error) {
    result.modes_reason = error.what();
  }
  result.modes_time = timer.seconds();
}

void add_static_force(const ModelRequest& model, const std::vector<Channel>& torques, RunResult& result) {
  if (model.model_case.static_turn == 0.0 || torques.empty()) {
    result.static_reason = "this model has no turn over which it would be sought";
    return;
  }
  if (!model.system.floating_parts(Contact::closed).empty()) {
    result.static_reason = "the model is free to turn, so there is no equilibrium";
    return;
  }
  const Timer timer;
  try {
    result.static_force = largest_of(
        torques, static_sweep(model.system, torques, 0.0, model.model_case.static_turn, kStaticAngles));
    if (!result.static_force) result.static_reason = "it is not finite";
  } catch (const SolverError& error) {
    result.static_reason = error.what();
  }
  result.static_time = timer.seconds();
}

std::vector<Contacts> contacts_of(const System& system, const ContactStatistics& statistics) {
  const std::vector<Channel> channels = all_channels(system);
  std::vector<Contacts> contacts;
  for (const ContactRecord& record : statistics.records()) {
    const bool newton = std::any_of(channels.begin(), channels.end(), [&](const Channel& c) {
      return c.name() == record.element + ".force_N";
    });
    contacts.push_back({record, newton ? "N" : "N m"});
  }
  return contacts;
}

/// Figures with their errors; false: the run failed, as the result says.
bool find_accuracy(const RunRequest& request, RunResult& result) {
  const ModelCase& model_case = request.model.model_case;
  Progress shown;
  const Timer timer;
  try {
    result.accuracy = run_to_accuracy(request.model.system, {.accuracy = *request.accuracy,
                                                             .t_end = model_case.duration,
                                                             .deflection = model_case.deflection,
                                                             .torques = model_case.torques,
                                                             .cycle = cycle_of(request.model),
                                                             .method = request.method,
                                                             .progress = [&](double part) {
                                                               shown.update(part);
                                                               return !interrupted();
                                                             }});
    result.method = result.accuracy->fine;
    result.summary = result.accuracy->summary;
    result.status = to_text(result.summary.status);
    result.reason = result.summary.reason;
  } catch (const SolverError& error) {
    result.status = "failed";
    result.reason = error.what();
  }
  result.accuracy_time = timer.seconds();
  return result.ok();
}

/// What is shown of the run: a reduction keeps the error of each of them.
std::vector<std::string> shown_channels(const RunRequest& request) {
  const ModelCase& model_case = request.model.model_case;
  std::vector<std::string> names = model_case.torques;
  if (!model_case.deflection.empty()) names.push_back(model_case.deflection);
  for (const Channel& c : mesh_channels(request.model.system)) names.push_back(c.name());
  if (request.out || request.report) names.insert(names.end(), request.record.begin(), request.record.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

RunPlan plan_run(const RunRequest& request) {
  const System& system = request.model.system;
  RunPlan plan{.method = request.method, .method_reason = request.method_reason};
  plan.note.of = plan.note.coordinates = system.size();
  if (!request.reduce) {
    plan.note.reason = "not reduced: no error was allowed for it, see --reduce";
    return plan;
  }
  const std::vector<std::string> channels = shown_channels(request);
  if (channels.empty()) {
    plan.note.reason = "not reduced: the model has no channel whose error could be told";
    return plan;
  }
  const Timer timer;
  ReductionTrial trial = try_reduction(system, {.within = *request.reduce,
                                                .channels = channels,
                                                .duration = request.model.model_case.duration,
                                                .method = request.method,
                                                .any_method = request.any_method,
                                                .progress = [](double) { return !interrupted(); }});
  plan.note.error = trial.error;
  plan.note.channel = trial.channel;
  plan.note.reason = trial.reason;
  if (trial.reduction) {
    plan.note.used = true;
    plan.note.coordinates = trial.reduction->system.size();
    plan.note.modes = trial.reduction->modes;
    plan.note.static_shapes = trial.reduction->static_shapes;
    plan.method = trial.method;
    if (request.any_method) plan.method_reason = "what suits the reduced model";
    plan.reduction = std::move(trial.reduction);
  }
  plan.time = timer.seconds();
  return plan;
}

std::vector<Channel> mesh_channels(const System& system) {
  std::vector<Channel> found = all_channels(system);
  std::erase_if(found, [&](const Channel& channel) {
    const int law = channel.force_of();
    const bool gapped = law >= 0 && system.scalars()[static_cast<std::size_t>(law)].force->gap();
    return !channel.along_line_of_action() && !gapped;
  });
  return found;
}

double cycle_of(const ModelRequest& model) {
  const auto& reference = model.system.reference();
  if (!reference || !reference->at || !(model.model_case.static_turn > 0.0)) return 0.0;
  const double speed = reference->at(0.0).rate;
  if (speed == 0.0 || reference->at(model.model_case.duration).rate != speed) return 0.0;
  return model.model_case.static_turn / std::abs(speed);
}

RunResult compute_run(const RunRequest& request, const RunPlan& plan, std::vector<Observer*> observers,
                      const std::function<std::string()>& output_fault) {
  const System &full = request.model.system, &system = system_of(request, plan);
  const ModelCase& model_case = request.model.model_case;
  RunResult result;
  result.method = plan.method;
  result.method_reason = plan.method_reason;
  result.reduction = plan.note;
  result.reduction_time = plan.time;
  add_modes(full, result);
  add_static_force(request.model, find_channels(full, model_case.torques), result);

  const std::vector<Channel> torques = find_channels(system, model_case.torques);

  std::vector<Channel> deflections;
  if (!model_case.deflection.empty()) deflections = find_channels(system, {model_case.deflection});
  Peaks torque_peaks(torques), deflection_peaks(deflections), mesh_peaks(mesh_channels(system));
  ContactStatistics contacts(system);
  observers.insert(observers.begin(), {&torque_peaks, &deflection_peaks, &mesh_peaks, &contacts});
  if (request.accuracy && !find_accuracy(request, result)) return result;
  const Timer timer;
  try {
    Progress shown;
    const auto progress = [&](double part) {
      shown.update(part);
      return !interrupted() && output_fault().empty();
    };
    result.summary =
        run_method(system, result.method, {.t_end = model_case.duration, .progress = progress}, observers);
    result.status = to_text(result.summary.status);
    result.reason = result.summary.reason;
  } catch (const SolverError& error) {
    result.status = "failed";
    result.reason = error.what();
    result.summary.scheme = result.method.name;
    result.summary.step = result.method.step;
  }
  result.run_time = timer.seconds();
  if (const std::string fault = output_fault(); !fault.empty()) {
    result.status = "output_error";
    result.reason = fault + "; the run was given up at t = " + to_text(result.summary.t_end) + " s";
  }
  // What failed numerically has no figures.
  if (result.ok() || result.status == "energy_error" || result.status == "interrupted" ||
      result.status == "output_error") {
    result.force = largest_of(torques, torque_peaks.peaks());
    result.deflection = largest_of(deflections, deflection_peaks.peaks());
    result.mesh_force = largest_of(mesh_peaks.channels(), mesh_peaks.peaks());
    result.contacts = contacts_of(system, contacts);
  }
  return result;
}

}  // namespace drev::app
