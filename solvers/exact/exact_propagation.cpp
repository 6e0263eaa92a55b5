#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/observer.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/exact/law_series.hpp"
#include "solvers/run/energy_monitor.hpp"
#include "solvers/run/progress.hpp"
#include "solvers/run/run_checks.hpp"
#include "solvers/run/run_verdict.hpp"
#include "solvers/run/stops.hpp"

namespace drev {

namespace {

constexpr double kFastestTimesStep = 3.0;  // omega h: bounds degree and growth of rounding
constexpr double kWatchedAngle = 0.3;      // omega h between points that observers see
constexpr double kGrowth = 1.5;            // of the step after one that had to be shortened
constexpr double kShorten = 0.9;           // of the step at which the loads' rest is just small enough
constexpr double kLoosest = 1e-3;          // tolerance of a pass that is not the last
constexpr double kSettled = 1e-15;         // of the motion: rounding of what is projected
constexpr double kProjected = 0.1;         // of a step's share, that the projection may add
constexpr double kJump = 1e-4;             // of the tolerance: error allowed per undeclared discontinuity
constexpr double kShortest = 1e-6;         // of the largest step
constexpr double kBehindKnot = 1e-3;       // of the step to it: behind the last node of Gauss' rule
constexpr double kBeforeEnd = 0.98;        // of the step: a knot that its nodes see
constexpr int kMaxPasses = 20;             // of projected loads
constexpr int kMaxCuts = 20;
constexpr double kNearEnd = 1e-3, kAtEnd = 1e-12, kAtStart = 1e-8;  // of the step
constexpr double kRetreat = 1.0 / 16.0;                             // of the step where the series overflowed
constexpr double kSameTime = 1e-14;                                 // relative to the run's times
constexpr double kNoProgress = 1e-12;                               // relative to the largest step
constexpr double kLeastTolerance = 1e-16;                           // a step's own: below it is rounding

class ExactRun {
 public:
  ExactRun(const System& system, const ExactOptions& options, State& state,
           const std::vector<Observer*>& observers)
      : system_(system),
        options_(options),
        observers_(observers),
        assembler_(system),
        series_(system),
        known_(system),
        laws_(system),
        smooth_(system),
        progress_(options.progress, options.t_start, options.t_end) {
    now_.state = std::move(state);
    now_.state.t = options.t_start;
    summary_.scheme = "exact";
    summary_.factorizations = system.mass_is_diagonal() ? 0 : 1;
    change_limit_ = 20 + 20 * static_cast<int>(system.scalars().size() + system.loads().size());
    laws_.add_stiffest(series_);
    fastest_ = series_.bound_rates();
    const double duration = options.t_end - options.t_start;
    largest_step_ = fastest_ > 0.0 ? std::min(duration, kFastestTimesStep / fastest_) : duration;
    growing_step_ = largest_step_;
  }

  RunSummary run() {
    evaluate(now_, now_.state.t);
    laws_.locate(now_.inputs);
    EnergyMonitor energy(assembler_, now_);
    energy_ = &energy;
    for (Observer* o : observers_) o->start(assembler_, now_);
    check_start(summary_, system_, now_.state);
    const Stops stops(system_, options_.t_end, 0.0);
    while (running() && now_.state.t < options_.t_end) run_to(stops.after(now_.state.t));
    summary_.t_end = now_.state.t;
    summary_.solves = series_.products();
    summary_.energy = energy.balance();
    judge_energy(summary_, options_.energy_tolerance);
    return summary_;
  }

  State take_state() { return std::move(now_.state); }

 private:
  bool running() const { return summary_.status == RunStatus::success; }

  void run_to(const Stop& stop) {
    known_.locate(now_.state.t, now_.state.z, now_.state.v);
    while (running() && now_.state.t < stop.t) step(stop);
    if (running() && now_.state.t < options_.t_end) restart();
  }

  /// Behind a breakpoint: forces and known motions have their new values.
  void restart() {
    next_ = now_;
    evaluate(now_, now_.state.t);
    if (system_.any_prescribed_moves()) laws_.locate(now_.inputs);
    energy_->restart(next_, now_);
  }

  /// Where a step ends: s of the series, at a change or knot if there is one.
  struct End {
    double s = 1.0;
    std::optional<LawSeries::Change> change = {};
    bool at_knot = false;
  };

  /// One step towards the stop; it ends earlier at a change, or where the series ends.
  void step(const Stop& stop) {
    const State& from = now_.state;
    const double remaining = stop.t - from.t;
    const End end = find_end(remaining);
    if (!running()) return;
    const double s = end.s, got = series_.step();
    const bool reaches = s == 1.0 && got == remaining;
    const double t_new = reaches ? stop.t : std::min(from.t + s * got, stop.t);

    const EvaluatedState& before = watch(t_new, s);
    State& to = next_.state;
    to.t = t_new;
    to.history = from.history;
    series_.evaluate(s, to.z, to.v);
    const bool ahead_of_break = stop.at_break && t_new == stop.t;
    evaluate(next_, ahead_of_break ? stop.evaluation_time() : t_new);
    const ProjectedLaws::Work smooth = smooth_.work(series_, s);
    if (!energy_->step(next_, known_.work(series_, s, to.z) + laws_.input(s) + smooth.input,
                       series_.dissipated(s) + laws_.dissipated(s) + smooth.dissipated))
      return end_not_finite(summary_, assembler_, now_, next_);
    if (s * got > kNoProgress * largest_step_) changes_here_ = 0;
    laws_.forget_roots();
    if (end.change) pass(*end.change, t_new);
    if (!ahead_of_break) {
      known_.advance(t_new, to.z, to.v, s == 1.0);
      if (end.at_knot) {
        known_.pass_knot();
        count_change(known_.knot_element(), t_new);
      }
    }
    ++summary_.steps;
    if (t_new > from.t)
      for (Observer* o : observers_) o->step(assembler_, before, next_);
    std::swap(now_, next_);
    if (!progress_.goes_on(summary_.steps, now_.state.t))
      end_interrupted(summary_, system_.name(), now_.state.t);
  }

  /// Expands until the step's end is known. What was projected holds for a whole step only: there, the
  /// step is cut at the change and expanded anew, until the change is at its end.
  End find_end(double remaining) {
    double h = std::min(remaining, growing_step_);
    if (h < remaining) h = remaining / std::ceil(remaining / h);
    std::optional<LawSeries::Change> cut;
    for (int cuts = 0;; ++cuts) {
      h = expand(h);
      if (!running()) return {};
      laws_.expand(series_, known_, smooth_);
      if (const auto change = laws_.change_at_once()) {
        pass(*change, now_.state.t);
        cut.reset();
        continue;
      }
      End end;
      end.change = laws_.first_change(1.0);
      if (end.change) end.s = end.change->s;
      if (const auto knot = known_.first_knot(series_, end.s)) end = {*knot, {}, true};
      if (const auto knot = smooth_.first_knot(series_, end.s)) end = {*knot, {}, false};
      // So close to the start the motion has had no time to differ.
      if (!known_.projected() || cuts > kMaxCuts || end.s < kAtStart) return end;
      double beyond = end.s - 1.0;
      if (end.s == 1.0) {
        if (!cut) return end;
        beyond = laws_.beyond_end(*cut);
        if (!(std::abs(beyond) < kNearEnd)) return end;  // it is not crossed after all
        end.change = cut;
      }
      if (std::abs(beyond) <= kAtEnd || !(h * (1.0 + beyond) > 0.0)) return {1.0, end.change, end.at_knot};
      h = std::min(remaining, h * (1.0 + beyond));
      cut = end.change;
    }
  }

  /// Shows the observers points inside a step to t_new (s of the series): where they asked for one, and
  /// close enough for a cubic between them to be off by at most 2e-5 of what moves with the fastest mode.
  /// Returns the last one.
  const EvaluatedState& watch(double t_new, double s) {
    const EvaluatedState* last = &now_;
    const double t_0 = now_.state.t, length = t_new - t_0;
    if (observers_.empty() || !(length > 0.0)) return *last;
    const double same = kSameTime * std::max(std::abs(options_.t_start), std::abs(options_.t_end));
    const double parts = std::ceil(fastest_ * length / kWatchedAngle);
    const bool forces = std::any_of(observers_.begin(), observers_.end(),
                                    [](const Observer* o) { return o->needs_acceleration(); });
    for (double i = 1.0;;) {
      double t = i < parts ? t_0 + length * (i / parts) : t_new;
      const double part = t;
      for (const Observer* o : observers_) {
        const double wanted = o->next_stop(last->state.t);
        if (wanted > last->state.t + same) t = std::min(t, wanted);
      }
      if (!(t < t_new - same)) return *last;
      if (t == part) i += 1.0;
      EvaluatedState& point = last == &inside_[0] ? inside_[1] : inside_[0];
      point.state.t = t;
      point.state.history = now_.state.history;
      series_.evaluate(s * ((t - t_0) / length), point.state.z, point.state.v);
      if (forces)
        evaluate(point, t);
      else
        evaluate_motion(point, t);
      for (Observer* o : observers_) o->step(assembler_, *last, point);
      last = &point;
    }
  }

  /// Expands from now_ over h with the pieces that hold; returns the step got, which may be shorter; 0 where
  /// that ends the run.
  double expand(double h) {
    for (;;) {
      const double share =
          std::max(options_.tolerance * h / (options_.t_end - options_.t_start), kLeastTolerance);
      to_knot_ = false;
      const double got = try_step(h, share);
      if (to_knot_) {
        h = got;
        continue;
      }
      if (got > 0.0) growing_step_ = std::min(largest_step_, kGrowth * std::max(got, growing_step_));
      if (got == h) return h;
      growing_step_ = got > 0.0 ? got : kRetreat * h;
      if (growing_step_ <= kNoProgress * largest_step_) return give_up(h);
      if (got > 0.0 && !known_.projects() && smooth_.empty()) {
        known_.shorten(got / h);
        return got;
      }
      h = growing_step_;
    }
  }

  /// No step is short enough: a force that is not finite in the step of length h ends the run.
  double give_up(double h) {
    assembler_.set_time(now_.state.t + h);
    if (what_is_not_finite(assembler_, now_, now_).empty())
      throw SolverError(at_time(system_.name(), now_.state.t) + "the series does not converge");
    end_not_finite(summary_, assembler_, now_, now_);
    return 0.0;
  }

  /// The step that the series holds for, <= h; 0 if its terms overflow.
  double try_step(double h, double share) {
    const State& from = now_.state;
    series_.reset();
    known_.add_to(series_, h);
    laws_.add_to(series_, known_, h);
    smooth_.add_to(series_, now_, h);
    // Loads and smooth laws can be stiffer than what bounded the largest step.
    const double steepest = 1.5 * kFastestTimesStep / series_.rate();
    if (h > steepest) return steepest;
    bool settled = false;
    const bool projects = known_.projects() || !smooth_.empty();
    // Each pass needs to be no better than the next one takes up of it.
    double tolerance = projects ? std::clamp(share / contraction_, share, kLoosest) : share;
    for (int pass = 0;; ++pass) {
      const bool last = !projects || settled;
      const double got = series_.expand(from.z, from.v, h, last ? share : tolerance);
      if (got < h || last) return got;
      if (pass == kMaxPasses) return 0.5 * h;
      const double kinks = kProjected * share / std::max(projected_, share);
      const LoadSeries::Pass made =
          known_.project(series_, smooth_, pass == 0, std::max(kinks, kLeastTolerance));
      // In the shortest steps what is left is an undeclared discontinuity, or rounding.
      if (made.residual > std::max(share, kJump * options_.tolerance) && h > kShortest * largest_step_) {
        // Nearly always a law's knot in the step: a step to just behind it, which find_end() then cuts.
        const auto knot = smooth_.first_knot(series_, kBeforeEnd);
        if ((to_knot_ = knot && *knot > kAtStart)) return h * *knot * (1.0 + kBehindKnot);
        return h * std::max(0.2, kShorten * std::pow(share / made.residual, 1.0 / kProjectionTerms));
      }
      if (pass == 0) projected_ = made.change;
      contraction_ = std::max(made.contraction, 1e-300);
      // What this pass was off by comes back in the next one times the contraction factor.
      settled = std::max(made.change, tolerance) * made.contraction <= std::max(share, kSettled);
      tolerance = std::clamp(0.5 * share / contraction_, share, kLoosest);
    }
  }

  void pass(const LawSeries::Change& change, double t) {
    const int from = laws_.piece(change.law);
    laws_.pass(change);
    ++summary_.contact_changes;
    if (options_.on_change) options_.on_change({t, change.law, from, laws_.piece(change.law)});
    count_change(system_.scalars()[idx(change.law)].element, t);
  }

  void count_change(ElementId element, double t) {
    if (++changes_here_ > change_limit_)
      throw SolverError(at_time(system_.name(), t) + system_.element_instances()[idx(index(element))].name +
                        " changes its piece to and fro without the motion going on");
  }

  /// Motion and laws only.
  void evaluate_motion(EvaluatedState& point, double t) {
    assembler_.set_time(t);
    evaluate_laws(assembler_, point);
    point.state.a.setConstant(system_.size(), std::numeric_limits<double>::quiet_NaN());
  }

  void evaluate(EvaluatedState& point, double t) {
    const State& s = point.state;
    assembler_.set_time(t);
    evaluate_laws(assembler_, point);
    assembler_.external(s.z, s.v, point.p);
    assembler_.multiply_stiffness(s.z, point.kz);
    assembler_.multiply_damping(s.v, point.cv);
    point.total = point.kz + point.cv - point.p;
    add_law_forces(system_, point, 1.0, point.total);
    rhs_ = -point.total;
    series_.solve_mass(rhs_, point.state.a);
  }

  const System& system_;
  const ExactOptions& options_;
  const std::vector<Observer*>& observers_;
  Assembler assembler_;
  TaylorSeries series_;
  LoadSeries known_;
  LawSeries laws_;
  ProjectedLaws smooth_;
  EvaluatedState now_, next_, inside_[2];
  Vector rhs_;
  Progress progress_;
  EnergyMonitor* energy_ = nullptr;
  RunSummary summary_;
  double fastest_ = 0.0, largest_step_ = 0.0, growing_step_ = 0.0;
  bool to_knot_ = false;  // try_step()'s answer leads to a law's knot
  double contraction_ = 1.0,
         projected_ = 1.0;  // of the last step: what the projection changed, and how it came back
  int changes_here_ = 0, change_limit_ = 0;
};

void check_options(const System& system, const ExactOptions& o, const State& state) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/exact", findings);
  check.within("tolerance", o.tolerance, o.kTolerance.low, o.kTolerance.high, "");
  check_span(o.t_start, o.t_end, check);
  check.positive("energy_tolerance", o.energy_tolerance, "");
  check_state(system, state, check);
  if (const auto why = why_not_exact(system)) check.fail("model", "", "", *why);
  if (!findings.empty()) throw ModelError(findings);
}

}  // namespace

RunSummary propagate(const System& system, const ExactOptions& options, State& state,
                     const std::vector<Observer*>& observers) {
  check_options(system, options, state);
  ExactRun run(system, options, state, observers);
  try {
    RunSummary summary = run.run();
    state = run.take_state();
    return summary;
  } catch (...) {  // no solution, or a user's function threw: the last state is not lost
    state = run.take_state();
    throw;
  }
}

RunSummary propagate(const System& system, const ExactOptions& options,
                     const std::vector<Observer*>& observers) {
  State state = State::initial(system, options.t_start);
  return propagate(system, options, state, observers);
}

}  // namespace drev
