#include <drev/core/law/friction.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/run/control_run.hpp"
#include "solvers/run/energy_monitor.hpp"
#include "solvers/run/progress.hpp"
#include "solvers/run/run_checks.hpp"
#include "solvers/run/run_verdict.hpp"
#include "solvers/run/stops.hpp"
#include "solvers/stepping/butcher_tableau.hpp"
#include "solvers/stepping/coarse_steps.hpp"
#include "solvers/stepping/halved_step.hpp"
#include "solvers/stepping/located_step.hpp"
#include "solvers/stepping/stability_limit.hpp"
#include "solvers/stepping/step_control.hpp"
#include "solvers/stepping/step_energy.hpp"

namespace drev {

namespace {

constexpr double kChosenStep = 0.1;      // first step times the fastest eigenvalue
constexpr double kLargestStep = 0.05;    // largest step over the duration of the run
constexpr double kBehindBreak = 8.3e-5;  // longest step behind a breakpoint over it, where a load is called
constexpr double kRoundedStep = 1e7;  // longest step times it: near 1e8 rounding leaves nothing of M beside K
constexpr double kLeastStep = 1e-9;   // step over the duration that is not rejected for its error
constexpr double kNoStep = 4e-15;     // step over the time of the run with which it hardly goes on any more
constexpr double kStanding = 1e-3;    // part of a step within which changes are counted together
constexpr double kCoarseSteps = 200;  // steps of the run that finds the scales
constexpr double kLeastShare = 1e-3;  // share of the energy error that any step may have
constexpr int kEnergyTries = 3;

/// One run: the loop over stops, the steps between them, and what is kept about it.
class Run final : public StepMotion {
 public:
  Run(const System& system, const TransientOptions& options, State& state,
      const std::vector<Observer*>& observers)
      : system_(system),
        options_(options),
        observers_(observers),
        stepper_(make_stepper(system, options.scheme, step_options(options))),
        equation_(stepper_->equation()),
        look_assembler_(system),
        located_(system, *stepper_),
        progress_(options.progress, options.t_start, options.t_end),
        coarse_(system) {
    now_->state = std::move(state);
    now_->state.t = options.t_start;
    for (EvaluatedState& point : points_) make_room(point, system.size());
    summary_.scheme = options.scheme.name;
    summary_.step = options.step;
    summary_.tolerance = options.tolerance;
    locates_ = options.locate_contacts.value_or(options.tolerance > 0.0);
    if (options.tolerance > 0.0) set_control();
  }

  RunSummary run() {
    stepper_->start(*now_);
    ControlRun controls(system_, options_.t_start, options_.t_end);
    controls_ = &controls;
    if (!controls.empty()) {
      controls.start(equation_.assembler(), now_->state);
      stepper_->start(*now_);
    }
    EnergyMonitor energy(equation_.assembler(), *now_);
    energy_ = &energy;
    for (Observer* o : observers_) o->look_through(*this);
    for (Observer* o : observers_) o->start(equation_.assembler(), *now_);
    if (control_) control_->look_at(now_->state);
    check_start(summary_, equation_.assembler(), *now_);
    // Controlled steps pass what observers ask for, and are interpolated there.
    const Stops stops(system_, options_.t_end,
                      kSameStop * (options_.step > 0.0 ? options_.step : kLargestStep * duration()),
                      control_ ? std::vector<Observer*>{} : observers_, &controls);
    while (running() && now_->state.t < options_.t_end) run_to(stops.after(now_->state.t));
    summary_.t_end = now_->state.t;
    summary_.load_passes = equation_.load_passes();
    summary_.factorizations += equation_.factorizations();
    summary_.newton_on_contacts = equation_.dense_contacts();
    summary_.solves = coarse_solves_ + equation_.solves();
    summary_.energy = energy.balance();
    if (equation_.clock().on()) {
      equation_.clock().enter(RunSection::observers);
      const RunClock& clock = equation_.clock();
      summary_.phases = {{"loads", clock.seconds(RunSection::loads)},
                         {"linear", clock.seconds(RunSection::linear)},
                         {"contacts", clock.seconds(RunSection::contacts)},
                         {"balance", clock.seconds(RunSection::balance)},
                         {"observers", clock.seconds(RunSection::observers)}};
    }
    judge_energy(summary_, options_.energy_tolerance);
    if (!control_) coarse_.warn(summary_, options_.step);
    controls.warn(summary_);
    return summary_;
  }

  State take_state() { return std::move(now_->state); }

  Point at(double t) override {
    const double h = next_->state.t - now_->state.t;
    StepPolynomial(now_->state, next_->state, h, StepPolynomial::degree_for(options_.scheme))
        .at((t - now_->state.t) / h, look_.state);
    look_.state.t = t;
    look_assembler_.set_time(t);
    evaluate_laws(look_assembler_, look_);
    return {look_assembler_, look_};
  }

  static StepOptions step_options(const TransientOptions& o) {
    StepOptions options = o.newton;
    options.varying_steps = o.tolerance > 0.0;
    return options;
  }

 private:
  bool running() const { return summary_.status == RunStatus::success; }
  double duration() const { return options_.t_end - options_.t_start; }

  void set_control() {
    const StepScheme& scheme = options_.scheme;
    double fastest = 0.0;
    for (const std::complex<double>& lambda : fast_eigenvalues(system_))
      fastest = std::max(fastest, std::abs(lambda));
    StepControl::Options o{.tolerance = options_.tolerance,
                           .duration = duration(),
                           .largest = kLargestStep * duration(),
                           .order = scheme.order(),
                           .on_grid = !scheme.is_explicit()};
    if (fastest > 0.0) o.largest = std::min(o.largest, kRoundedStep / fastest);
    const double coarse_step = std::min(o.largest, duration() / kCoarseSteps);
    if (options_.step > 0.0) o.largest = options_.step;
    o.largest = std::min(o.largest, stability_limit(system_, scheme));
    // What starts at a breakpoint and has faded at the end of a long step would be passed over (a short circuit of 50 Hz that
    // decays within 10 ms, in steps of 0.5 s).
    for (const LoadTerm& term : system_.loads())
      if (!term.load->breakpoints().empty() && !term.load->stretch(0.0, 0.0, 1.0))
        behind_break_ = kBehindBreak * duration();
    o.first = std::min(o.largest, behind_break_);
    if (options_.step == 0.0 && fastest > 0.0) o.first = std::min(o.first, kChosenStep / fastest);
    behind_jump_ = o.first;
    // The embedded formulas of the methods of high order are one order lower.
    if (scheme.tableau && scheme.tableau->e.size() > 0 && o.order > 2) --o.order;
    control_.emplace(system_, o);
    // Scales before there is any motion to measure them by.
    class Coarse final : public Observer {
     public:
      explicit Coarse(StepControl& control) : control_(control) {}
      void start(const Assembler&, const EvaluatedState& point) override { control_.expect(point.state); }
      void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override {
        control_.expect(to.state);
      }

     private:
      StepControl& control_;
    } coarse(*control_);
    State state = now_->state;
    RunSummary run;
    try {
      run = simulate(system_,
                     {.scheme = bathe(),
                      .step = coarse_step,
                      .t_start = options_.t_start,
                      .t_end = std::min(options_.t_end, options_.t_start + kCoarseSteps * coarse_step),
                      .newton = options_.newton,
                      .progress = [this](double) { return !options_.progress || options_.progress(0.0); }},
                     state, {&coarse});
    } catch (const SolverError& error) {
      throw SolverError(error.what() + std::string(" (in the coarse run before the run by ") + scheme.name +
                        ", which shows how large the motion will be)");
    }
    if (run.status == RunStatus::interrupted) end_interrupted(summary_, system_.name(), now_->state.t);
    coarse_solves_ = run.solves;
    energy_floor_ = StepControl::kExpected * run.energy.scale;
    summary_.factorizations = run.factorizations;
  }

  void run_to(const Stop& stop) {
    if (control_ || locates_)
      while (running() && now_->state.t < stop.t) {
        free_step(stop);
        // Steps that are rejected do not count as steps, and may be many.
        if (!progress_.goes_on(++tries_, now_->state.t))
          end_interrupted(summary_, system_.name(), now_->state.t);
      }
    else
      constant_steps(stop);
    if (stop.at_break && running() && now_->state.t < options_.t_end) {
      *next_ = *now_;
      controls_->sample(equation_.assembler(), now_->state);
      stepper_->start(*now_);
      if (control_) control_->at_most(jumps(next_->state.a, now_->state.a) ? behind_jump_ : behind_break_);
      energy_->restart(*next_, *now_);
      for (Observer* o : observers_) o->restart(equation_.assembler(), *now_);
    }
  }

  /// Whether fast modes begin anew, which a long step would carry on in its polynomial.
  static bool jumps(const Vector& before, const Vector& after) {
    constexpr double kJump = 1e-3;  // of the largest acceleration
    return (after - before).lpNorm<Eigen::Infinity>() > kJump * after.lpNorm<Eigen::Infinity>();
  }

  auto halved_step() {
    return HalvedStep(*stepper_, now_, next_, options_.max_halvings, summary_,
                      [this](double h, double t_evaluate) { return accept(h, t_evaluate); });
  }

  void constant_steps(const Stop& stop) {
    const EvenSteps steps(now_->state.t, stop.t, options_.step);
    auto step = halved_step();
    for (double i = 1.0; i <= steps.count; i += 1.0) {
      const double t_new = steps.end_of(i);
      if (!step.make(steps.h, t_new, i == steps.count ? stop.evaluation_time() : t_new)) return;
    }
  }

  /// A controlled step, or one that ends at a contact change, or both.
  void free_step(const Stop& stop) {
    const double remaining = stop.t - now_->state.t;
    double h = control_ ? control_->next(remaining) : EvenSteps(now_->state.t, stop.t, options_.step).h;
    for (int i = 0; !control_ && i < failures_; ++i) h *= 0.5;
    const bool whole = h == remaining;
    const double t_new = whole ? stop.t : now_->state.t + h;
    const double t_evaluate = whole ? stop.evaluation_time() : t_new;
    LocatedStep::Result made;
    const bool standing = changes_here_ > 20 + 20 * static_cast<int>(system_.scalars().size());
    if (locates_ && !standing) {
      made = located_.step(*now_, h, t_new, t_evaluate, *next_);
    } else {
      made.newton = stepper_->step(*now_, h, t_new, t_evaluate, *next_);
      made.h = h;
    }
    summary_.iterations += made.newton.iterations;
    if (made.newton.status != NewtonStatus::converged) {
      equation_.start_from(*now_);
      // Steps towards a time or motion behind which a force is not finite are made and fail by turns, ever shorter.
      const double latest = std::max(std::abs(options_.t_start), std::abs(options_.t_end));
      if (failures_ == options_.max_halvings || h <= kNoStep * latest) {
        failures_ = 0;
        halved_step().last_resort(made.newton.status, h, t_new, t_evaluate);
        return;
      }
      ++failures_;
      ++summary_.halved;
      if (control_) control_->failed(h);
      return;
    }
    if (made.h > 0.0) {
      const bool cut = made.h != h;
      const double t_end = cut ? next_->state.t : t_evaluate;
      if (control_ && !passes(made.h, !cut && !whole)) return;
      failures_ = 0;
      if (made.h > kStanding * h) changes_here_ = 0;
      accept(made.h, t_end);
    }
    if (made.reached && running()) pass(*made.reached, made.tau, stop.t);
  }

  /// Error and energy of a controlled step; rejects it if it does not pass.
  bool passes(double h, bool as_planned) {
    stepper_->estimate(*now_, *next_, h, e_z_, e_v_);
    const double error = control_->error(next_->state, e_z_, e_v_, h);
    // At a jump inside no step is short enough: the least one bounds what it adds.
    const bool forced = !(error <= 1.0) && h <= kLeastStep * duration() && std::isfinite(error);
    bool good = error <= 1.0 || forced;
    if (!good) {
      control_->rejected(h, error);
    } else {
      const EnergyBalance before = energy_->balance();
      account(h);
      const EnergyBalance& after = energy_->balance();
      const double share = options_.energy_tolerance * std::max(after.scale, energy_floor_) *
                           std::max(h / duration(), kLeastShare);
      good = !(std::abs(after.imbalance - before.imbalance) > share) || energy_tries_ == kEnergyTries;
      energy_->restore(before);
      if (!good) ++energy_tries_, control_->shorten(h);
    }
    if (good) {
      energy_tries_ = 0;
      summary_.forced += forced;
      control_->look_at(next_->state);
      control_->accepted(h, error, as_planned);
      return true;
    }
    ++summary_.rejected;
    equation_.start_from(*now_);
    if (h <= kLeastStep * duration() && !std::isfinite(error)) {
      const std::string what = what_is_not_finite(equation_.assembler(), *now_, *next_);
      end_run(summary_, system_.name(), now_->state.t, RunStatus::not_finite,
              (what.empty() ? "the estimated error" : what) + " is not finite");
    }
    return false;
  }

  /// Over a contact change.
  void pass(const ContactLocator::Crossing& crossing, double tau, double stop) {
    ++changes_here_;
    if (!(now_->state.t + 2.0 * tau < stop)) return pass_at_stop();
    const double h = located_.hop(crossing, tau, *now_, *next_);
    ++summary_.located;
    energy_->step(*now_, *next_, h);
    observe(h, next_->state.t);
    std::swap(now_, next_);
  }

  /// A change within rounding of the stop: the step there is not located.
  void pass_at_stop() { changes_here_ = std::numeric_limits<int>::max() / 2; }

  /// Enters the step into the energy balance; false where its energy is not finite.
  bool account(double h) {
    equation_.clock().enter(RunSection::balance);
    if (options_.scheme.tableau) {
      const auto [input, dissipated] = step_energy_.over(equation_, *now_, *next_, h);
      return energy_->step(*next_, input, dissipated);
    }
    return energy_->step(*now_, *next_, h);
  }

  /// Shows the step to the observers, controlled ones with the times wanted inside it.
  void observe(double h, double t_evaluate) {
    equation_.clock().enter(RunSection::observers);
    if (observers_.empty()) return;
    Assembler& assembler = equation_.assembler();
    const EvaluatedState* last = now_;
    while (control_) {
      double wanted = std::numeric_limits<double>::infinity();
      for (const Observer* o : observers_)
        if (const double t = o->next_stop(last->state.t); t > last->state.t) wanted = std::min(wanted, t);
      if (!(wanted < next_->state.t)) break;
      EvaluatedState& point = last == &inside_[0] ? inside_[1] : inside_[0];
      StepPolynomial(now_->state, next_->state, h, StepPolynomial::degree_for(options_.scheme))
          .at((wanted - now_->state.t) / h, point.state);
      point.state.t = wanted;
      assembler.set_time(wanted);
      equation_.evaluate(now_->state.history, point);
      for (Observer* o : observers_) o->step(assembler, *last, point);
      last = &point;
    }
    assembler.set_time(t_evaluate);
    for (Observer* o : observers_) o->step(assembler, *last, *next_);
  }

  /// Enters the step from now_ to next_ and swaps them; returns whether the run goes on.
  bool accept(double h, double t_evaluate) {
    ++summary_.steps;
    if (!account(h)) {
      end_not_finite(summary_, equation_.assembler(), *now_, *next_);
      return false;
    }
    if (!control_ && coarse_.due(h)) coarse_.look(equation_.assembler(), *now_, *next_, h);
    observe(h, t_evaluate);
    std::swap(now_, next_);
    const double t = now_->state.t;
    if (!progress_.goes_on(summary_.steps, t)) end_interrupted(summary_, system_.name(), t);
    const bool grows = grew(energy_->balance(), options_.energy_growth_limit);
    if (grows && grows_) end_growing_run(summary_, system_.name(), t, options_.energy_growth_limit);
    grows_ = grows;
    return running();
  }

  const System& system_;
  const TransientOptions& options_;
  const std::vector<Observer*>& observers_;
  std::unique_ptr<Stepper> stepper_;
  StepEquation& equation_;
  Assembler look_assembler_;
  EvaluatedState look_;  // inside the step that observers are shown
  LocatedStep located_;
  std::optional<StepControl> control_;
  StepEnergy step_energy_;
  EvaluatedState points_[2], inside_[2];
  EvaluatedState *now_ = &points_[0], *next_ = &points_[1];
  Vector e_z_, e_v_;
  Progress progress_;
  long tries_ = 0;  // steps made freely, accepted or not
  CoarseSteps coarse_;
  EnergyMonitor* energy_ = nullptr;
  ControlRun* controls_ = nullptr;
  RunSummary summary_;
  bool locates_ = false, grows_ = false;
  long coarse_solves_ = 0;
  double energy_floor_ = 0.0;                                      // J
  double behind_break_ = std::numeric_limits<double>::infinity();  // s
  double behind_jump_ = std::numeric_limits<double>::infinity();   // s
  int failures_ = 0, changes_here_ = 0, energy_tries_ = 0;
};

}  // namespace

void check_options(const System& system, const TransientOptions& o, const State& state) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/transient", findings);
  const bool controlled = o.tolerance != 0.0;
  if (!controlled || o.step != 0.0) check.positive("step", o.step, "s");
  if (controlled) check.within("tolerance", o.tolerance, o.kTolerance.low, o.kTolerance.high, "");
  check_span(o.t_start, o.t_end, check);
  if (o.max_halvings < 0 || o.max_halvings > 40)
    check.fail("max_halvings", std::to_string(o.max_halvings), "", "must be between 0 and 40");
  check.positive("energy_tolerance", o.energy_tolerance, "");
  check_state(system, state, check);
  if (const auto why = why_not_friction(system, o.scheme.name)) check.fail("method", "", "", *why);
  if (findings.empty() && !controlled)
    if (const auto why = why_unstable(system, o.scheme, o.step))
      check.fail("step", to_text(o.step), "s", *why);
  if (!findings.empty()) throw ModelError(findings);
}

RunSummary simulate(const System& system, const TransientOptions& options, State& state,
                    const std::vector<Observer*>& observers) {
  check_options(system, options, state);
  check_observers(observers, system.name() + "/transient", &system);
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
