#include "solvers/transient.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace drev {

namespace {

constexpr long kProgressSteps = 100;
constexpr double kSameTime = 1e-9;  // relative to the step

void check_options(const System& system, const TransientOptions& o, const State& state) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/transient", findings);
  check.positive("step", o.step, "s");
  check.finite("t_start", o.t_start, "s");
  if (!(o.t_end > o.t_start) || !std::isfinite(o.t_end))
    check.fail("t_end", to_text(o.t_end), "s", "must be greater than t_start = " + to_text(o.t_start));
  if (o.max_halvings < 0 || o.max_halvings > 40)
    check.fail("max_halvings", std::to_string(o.max_halvings), "", "must be between 0 and 40");
  check.positive("energy_tolerance", o.energy_tolerance, "");
  if (state.z.size() != system.size() || state.v.size() != system.size())
    check.fail("state", std::to_string(state.z.size()), "unknowns",
               "must have " + std::to_string(system.size()));
  else if (!state.z.allFinite() || !state.v.allFinite() || !state.history.allFinite())
    check.fail("state", "not finite", "", "must be finite");
  if (state.history.size() != system.history_size())
    check.fail("state's history", std::to_string(state.history.size()), "numbers",
               "must have " + std::to_string(system.history_size()));
  if (!findings.empty()) throw ModelError(findings);
}

/// One run: the loop over stops, the steps between them, and what is kept about it.
class Run {
 public:
  Run(const System& system, const TransientOptions& options, State& state,
      const std::vector<Observer*>& observers)
      : system_(system),
        options_(options),
        observers_(observers),
        solver_(system, options.scheme, options.newton) {
    now_.state = std::move(state);
    now_.state.t = options.t_start;
    summary_.scheme = options.scheme.name;
    summary_.step = options.step;
  }

  RunSummary run() {
    solver_.start(now_);
    EnergyMonitor energy(solver_.assembler(), now_);
    energy_ = &energy;
    for (Observer* o : observers_) o->start(solver_.assembler(), now_);
    if (!now_.state.a.allFinite()) fail(RunStatus::not_finite, "the initial acceleration");
    while (summary_.status == RunStatus::success && now_.state.t < options_.t_end) run_to_next_stop();
    summary_.t_end = now_.state.t;
    summary_.load_passes = solver_.load_passes();
    summary_.factorizations = solver_.factorizations();
    summary_.newton_on_contacts = solver_.dense_contacts();
    summary_.energy = energy.balance();
    if (solver_.clock().on()) {
      solver_.clock().enter(Phase::observers);
      const PhaseClock& clock = solver_.clock();
      summary_.phases = {{"loads", clock.seconds(Phase::loads)},
                         {"linear", clock.seconds(Phase::linear)},
                         {"contacts", clock.seconds(Phase::contacts)},
                         {"balance", clock.seconds(Phase::balance)},
                         {"observers", clock.seconds(Phase::observers)}};
    }
    judge_energy();
    return summary_;
  }

  State take_state() { return std::move(now_.state); }

 private:
  void run_to_next_stop() {
    const double t = now_.state.t;
    const auto& breaks = system_.breakpoints();
    const auto next_break = std::upper_bound(breaks.begin(), breaks.end(), t);
    const double same = kSameTime * options_.step;
    double stop = options_.t_end;
    if (next_break != breaks.end()) stop = std::min(stop, *next_break);
    for (const Observer* o : observers_) {
      const double wanted = o->next_stop(t);
      if (wanted > t + same) stop = std::min(stop, wanted);
    }
    // Stops that differ by rounding are one.
    if (options_.t_end - stop <= same) stop = options_.t_end;
    const bool at_break = next_break != breaks.end() && *next_break - stop <= same;
    if (at_break) stop = *next_break;
    const double count = std::max(1.0, std::ceil((stop - t) / options_.step - 1e-6));
    const double h = (stop - t) / count;
    for (double i = 1.0; i <= count && summary_.status == RunStatus::success; i += 1.0) {
      const bool last = i == count;
      const double t_new = last ? stop : t + i * h;
      // Just before a breakpoint the loads have their old values.
      const double t_evaluate =
          last && at_break ? std::nextafter(stop, -std::numeric_limits<double>::infinity()) : t_new;
      advance(h, t_new, t_evaluate, 0);
    }
    if (at_break && summary_.status == RunStatus::success && now_.state.t < options_.t_end) {
      next_ = now_;
      solver_.start(now_);
      energy_->restart(next_, now_);
    }
  }

  void advance(double h, double t_new, double t_evaluate, int depth) {
    const NewtonResult result = solver_.step(now_, h, t_new, t_evaluate, next_);
    summary_.iterations += result.iterations;
    if (result.status == NewtonStatus::converged) {
      accept(h);
      return;
    }
    if (result.status == NewtonStatus::not_finite && depth == options_.max_halvings)
      return fail(RunStatus::not_finite, to_text(result.status));
    if (depth == options_.max_halvings)
      return fail(RunStatus::no_convergence,
                  std::string(to_text(result.status)) + " even with h = " + to_text(h) + " s");
    ++summary_.halved;
    const double middle = now_.state.t + 0.5 * h;
    advance(0.5 * h, middle, middle, depth + 1);
    if (summary_.status == RunStatus::success) advance(0.5 * h, t_new, t_evaluate, depth + 1);
  }

  void accept(double h) {
    ++summary_.steps;
    if (!next_.state.z.allFinite() || !next_.state.v.allFinite()) {
      for (int k = 0; k < system_.size(); ++k)
        if (!std::isfinite(next_.state.z[k]) || !std::isfinite(next_.state.v[k]))
          return fail(RunStatus::not_finite, "the motion of " + system_.unknown_name(k));
    }
    solver_.clock().enter(Phase::balance);
    energy_->step(now_, next_, h);
    solver_.clock().enter(Phase::observers);
    for (Observer* o : observers_) o->step(solver_.assembler(), now_, next_);
    std::swap(now_, next_);
    if (options_.progress && summary_.steps % kProgressSteps == 0 &&
        !options_.progress((now_.state.t - options_.t_start) /
                           (options_.t_end - options_.t_start)))
      return fail(RunStatus::interrupted, "interrupted");
    const EnergyBalance& b = energy_->balance();
    if (!std::isfinite(b.imbalance)) return fail(RunStatus::not_finite, "the energy");
    if (b.imbalance > options_.energy_growth_limit * b.given && b.given > 0.0)
      fail(RunStatus::unstable,
           "energy grew from nothing to more than " + to_text(options_.energy_growth_limit) +
               " times what was put in; take a smaller step or a method that damps");
  }

  void judge_energy() {
    const EnergyBalance& b = summary_.energy;
    if (summary_.status != RunStatus::success) return;
    const double error = b.relative_error();
    if (std::abs(error) <= options_.energy_tolerance) return;
    std::ostringstream text;
    text << "the energy balance is off by " << 100.0 * error << " % ("
         << (error > 0 ? "gained from nothing" : "lost by the method") << ", worst at t = "
         << b.worst_time << " s; at most " << 100.0 * options_.energy_tolerance
         << " % passes): take a smaller step";
    summary_.status = RunStatus::energy_error;
    summary_.reason = text.str();
  }

  void fail(RunStatus status, const std::string& what) {
    if (summary_.status != RunStatus::success) return;
    summary_.status = status;
    std::ostringstream text;
    text.precision(12);
    text << system_.name() << ": at t = " << now_.state.t << " s: " << what;
    summary_.reason = text.str();
  }

  const System& system_;
  const TransientOptions& options_;
  const std::vector<Observer*>& observers_;
  StepSolver solver_;
  StepPoint now_, next_;
  EnergyMonitor* energy_ = nullptr;
  RunSummary summary_;
};

}  // namespace

const char* to_text(RunStatus status) {
  switch (status) {
    case RunStatus::success: return "success";
    case RunStatus::energy_error: return "energy_error";
    case RunStatus::unstable: return "unstable";
    case RunStatus::no_convergence: return "no_convergence";
    case RunStatus::not_finite: return "not_finite";
    case RunStatus::interrupted: return "interrupted";
  }
  return "unknown";
}

std::string RunSummary::brief_report() const {
  std::ostringstream text;
  text << scheme;
  if (step > 0.0) text << ", h = " << step << " s";
  text << ": " << to_text(status) << " at t = " << t_end << " s, " << steps << " steps";
  if (step > 0.0)
    text << " (" << halved << " halved), " << iterations << " iterations, ";
  else
    text << ", " << contact_changes << " contact changes, ";
  text << "energy error " << energy.relative_error();
  if (!reason.empty()) text << "; " << reason;
  return text.str();
}

RunSummary simulate(const System& system, const TransientOptions& options, State& state,
                    const std::vector<Observer*>& observers) {
  check_options(system, options, state);
  Run run(system, options, state, observers);
  try {
    RunSummary summary = run.run();
    state = run.take_state();
    return summary;
  } catch (...) {  // a user's function threw: the last accepted state is not lost
    state = run.take_state();
    throw;
  }
}

RunSummary simulate(const System& system, const TransientOptions& options,
                    const std::vector<Observer*>& observers) {
  State state = State::initial(system, options.t_start);
  return simulate(system, options, state, observers);
}

}  // namespace drev
