#include "app/fmi/fmu_instance.hpp"

#include <drev/app/model_file/model_file.hpp>
#include <drev/core/assembler.hpp>
#include <drev/core/control/sampled_controller.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/start.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/fmi/fmu_built.hpp"
#include "core/control/signal.hpp"
#include "solvers/exact/start_state.hpp"

namespace drev::app {

namespace {

constexpr double kProbe = 0.01;  // relative change of a parameter that is tried [-]

bool same_motion(const Motion* a, const Motion* b, double t) {
  const bool moves_a = a != nullptr && a->at, moves_b = b != nullptr && b->at;
  if (!moves_a || !moves_b) return moves_a == moves_b;
  const MotionPoint p = a->at(t), q = b->at(t);
  return p.value == q.value && p.rate == q.rate;
}

/// Whether a state of one system is also one of the other at time t, for the same motion.
bool same_unknowns(const System& a, const System& b, double t) {
  if (a.size() != b.size() || a.history_size() != b.history_size() || a.node_names() != b.node_names() ||
      a.prescribed_count() != b.prescribed_count())
    return false;
  if (!same_motion(a.reference() ? &*a.reference() : nullptr, b.reference() ? &*b.reference() : nullptr, t))
    return false;
  for (int i = 0; i < a.node_count(); ++i) {
    const NodeMap &m = a.node_map(i), &n = b.node_map(i);
    if (a.ratio(i) != b.ratio(i) || m.unknown != n.unknown || m.prescribed != n.prescribed ||
        m.coeff != n.coeff)
      return false;
  }
  for (int k = 0; k < a.prescribed_count(); ++k)
    if (!same_motion(&a.prescribed()[idx(k)], &b.prescribed()[idx(k)], t)) return false;
  return true;
}

}  // namespace

FmuInstance::FmuInstance(const std::string& resources)
    : folder_(resources),
      interface_(read_interface((std::filesystem::path(resources) / "interface.toml").string())) {
  const std::string path = (std::filesystem::path(folder_) / interface_.model).string();
  file_ = std::make_unique<ModelFile>(path, interface_.run);
  reset();
  std::vector<std::string> units;
  for (const Signal& output : built_->outputs) units.push_back(output.unit());
  variables_ = fmu_variables(interface_, file_->entry().parameters, built_->input_kinds(interface_), units);
}

FmuInstance::~FmuInstance() = default;

const std::vector<Parameter>& FmuInstance::parameters() const { return file_->entry().parameters; }
const ModelCase& FmuInstance::model_case() const { return built_->model_case; }

std::vector<std::string> FmuInstance::find_tunable() const {
  std::vector<std::string> all;
  const std::vector<Parameter>& known = parameters();
  for (std::size_t i = 0; i < known.size(); ++i) {
    double value = 0.0;
    if (known[i].kind != Parameter::Kind::number || !read_number(state_.parameters[i], value)) continue;
    const double step = value == 0.0 ? kProbe : kProbe * std::abs(value);
    std::vector<std::string> changed = state_.parameters;
    changed[i] = to_text(value + step <= known[i].high ? value + step : value - step);
    try {
      const std::unique_ptr<Built> built = build(changed);
      const System &now = built_->original, &other = built->original;
      if (same_unknowns(now, other, 0.0) && same_unknowns(now, other, model_case().duration) &&
          now.initial_deviation() == other.initial_deviation() && now.initial_rate() == other.initial_rate())
        all.push_back(known[i].name);
    } catch (const ModelError&) {  // the value is invalid: the parameter remains fixed
    }
  }
  return all;
}

std::unique_ptr<FmuInstance::Built> FmuInstance::build(const std::vector<std::string>& parameters) const {
  const ModelEntry& entry = file_->entry();
  Parameters values(entry.name, entry.parameters);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i] != entry.parameters[i].default_text)
      values.set(entry.parameters[i].name, parameters[i]);
  values.check();
  return std::make_unique<Built>(entry.build(std::move(values)), interface_);
}

void FmuInstance::reset() {
  FmuState fresh;
  const ModelEntry& entry = file_->entry();
  Parameters values = values_of(entry, interface_.parameters);
  values.check();
  fresh.parameters = values.values();
  std::unique_ptr<Built> built = build(fresh.parameters);
  fresh.torque_values.resize(interface_.torques.size());
  fresh.torques.resize(interface_.torques.size());
  for (const double speed : built->start_speeds) fresh.speed_values.push_back({speed, 0.0});
  fresh.speeds.resize(interface_.speeds.size());
  state_ = std::move(fresh);
  built_ = std::move(built);
}

void FmuInstance::require(bool right, const char* call, const char* when) const {
  if (!right) throw FmuError(std::string(call) + " " + when);
}

const FmuVariable& FmuInstance::variable(unsigned reference, FmuVariable::Type type) const {
  if (reference >= variables_.size())
    throw FmuError("there is no value reference " + std::to_string(reference) + "; the largest is " +
                   std::to_string(variables_.size() - 1));
  const FmuVariable& found = variables_[reference];
  if (found.type != type) {
    const char* names[] = {"a real number", "an integer", "a text"};
    throw FmuError("variable " + found.name + " is " + names[static_cast<int>(found.type)] + ", not " +
                   names[static_cast<int>(type)]);
  }
  return found;
}

const FmuVariable& FmuInstance::settable(unsigned reference, FmuVariable::Type type) const {
  const FmuVariable& found = variable(reference, type);
  using enum FmuVariable::Role;
  if (found.role == time || found.role == output) throw FmuError("variable " + found.name + " cannot be set");
  if (inside_.state != nullptr) throw FmuError("nothing can be set inside a step");
  if (state_.mode == FmuMode::terminated) throw FmuError("nothing can be set after termination");
  if (found.role == parameter && !found.tunable && state_.mode == FmuMode::step)
    throw FmuError("parameter " + found.name + " is fixed: it can be set before initialization ends");
  return found;
}

double FmuInstance::real(unsigned reference) {
  const FmuVariable& found = variable(reference, FmuVariable::Type::real);
  switch (found.role) {
    case FmuVariable::Role::time:
      if (inside_.state != nullptr) return inside_.state->t;
      return state_.mode == FmuMode::step || state_.mode == FmuMode::terminated ? state_.state.t
                                                                                : state_.t_start;
    case FmuVariable::Role::parameter: {
      double value = 0.0;
      read_number(state_.parameters[found.place], value);
      return value;
    }
    case FmuVariable::Role::torque:
      return state_.torque_values[found.place].value;
    case FmuVariable::Role::speed:
      return state_.speed_values[found.place].value;
    case FmuVariable::Role::output:
      break;
  }
  if (state_.mode == FmuMode::instantiated)
    throw FmuError("output " + found.name + " has no value before initialization");
  return output(found.place);
}

int FmuInstance::integer(unsigned reference) const {
  double value = 0.0;
  read_number(state_.parameters[variable(reference, FmuVariable::Type::integer).place], value);
  return static_cast<int>(value);
}

const std::string& FmuInstance::text(unsigned reference) const {
  return state_.parameters[variable(reference, FmuVariable::Type::text).place];
}

void FmuInstance::set_parameters(const std::vector<std::pair<std::size_t, std::string>>& values) {
  if (values.empty()) return;
  std::vector<std::string> all = state_.parameters;
  for (const auto& [place, value] : values) all[place] = value;
  std::unique_ptr<Built> built = build(all);
  if (state_.mode == FmuMode::step) {
    // Motions that are inputs are compared, too, at their current values.
    for (std::size_t i = 0; i < state_.speeds.size(); ++i) *built->speeds[i] = state_.speeds[i];
    if (!same_unknowns(built_->system, built->system, state_.state.t))
      throw FmuError(
          "parameter " + file_->entry().parameters[values.front().first].name +
          " cannot change so while the simulation runs: unknowns or given motions would be others");
    built_ = std::move(built);
    state_.parameters = std::move(all);
    hand_inputs_on();
    evaluate_start(built_->system, state_.state);
    return;
  }
  // A speed that was not set follows from the parameters.
  for (std::size_t i = 0; i < state_.speeds.size(); ++i)
    if (state_.speed_values[i].value == built_->start_speeds[i])
      state_.speed_values[i].value = built->start_speeds[i];
  built_ = std::move(built);
  state_.parameters = std::move(all);
  state_.started = false;
}

void FmuInstance::set_reals(const unsigned* references, const double* values, std::size_t count) {
  std::vector<std::pair<std::size_t, std::string>> parameters;
  for (std::size_t i = 0; i < count; ++i) {
    const FmuVariable& found = settable(references[i], FmuVariable::Type::real);
    if (!std::isfinite(values[i])) throw FmuError("variable " + found.name + " must be a finite number");
    if (found.role == FmuVariable::Role::parameter) parameters.emplace_back(found.place, to_text(values[i]));
  }
  set_parameters(parameters);
  for (std::size_t i = 0; i < count; ++i) {
    const FmuVariable& found = variables_[references[i]];
    if (found.role == FmuVariable::Role::torque)
      state_.torque_values[found.place].value = values[i];
    else if (found.role == FmuVariable::Role::speed)
      state_.speed_values[found.place].value = values[i];
  }
  if (state_.mode != FmuMode::step) state_.started = false;
}

void FmuInstance::set_integers(const unsigned* references, const int* values, std::size_t count) {
  std::vector<std::pair<std::size_t, std::string>> parameters;
  for (std::size_t i = 0; i < count; ++i)
    parameters.emplace_back(settable(references[i], FmuVariable::Type::integer).place,
                            std::to_string(values[i]));
  set_parameters(parameters);
}

void FmuInstance::set_texts(const unsigned* references, const std::vector<std::string>& values) {
  std::vector<std::pair<std::size_t, std::string>> parameters;
  for (std::size_t i = 0; i < values.size(); ++i)
    parameters.emplace_back(settable(references[i], FmuVariable::Type::text).place, values[i]);
  set_parameters(parameters);
}

void FmuInstance::set_input_slopes(const unsigned* references, const double* values, std::size_t count) {
  for (const bool check : {true, false})
    for (std::size_t i = 0; i < count; ++i) {
      const FmuVariable& found = settable(references[i], FmuVariable::Type::real);
      const bool torque = found.role == FmuVariable::Role::torque;
      if (!torque && found.role != FmuVariable::Role::speed)
        throw FmuError("variable " + found.name + " is no input");
      if (!std::isfinite(values[i])) throw FmuError("the derivative of " + found.name + " must be finite");
      if (check) continue;
      (torque ? state_.torque_values : state_.speed_values)[found.place].slope = values[i];
    }
}

void FmuInstance::enter_initialization(double t_start, std::optional<double> t_stop, double tolerance) {
  require(state_.mode == FmuMode::instantiated, "initialization",
          "begins once, after instantiation or reset");
  if (!std::isfinite(t_start)) throw FmuError("the start time must be finite");
  if (t_stop && !(*t_stop >= t_start))
    throw FmuError("the stop time is " + to_text(*t_stop) + " s; it must be >= the start time, " +
                   to_text(t_start) + " s");
  if (!(tolerance == 0.0 ||
        (tolerance >= ExactOptions::kTolerance.low && tolerance <= ExactOptions::kTolerance.high)))
    throw FmuError("the tolerance is " + to_text(tolerance) + "; it must be " +
                   to_text(ExactOptions::kTolerance.low) + " to " + to_text(ExactOptions::kTolerance.high));
  state_.mode = FmuMode::initialization;
  state_.t_start = t_start;
  state_.t_stop = t_stop && std::isfinite(*t_stop) ? t_stop : std::nullopt;
  state_.tolerance = tolerance;
  state_.started = false;
}

std::string FmuInstance::exit_initialization() {
  require(state_.mode == FmuMode::initialization, "initialization", "has not begun");
  if (!state_.started) start();
  state_.mode = FmuMode::step;
  return start_warning_;
}

void FmuInstance::terminate() {
  require(state_.mode == FmuMode::step, "termination", "is of a simulation that runs");
  state_.mode = FmuMode::terminated;
}

void FmuInstance::start() {
  for (std::size_t i = 0; i < state_.torques.size(); ++i)
    state_.torques[i] = {state_.t_start, state_.torque_values[i].value, 0.0};
  for (std::size_t i = 0; i < state_.speeds.size(); ++i)
    state_.speeds[i] = {{state_.t_start, state_.speed_values[i].value, 0.0}, built_->start_deviations[i]};
  hand_inputs_on();
  start_warning_.clear();
  const ModelCase& model_case = built_->model_case;
  if (model_case.start == Start::rest) {
    state_.state = State::initial(built_->system, state_.t_start);
  } else {
    const auto& reference = built_->system.reference();
    const double speed = built_->system.reference_speed();
    const bool constant =
        reference && speed > 0.0 && reference->at(model_case.duration).rate == reference->at(0.0).rate;
    const FoundStart found =
        find_start(built_->system, model_case.start,
                   {.cycle = constant && model_case.static_turn > 0.0 ? model_case.static_turn / speed : 0.0,
                    .duration = model_case.duration,
                    .method = {.name = kExact, .tolerance = ExactOptions{}.tolerance}});
    state_.state = State::initial(found.system, state_.t_start);
    start_warning_ = found.unsettled();
  }
  evaluate_start(built_->system, state_.state);
  state_.started = true;
}

void FmuInstance::set_state(const FmuState& state) {
  if (state.parameters.size() != state_.parameters.size() || state.torques.size() != state_.torques.size() ||
      state.speeds.size() != state_.speeds.size() ||
      state.torque_values.size() != state_.torque_values.size() ||
      state.speed_values.size() != state_.speed_values.size())
    throw FmuError("the state is of another model");
  std::unique_ptr<Built> built;
  if (state.parameters != state_.parameters) built = build(state.parameters);
  const System& system = built ? built->system : built_->system;
  for (const Vector* part : {&state.state.z, &state.state.v, &state.state.a})
    if (state.started && part->size() != system.size()) throw FmuError("the state is of another model");
  if (state.started && state.state.history.size() != system.history_size())
    throw FmuError("the state is of another model");
  if ((state.mode == FmuMode::step || state.mode == FmuMode::terminated) && !state.started)
    throw FmuError("the state is none that a simulation can be in");
  if (built) built_ = std::move(built);
  state_ = state;
  hand_inputs_on();
}

}  // namespace drev::app
