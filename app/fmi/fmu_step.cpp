// The second part of FmuInstance: communication steps, outputs, and their derivatives by the inputs.
#include <drev/solvers/run/observer.hpp>

#include <algorithm>
#include <limits>

#include "app/fmi/fmu_built.hpp"
#include "solvers/exact/start_state.hpp"
#include "solvers/run/run_verdict.hpp"

namespace drev::app {

namespace {

constexpr double kSameTime = 1e-9;  // difference of equal times relative to the communication step [-]
constexpr double kSum =
    1e-3;  // of the step: what an importer's sum of many steps may be off by at the stop time
constexpr double kDefaultTolerance = 1e-10;
constexpr double kChange =
    1e-4;  // of an input, for derivatives: relative, or in its unit where it is less than 1

}  // namespace

/// Calls the importer at the points of the step that a run's observers see.
class FmuInstance::Inside final : public Observer {
 public:
  Inside(FmuInstance& of, const std::function<void(double t)>& tell) : of_(of), tell_(tell) {}
  ~Inside() override { of_.inside_ = {}; }
  void start(const Assembler& /*assembler*/, const EvaluatedState& /*point*/) override {}
  void step(const Assembler& assembler, const EvaluatedState& /*from*/, const EvaluatedState& to) override {
    of_.inside_ = {&assembler, &to.state};
    tell_(to.state.t);
    of_.inside_ = {};
  }

 private:
  FmuInstance& of_;
  const std::function<void(double t)>& tell_;
};

void FmuInstance::hand_inputs_on() {
  for (std::size_t i = 0; i < state_.torques.size(); ++i) *built_->torques[i] = state_.torques[i];
  for (std::size_t i = 0; i < state_.speeds.size(); ++i) *built_->speeds[i] = state_.speeds[i];
  built_->assembled = std::nan("");
}

/// The deviation that speed input i has reached at time t, from which the motion of the next step continues.
double FmuInstance::reached(const SpeedInput& input, std::size_t i, double t) const {
  const double ratio = built_->original.ratio(built_->original.node(interface_.speeds[i]));
  return input.at(t, ratio, built_->system.reference()).value;
}

/// Time of the first contact change after the start of a run and up to its end; the state is not changed. One at the very start
/// is of the step before.
std::optional<double> FmuInstance::first_change(const ExactOptions& options) {
  const double near = kSameTime * (options.t_end - options.t_start);
  std::optional<double> first;
  ExactOptions watched = options;
  watched.t_end += near;
  watched.on_change = [&](const ContactChange& change) {
    if (first || change.t <= options.t_start + near) return;
    first = change.t < options.t_end - near ? change.t : options.t_end;
  };
  State state = state_.state;
  propagate(built_->system, watched, state);
  return first;
}

FmuStepped FmuInstance::step(double t, double h, const FmuStepWishes& wishes) {
  require(state_.mode == FmuMode::step, "a step", "is made after initialization and before termination");
  if (!std::isfinite(t) || !std::isfinite(h) || !(h > 0.0))
    throw FmuError("the communication step must be > 0 and finite; it is " + to_text(h) + " s");
  const double now = state_.state.t;
  if (!(std::abs(t - now) <= kSameTime * h + 1e-14 * std::abs(now)))
    throw FmuError("the communication point is " + to_text(t) + " s, but the last step ended at " +
                   to_text(now) + " s");
  if (state_.t_stop && t + h > *state_.t_stop + kSum * h)
    throw FmuError("the step from " + to_text(t) + " s to " + to_text(t + h) + " s passes the stop time, " +
                   to_text(*state_.t_stop) + " s");
  if (!(t + h > t)) throw FmuError("a step of " + to_text(h) + " s does not advance the time " + to_text(t));
  require(inside_.state == nullptr, "a step", "is not made inside another");
  const FmuState before = state_;
  try {
    for (std::size_t i = 0; i < state_.torques.size(); ++i)
      state_.torques[i] = {t, state_.torque_values[i].value, state_.torque_values[i].slope};
    for (std::size_t i = 0; i < state_.speeds.size(); ++i) {
      const double deviation = reached(state_.speeds[i], i, t);
      state_.speeds[i] = {{t, state_.speed_values[i].value, state_.speed_values[i].slope}, deviation};
    }
    hand_inputs_on();
    // The tolerance of the whole simulation, divided among its steps.
    const double span = state_.t_stop && *state_.t_stop > state_.t_start ? *state_.t_stop - state_.t_start
                                                                         : built_->model_case.duration;
    const double whole = state_.tolerance > 0.0 ? state_.tolerance : kDefaultTolerance;
    const Range range = ExactOptions::kTolerance;
    ExactOptions options{.tolerance = std::clamp(whole * std::min(1.0, h / span), range.low, range.high),
                         .t_start = t,
                         .t_end = t + h};
    FmuStepped stepped;
    if (wishes.end_at_change)
      if (const std::optional<double> change = first_change(options)) {
        options.t_end = *change;
        stepped.at_change = true;
      }
    Inside inside(*this, wishes.inside);
    std::vector<Observer*> observers;
    if (wishes.inside) observers.push_back(&inside);
    const RunSummary summary = propagate(built_->system, options, state_.state, observers);
    if (!summary.ok() && summary.status != RunStatus::energy_error) throw SolverError(summary.reason);
    for (auto* values : {&state_.torque_values, &state_.speed_values})
      for (InputValue& input : *values) input.slope = 0.0;
    built_->assembled = std::nan("");
    stepped.warning = summary.reason;
    return stepped;
  } catch (...) {
    state_ = before;
    hand_inputs_on();
    throw;
  }
}

double FmuInstance::output(std::size_t place) {
  if (inside_.state != nullptr) return built_->outputs[place].evaluate(*inside_.assembler, *inside_.state);
  if (!state_.started) start();
  Built& built = *built_;
  if (built.assembled != state_.state.t) {
    built.assembler.set_time(state_.state.t);
    built.assembled = state_.state.t;
  }
  return built.outputs[place].evaluate(built.assembler, state_.state);
}

std::vector<double> FmuInstance::directional_derivative(const std::vector<unsigned>& unknowns,
                                                        const std::vector<unsigned>& knowns,
                                                        const std::vector<double>& seed) {
  using enum FmuVariable::Role;
  require(state_.mode == FmuMode::step || state_.mode == FmuMode::initialization, "a derivative",
          "is asked for after initialization has begun and before termination");
  require(inside_.state == nullptr, "a derivative", "is not asked for inside a step");
  require(built_->system.frictions().empty(), "a derivative", "is not known where there is dry friction");
  std::vector<std::size_t> places;
  for (const unsigned reference : unknowns) {
    const FmuVariable& v = variable(reference, FmuVariable::Type::real);
    if (v.role != output) throw FmuError("variable " + v.name + " is no output");
    places.push_back(v.place);
  }
  double size = 1.0, direction = 0.0;
  for (std::size_t i = 0; i < knowns.size(); ++i) {
    const FmuVariable& v = variable(knowns[i], FmuVariable::Type::real);
    if (v.role != torque && v.role != speed) throw FmuError("variable " + v.name + " is no input");
    if (!std::isfinite(seed[i])) throw FmuError("the seed of variable " + v.name + " is not finite");
    size = std::max(size, std::abs(real(knowns[i])));
    direction = std::max(direction, std::abs(seed[i]));
  }
  std::vector<double> slopes(unknowns.size(), 0.0);
  if (direction == 0.0) return slopes;
  if (!state_.started) start();
  const FmuState before = state_;
  const double t = state_.state.t, change = kChange * size / direction;
  try {
    for (const double side : {1.0, -1.0}) {
      state_ = before;
      for (std::size_t i = 0; i < state_.torques.size(); ++i)
        state_.torques[i] = {t, state_.torque_values[i].value, 0.0};
      for (std::size_t i = 0; i < state_.speeds.size(); ++i)
        state_.speeds[i] = {{t, state_.speed_values[i].value, 0.0}, reached(before.speeds[i], i, t)};
      for (std::size_t i = 0; i < knowns.size(); ++i) {
        const FmuVariable& v = variables_[knowns[i]];
        InputSignal& signal = v.role == torque ? state_.torques[v.place] : state_.speeds[v.place].signal;
        signal.value += side * change * seed[i];
      }
      hand_inputs_on();
      evaluate_start(built_->system, state_.state);
      for (std::size_t i = 0; i < places.size(); ++i)
        slopes[i] += side * this->output(places[i]) / (2.0 * change);
    }
  } catch (...) {
    state_ = before;
    hand_inputs_on();
    throw;
  }
  state_ = before;
  hand_inputs_on();
  return slopes;
}

}  // namespace drev::app
