#include "solvers/run/run_verdict.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>

#include <cmath>
#include <sstream>

namespace drev {

namespace {

constexpr const char* kTooLarge =
    "the energy is more than a number can hold; check the largest stiffness, inertia and load";
constexpr double kLost = 0x1p-52;  // part of a sum of which rounding leaves nothing

/// Entry (i, i) of the matrix with these values.
double diagonal(const System& system, const Vector& values, int i) {
  return values[system.diagonal_slots()[idx(i)]];
}

const std::string& name_of(const System& system, ElementId element) {
  return system.element_instances()[idx(index(element))].name;
}

/// The first law of a step whose force, stored energy or dissipated power is not finite; empty: none. Sets t to when: on a straight
/// line between two motions that are finite, which is how they move but for the curvature in the step.
std::string law_not_finite_along(const Assembler& assembler, const State& from, const State& to, double& t) {
  constexpr int kLooks = 16;
  const System& system = assembler.system();
  EvaluatedState point;
  point.state = to;
  for (int i = 1; i <= kLooks; ++i) {
    const double s = static_cast<double>(i) / kLooks;
    point.state.t = from.t + s * (to.t - from.t);
    point.state.z = from.z + s * (to.z - from.z);
    point.state.v = from.v + s * (to.v - from.v);
    evaluate_laws(assembler, point);
    for (std::size_t j = 0; j < point.responses.size(); ++j) {
      const ScalarResponse& r = point.responses[j];
      const char* what = !std::isfinite(r.y)                  ? "the force of "
                         : !std::isfinite(r.stored_energy)    ? "the stored energy of "
                         : !std::isfinite(r.dissipated_power) ? "the dissipated power of "
                                                              : nullptr;
      if (what == nullptr) continue;
      t = point.state.t;
      return what + name_of(system, system.scalars()[j].element);
    }
  }
  return "";
}

}  // namespace

std::string why_no_factor(const System& system, const std::string& scheme, double h, const Weights& weights) {
  const std::string what =
      system.name() + ": the step matrix of " + scheme + " at h = " + to_text(h) + " s is not ";
  for (int i = 0; i < system.size(); ++i) {
    const double mass = weights.m * diagonal(system, system.mass_values(), i);
    const double rest = weights.c * diagonal(system, system.damping_values(), i) +
                        weights.k * diagonal(system, system.stiffness_values(), i);
    if (!std::isfinite(mass + rest)) return what + "finite; check the largest inertia, damping and stiffness";
    if (mass > 0.0 && mass < kLost * rest)
      return what +
             "positive definite: so long a step, or so stiff a part, leaves nothing of the inertia of " +
             system.unknown_name(i) + "; take a shorter step";
  }
  return what + "positive definite; is a stiffness negative?";
}

std::string at_time(const std::string& system, double t) {
  std::ostringstream text;
  text.precision(12);
  text << system << ": at t = " << t << " s: ";
  return text.str();
}

void end_run(RunSummary& summary, const std::string& system, double t, RunStatus status,
             const std::string& what) {
  if (!summary.ok()) return;
  summary.status = status;
  summary.reason = at_time(system, t) + what;
}

void end_interrupted(RunSummary& summary, const std::string& system, double t) {
  end_run(summary, system, t, RunStatus::interrupted, "interrupted");
}

std::string what_is_not_finite(const Assembler& assembler, const EvaluatedState& from,
                               const EvaluatedState& to) {
  const System& system = assembler.system();
  EvaluatedState point;
  // Where the step began, then where it led to: its own end is no number any more.
  for (const double ahead : {0.0, assembler.time() - from.state.t}) {
    point.state = from.state;
    point.state.z += ahead * from.state.v;
    for (const LoadTerm& load : system.loads()) {
      const LoadResponse r = assembler.load(load, point.state.z, point.state.v);
      if (!std::isfinite(r.torque)) return "the load of " + name_of(system, load.element);
      if (!std::isfinite(r.dtorque_dangle) || !std::isfinite(r.dtorque_dspeed))
        return "the slope of the load of " + name_of(system, load.element);
    }
    evaluate_laws(assembler, point);
    for (std::size_t j = 0; j < point.responses.size(); ++j)
      if (!std::isfinite(point.responses[j].y))
        return "the force of " + name_of(system, system.scalars()[j].element);
  }
  for (int k = 0; k < system.size(); ++k)
    if (!std::isfinite(to.state.z[k]) || !std::isfinite(to.state.v[k]))
      return "the motion of " + system.unknown_name(k);
  return "";
}

void end_not_finite(RunSummary& summary, const Assembler& assembler, const EvaluatedState& from,
                    const EvaluatedState& to) {
  double t = from.state.t;
  std::string what = what_is_not_finite(assembler, from, to);
  if (what.empty()) what = law_not_finite_along(assembler, from.state, to.state, t);
  end_run(summary, assembler.system().name(), t, RunStatus::not_finite,
          what.empty() ? kTooLarge : what + " is not finite");
}

void check_start(RunSummary& summary, const Assembler& assembler, const EvaluatedState& start) {
  if (start.state.a.allFinite()) return;
  const std::string what = what_is_not_finite(assembler, start, start);
  end_run(summary, assembler.system().name(), start.state.t, RunStatus::not_finite,
          (what.empty() ? "the initial acceleration" : what) + " is not finite");
}

void end_growing_run(RunSummary& summary, const std::string& system, double t, double growth_limit) {
  end_run(summary, system, t, RunStatus::unstable,
          "energy grew from nothing to more than " + to_text(growth_limit) +
              " times what was put in; take a smaller step or a method that damps");
}

void judge_energy(RunSummary& summary, double tolerance) {
  const EnergyBalance& b = summary.energy;
  if (!summary.ok()) return;
  const double error = b.relative_error();
  if (std::abs(error) <= tolerance || std::abs(b.worst_imbalance) <= b.rounding) return;
  if (!std::isfinite(error)) {
    summary.status = RunStatus::not_finite;
    summary.reason = kTooLarge;
    return;
  }
  std::ostringstream text;
  text << "the energy balance is off by " << 100.0 * error << " % ("
       << (error > 0 ? "gained from nothing" : "lost by the method") << ", worst at t = " << b.worst_time
       << " s; at most " << 100.0 * tolerance << " % passes): "
       << (summary.step > 0.0 && summary.tolerance == 0.0 ? "take a smaller step"
                                                          : "ask for a smaller tolerance");
  summary.status = RunStatus::energy_error;
  summary.reason = text.str();
}

}  // namespace drev
