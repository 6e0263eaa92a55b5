#include "solvers/run/control_run.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/control/sampled_controller.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/run/run_verdict.hpp"

namespace drev {

namespace {
constexpr double kSamePoint = 1e-9;  // distance of equal times over a communication step
}

ControlRun::ControlRun(const System& system, double t_start, double t_end)
    : system_(system), t_start_(t_start), t_end_(t_end) {
  check_controllers(system);
  for (const auto& [name, controller] : sampled_controllers(system)) {
    if (!controller->acquire()) {
      for (const Controlled& c : all_) c.controller->release();
      throw SolverError(
          system.name() + ": " + name +
          " is in use by another run: a controller takes part in one run at a time; build the model again");
    }
    all_.push_back({name, controller, find_signals(system, controller->inputs())});
  }
}

ControlRun::~ControlRun() {
  for (Controlled& c : all_) {
    c.session.reset();
    c.controller->release();
  }
}

void ControlRun::start(const Assembler& assembler, const State& state) {
  for (Controlled& c : all_) {
    c.inputs.resize(c.signals.size());
    c.outputs.resize(c.controller->output_count());
    ask(c, assembler, state, true);
  }
}

double ControlRun::point(const Controlled& c, double number) const {
  return t_start_ + number * c.controller->step();
}

double ControlRun::next_stop(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const Controlled& c : all_) {
    const double h = c.controller->step();
    const double wanted = point(c, c.points + 1.0);
    // The last step of a run may be a short one; then its end is no communication point.
    if (wanted > t && wanted < t_end_ - kSamePoint * h) next = std::min(next, wanted);
  }
  return next;
}

void ControlRun::sample(const Assembler& assembler, const State& state) {
  for (Controlled& c : all_)
    if (state.t >= point(c, c.points + 1.0) - kSamePoint * c.controller->step())
      ask(c, assembler, state, false);
}

void ControlRun::warn(RunSummary& summary) const {
  for (const Controlled& c : all_)
    if (const std::string warning = c.session ? c.session->warning() : ""; !warning.empty())
      summary.warnings.push_back(c.name + ": " + warning);
}

void ControlRun::ask(Controlled& c, const Assembler& assembler, const State& state, bool first) {
  const std::vector<double> before = c.inputs, outputs = c.outputs;
  for (std::size_t i = 0; i < c.signals.size(); ++i) {
    c.inputs[i] = c.signals[i].evaluate(assembler, state);
    if (!std::isfinite(c.inputs[i]))
      throw SolverError(at_time(system_.name(), state.t) + c.name + ": its input " + c.signals[i].name() +
                        " is not finite");
  }
  try {
    if (first) c.session = c.controller->open(t_start_, t_end_);
    if (first)
      c.session->start(c.inputs, c.outputs);
    else
      c.session->step(point(c, c.points), c.controller->step(), before, c.inputs, c.outputs);
  } catch (const std::exception& error) {
    throw SolverError(at_time(system_.name(), state.t) + c.name + ": " + error.what());
  }
  if (!first) c.points += 1.0;
  for (std::size_t j = 0; j < c.outputs.size(); ++j) {
    if (!std::isfinite(c.outputs[j]))
      throw SolverError(at_time(system_.name(), state.t) + c.name + ": its output " + std::to_string(j + 1) +
                        " is not finite");
    const bool sloped = !first && c.controller->hold() == Hold::first_order;
    c.controller->set(j, point(c, c.points), c.outputs[j],
                      sloped ? (c.outputs[j] - outputs[j]) / c.controller->step() : 0.0);
  }
}

}  // namespace drev
