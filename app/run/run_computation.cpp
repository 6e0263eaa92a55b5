#include "app/run/run_computation.hpp"

#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/reduction/reduction_choice.hpp>
#include <drev/solvers/run/after_time.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/strength/class_judgement.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/base/interrupt.hpp"
#include "app/base/progress.hpp"
#include "app/base/text_layout.hpp"
#include "app/run/static_force.hpp"
#include "solvers/run/mean_speed.hpp"

namespace drev::app {

namespace {

constexpr double kPartOfTolerance = 0.1;  // that a reduction no one asked for may add

class Timer {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void add_modes(const System& system, RunResult& result) {
  const Timer timer;
  try {
    result.modes = solve_modes(system, {});
  } catch (const SolverError& error) {
    result.modes_reason = error.what();
  }
  result.modes_time = timer.seconds();
}

void add_static_force(const ModelCase& model_case, const System& system, RunResult& result) {
  const Timer timer;
  StaticForce found = find_static_force(system, find_channels(system, model_case.torques),
                                        model_case.static_turn, model_case.duration);
  result.static_force = std::move(found.largest);
  result.static_reason = std::move(found.reason);
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

/// What makes a run take long: its steps follow its fastest mode, or are as short as was asked for.
std::string why_long(const System& system, const Method& method, double duration) {
  const std::string text =
      std::to_string(system.size()) + " unknowns over " + short_digits(duration, 4) + " s";
  if (method.step > 0.0 && !method.controlled())
    return text + " in steps of " + short_digits(method.step, 4) +
           " s; take longer ones, or a shorter duration";
  return text + ", with a fastest mode of " + short_digits(to_hz(fastest_rate(system)), 3) +
         " Hz, and loads whose changes are followed; leave out or condense the stiffest part (drev advise), "
         "or take "
         "a shorter duration";
}

std::vector<std::string> names_of(const std::vector<Channel>& channels) {
  std::vector<std::string> names;
  for (const Channel& c : channels) names.push_back(c.name());
  return names;
}

/// Figures with their errors; false: the run failed, as the result says.
bool find_accuracy(const RunRequest& request, const System& system, double start_error, RunResult& result) {
  const ModelCase& model_case = request.model.model_case;
  Progress shown([&] { return why_long(system, request.method, model_case.duration); });
  const Timer timer;
  try {
    result.accuracy = run_to_accuracy(system, {.accuracy = *request.accuracy,
                                               .t_end = model_case.duration,
                                               .from = result.span.from,
                                               .deflection = model_case.deflection,
                                               .torques = model_case.torques,
                                               .meshes = names_of(mesh_channels(system)),
                                               .cycle = cycle_of(request.model),
                                               .method = request.method,
                                               .start_error = std::min(1.0, start_error),
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

/// The figure that the accuracy found, in place of that of the run; a statistic of several runs is another
/// quantity.
void take_figure(const AccuracyResult& accuracy, const std::string& name, std::optional<Largest>& largest) {
  const Figure* figure = accuracy.find(name);
  if (!largest || figure == nullptr || figure->name != name || figure->kind != Figure::Kind::estimate) return;
  largest->value = figure->value;
  largest->error = figure->error;
}

/// The error that rounding leaves of the torque of a stiff element.
void take_rounding(const RunSummary& summary, std::optional<Largest>& largest) {
  for (const auto& [channel, error] : summary.rounding)
    if (largest && largest->channel == channel)
      largest->error = std::max(largest->error.value_or(0.0), error);
}

/// The figures of contacts that the accuracy found.
void take_contacts(const AccuracyResult& accuracy, std::vector<Contacts>& contacts) {
  for (std::size_t i = 0; i < std::min(contacts.size(), accuracy.contacts.size()); ++i) {
    const ContactFigures& known = accuracy.contacts[i];
    ContactRecord& record = contacts[i].record;
    contacts[i].known = known;
    record.largest_force = known.largest_force.value;
    record.time_separated = known.time_separated.value;
    record.front_impacts = std::lround(known.front_impacts.value);
    record.back_impacts = std::lround(known.back_impacts.value);
  }
}

/// Where the run starts; false: there is no such state, as the plan says.
bool find_plan_start(const RunRequest& request, RunPlan& plan) {
  if (request.start == Start::rest) return true;
  try {
    plan.start = find_start(request.model.system, request.start,
                            {.cycle = cycle_of(request.model),
                             .duration = request.model.model_case.duration,
                             .method = request.method,
                             .progress = [](double) { return !interrupted(); }});
  } catch (const SolverError& error) {
    plan.no_start = error.what();
  }
  return plan.no_start.empty();
}

/// Those recorded that a state holds the values of.
std::vector<std::string> recorded_states(const RunRequest& request) {
  std::vector<std::string> names;
  for (const Channel& c : find_channels(request.model.system, request.record, OverRun::taken))
    if (!c.of_energy()) names.push_back(c.name());
  return names;
}

/// Channels whose orders are tracked over a run-up: those recorded, and the deflection.
std::vector<std::string> tracked_channels(const RunRequest& request) {
  constexpr std::size_t kMostTracked = 24;
  std::vector<std::string> names = recorded_states(request);
  const std::string& deflection = request.model.model_case.deflection;
  if (!deflection.empty() && std::count(names.begin(), names.end(), deflection) == 0)
    names.insert(names.begin(), deflection);
  if (names.size() > kMostTracked) names.resize(kMostTracked);
  return names;
}

/// What the model's sections may carry; empty: not known.
const Strength& strength_of(const RunRequest& request) {
  static const Strength none;
  return request.model.model_case.strength ? *request.model.model_case.strength : none;
}

/// The sections with an S-N line, and the channels asked for.
std::vector<RainflowChannel> rainflow_channels(const RunRequest& request, const System& system) {
  std::vector<RainflowChannel> counted;
  for (const SectionStrength& s : strength_of(request).sections)
    if (s.sn.given())
      counted.push_back({find_channel(system, s.element + ".torque_Nm"),
                         s.stress_concentration / polar_section_modulus(s.diameter, s.bore), s.sn});
  for (const std::string& name : request.rainflow)
    if (std::none_of(counted.begin(), counted.end(), [&](const auto& c) { return c.channel.name() == name; }))
      counted.push_back({find_channel(system, name)});
  return counted;
}

std::vector<SectionPeaks> sections_of(const RunRequest& request, const System& system, const Peaks& settled,
                                      const Peaks& whole) {
  const Strength& strength = strength_of(request);
  std::vector<SectionPeaks> sections;
  for (std::size_t c = 0; c < settled.channels().size(); ++c) {
    const Channel& channel = settled.channels()[c];
    sections.push_back({channel.name(), channel.unit(), whole.peaks()[c], settled.peaks()[c]});
    for (const SectionStrength& s : strength.sections)
      if (channel.name() == s.element + ".torque_Nm")
        for (const double t : {settled.peaks()[c].max_time, settled.peaks()[c].min_time}) {
          const double speed = system.reference() ? system.reference()->at(t).rate : 0.0;
          double& least = sections.back().permissible;
          least = std::fmin(least, torque_limit(s, std::abs(speed) / strength.rated_speed).continuous);
        }
  }
  return sections;
}

/// What is shown of the run: a reduction keeps the error of each of them.
std::vector<std::string> shown_channels(const RunRequest& request) {
  const ModelCase& model_case = request.model.model_case;
  std::vector<std::string> names = model_case.torques;
  if (!model_case.deflection.empty()) names.push_back(model_case.deflection);
  for (const Channel& c : mesh_channels(request.model.system)) names.push_back(c.name());
  for (const RainflowChannel& c : rainflow_channels(request, request.model.system))
    names.push_back(c.channel.name());
  if (request.out || request.report || request.keeps_history)
    for (std::string& name : recorded_states(request)) names.push_back(std::move(name));
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

void settle_method(RunRequest& request) {
  if (!request.any_method) return;
  const MethodTrial trial = try_methods(request.model.system, {request.method, request.method_reason},
                                        request.model.model_case.duration, [] { return !interrupted(); });
  request.method = trial.choice.method;
  request.method_reason = trial.choice.reason;
  if (request.any_reduce && (request.method.controlled() || trial.chosen_ns > kLongRun))
    request.reduce = kPartOfTolerance * kControlledTolerance;
}

RunPlan plan_run(const RunRequest& request) {
  RunPlan plan{.method = request.method, .method_reason = request.method_reason};
  plan.note.of = plan.note.coordinates = request.model.system.size();
  if (!find_plan_start(request, plan)) {
    plan.note.reason = "not reduced: the run has no start";
    return plan;
  }
  const System& system = started_system(request, plan);
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
  return time_of_turn(model.system, model.model_case.static_turn, model.model_case.duration);
}

double spectrum_cycle(const ModelRequest& model) {
  const double turn = model.model_case.static_turn;
  return time_of_turn(model.system, turn > 0.0 ? turn : 2.0 * kTwoPi, model.model_case.duration);
}

std::vector<std::string> soft_chain_warnings(const System& system) {
  constexpr double kSoftChain = 0.5;  // static stiffness of the chain over the stated one [-]
  std::vector<std::string> warnings;
  for (const FrequencyTerm& term : system.frequency_terms()) {
    const double chain = term.stiffness->static_stiffness(),
                 stated = chain + term.stiffness->static_beyond_matrices();
    if (chain < kSoftChain * stated)
      warnings.push_back(
          system.element_instances()[idx(index(term.element))].name +
          ": in time its loss factor is that of a chain with a static stiffness of " +
          short_digits(chain, 7) + " N m/rad, less than half of the " + short_digits(stated, 7) +
          " N m/rad stated: a mean torque twists it further than that, and slowly. Means of linear "
          "sweeps have the stated stiffness");
  }
  return warnings;
}

RunResult compute_run(const RunRequest& request, const RunPlan& plan, std::vector<Observer*> observers,
                      const std::function<std::string()>& output_fault) {
  const System &full = started_system(request, plan), &system = system_of(request, plan);
  const ModelCase& model_case = request.model.model_case;
  RunResult result;
  result.method = plan.method;
  result.method_reason = plan.method_reason;
  result.reduction = plan.note;
  result.reduction_time = plan.time;
  if (!plan.no_start.empty()) {
    result.status = interrupted() ? "interrupted" : "failed";
    result.reason = plan.no_start;
    result.modes_reason = result.static_reason = "the run has no start";
    result.summary.scheme = result.method.name;
    result.summary.step = result.method.step;
    return result;
  }
  const double duration = model_case.duration;
  const std::string unsettled = plan.start ? plan.start->unsettled() : "";
  const bool steady =
      request.start == Start::periodic && plan.start->error <= kSettledPart && unsettled.empty();
  result.span = figure_span(request.settle, full, steady, duration, model_case.static_turn);
  result.span.start = plan.start ? plan.start->how : "from the model's initial conditions";
  add_modes(full, result);
  add_static_force(model_case, full, result);

  const std::vector<Channel> torques = find_channels(system, model_case.torques);

  std::vector<Channel> deflections;
  if (!model_case.deflection.empty()) deflections = find_channels(system, {model_case.deflection});
  Peaks torque_peaks(torques), deflection_peaks(deflections), mesh_peaks(mesh_channels(system));
  ContactStatistics contacts(system);
  MeanSpeed speeds(system, result.span.from, duration);
  std::vector<Observer*> of_span{&torque_peaks, &deflection_peaks, &mesh_peaks, &contacts, &speeds};
  std::optional<RainflowWatch> rainflow;
  if (std::vector<RainflowChannel> counted = rainflow_channels(request, system); !counted.empty())
    of_span.push_back(&rainflow.emplace(std::move(counted)));
  std::optional<ElementTotals> totals;
  if (request.energy) of_span.push_back(&totals.emplace(system));
  AfterTime figures(result.span.from, std::move(of_span));
  std::optional<Peaks> whole;  // where the figures are of a part of the run
  if (result.span.from > 0.0) observers.insert(observers.begin(), &whole.emplace(torques));
  std::optional<RunUpWatch> run_up;
  const OrderShaft shaft = order_shaft(model_case.model, full, request.orders_of, duration);
  if (speed_range(full, duration).changes() || shaft.turned) {
    run_up.emplace(full, result.modes ? &*result.modes : nullptr, system, duration, tracked_channels(request),
                   plan.method.tolerance > 0.0, request.out || request.report || request.keeps_history,
                   shaft);
    for (Observer* observer : run_up->observers()) observers.insert(observers.begin(), observer);
  }
  observers.insert(observers.begin(), &figures);
  if (request.accuracy && !find_accuracy(request, full, plan.start ? plan.start->error : 0.0, result))
    return result;
  const Timer timer;
  try {
    Progress shown([&] { return why_long(system, result.method, duration); });
    const auto progress = [&](double part) {
      shown.update(part);
      return !interrupted() && output_fault().empty();
    };
    result.summary = run_method(system, result.method, {.t_end = duration, .progress = progress}, observers);
    result.status = to_text(result.summary.status);
    result.reason = result.summary.reason;
  } catch (const SolverError& error) {
    if (const auto* run = dynamic_cast<const RunError*>(&error)) result.summary = run->summary;
    result.status = "failed";
    result.reason = error.what();
    result.summary.scheme = result.method.name;
    result.summary.step = result.method.step;
  }
  if (!unsettled.empty()) result.summary.warnings.push_back(unsettled);
  for (const std::string& warning : soft_chain_warnings(full)) result.summary.warnings.push_back(warning);
  result.run_time = timer.seconds();
  if (const std::string fault = output_fault(); !fault.empty()) {
    result.status = "output_error";
    result.reason = fault + "; the run was given up at t = " + to_text(result.summary.t_end) + " s";
  }
  // What failed numerically has no figures.
  if (!figures.started()) return result;
  if (result.ok() || result.status == "energy_error" || result.status == "interrupted" ||
      result.status == "output_error") {
    result.force = largest_of(torques, torque_peaks.peaks());
    result.deflection = largest_of(deflections, deflection_peaks.peaks());
    result.mesh_force = largest_of(mesh_peaks.channels(), mesh_peaks.peaks());
    result.contacts = contacts_of(system, contacts);
    result.speeds = speeds.parts();
    if (run_up) result.run_up = run_up->result();
    result.sections = sections_of(request, full, torque_peaks, whole ? *whole : torque_peaks);
    if (rainflow) result.rainflow = rainflow->finish();
    if (totals) result.elements = totals->rows();
    if (result.accuracy) {
      take_figure(*result.accuracy, "peak torque", result.force);
      take_figure(*result.accuracy, "peak deflection", result.deflection);
      take_figure(*result.accuracy, "peak mesh force", result.mesh_force);
      take_contacts(*result.accuracy, result.contacts);
    }
    take_rounding(result.summary, result.force);
  }
  return result;
}

}  // namespace drev::app
