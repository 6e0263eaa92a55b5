#include <drev/core/error.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/observer.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/exact/law_series.hpp"
#include "solvers/exact/step_expansion.hpp"
#include "solvers/exact/step_length.hpp"
#include "solvers/linear/matrix_product.hpp"
#include "solvers/run/control_run.hpp"
#include "solvers/run/energy_monitor.hpp"
#include "solvers/run/progress.hpp"
#include "solvers/run/run_checks.hpp"
#include "solvers/run/run_verdict.hpp"
#include "solvers/run/stops.hpp"

namespace drev {

namespace {

constexpr int kMaxCuts = 20;
constexpr double kShortest = 1e-6;    // of the largest step: below it, what projection leaves is passed over
constexpr double kKnotWidth = 4e-15;  // rounding of an angle that is looked up, relative to the time
// Distances from a step's ends, relative to the step's length.
constexpr double kNearEnd = 1e-3, kAtEnd = 1e-12, kAtStart = 1e-11;
// Rounding of a time, relative to the time; two times that are the same, relative to the run's times.
constexpr double kTimeRounding = 4e-16, kSameTime = 1e-14;
constexpr double kEnergyTolerance = 1e-6;  // relative to the energy scale
constexpr double kOfImbalance = 1e-4;      // of the balance's tolerance: set_loss_accuracy()
constexpr double kNoProgress = 1e-12;      // least advance of a step, relative to the largest step

class ExactRun final : public StepMotion {
 public:
  ExactRun(const System& system, const ExactOptions& options, State& state,
           const std::vector<Observer*>& observers)
      : system_(system),
        options_(options),
        observers_(observers),
        assembler_(system),
        inside_assembler_(system),
        stiffness_(system.pattern(), system.stiffness_values()),
        expansion_(system),
        series_(expansion_.series),
        known_(expansion_.known),
        laws_(system),
        friction_(expansion_.friction),
        controls_(system, options.t_start, options.t_end),
        progress_(options.progress, options.t_start, options.t_end) {
    now_.state = std::move(state);
    now_.state.t = options.t_start;
    summary_.scheme = "exact";
    summary_.factorizations = system.mass_is_diagonal() ? 0 : 1;
    change_limit_ = 20 + 20 * static_cast<int>(system.scalars().size() + system.loads().size() +
                                               system.frictions().size());
    allowed_imbalance_ = options.energy_tolerance > 0.0 ? options.energy_tolerance
                                                        : std::max(kEnergyTolerance, 2.0 * options.tolerance);
    series_.set_loss_accuracy(kOfImbalance * allowed_imbalance_);
    laws_.add_stiffest(series_);
    fastest_ = series_.bound_rates();
    length_.start(fastest_, options_.t_end - options_.t_start, options_.tolerance, known_.called());
  }

  RunSummary run() {
    evaluate(assembler_, now_, now_.state.t);
    if (!controls_.empty()) {
      controls_.start(assembler_, now_.state);
      evaluate(assembler_, now_, now_.state.t);
    }
    laws_.locate(now_.inputs);
    locate_friction();
    energy_.emplace(assembler_, now_);
    forces_ = std::ranges::any_of(observers_, &Observer::needs_acceleration);
    watches_loads_ = std::ranges::any_of(observers_, &Observer::watches_loads);
    for (Observer* o : observers_) o->look_through(*this);
    for (Observer* o : observers_) o->start(assembler_, now_);
    check_start(summary_, assembler_, now_);
    const Stops stops(system_, options_.t_end, 0.0, {}, &controls_);
    while (running() && now_.state.t < options_.t_end) run_to(next_stop(stops));
    so_far();
    const double rounding = friction_.energy_of_rounding(options_.t_end - options_.t_start);
    if (!(std::abs(summary_.energy.worst_imbalance) <= rounding)) judge_energy(summary_, allowed_imbalance_);
    controls_.warn(summary_);
    return summary_;
  }

  const RunSummary& so_far() {
    summary_.t_end = now_.state.t;
    summary_.solves = series_.products();
    if (energy_) summary_.energy = energy_->balance();
    return summary_;
  }

  /// The last state with its acceleration, which steps that nobody watches do not compute.
  State take_state() {
    if (!whole_ && now_.state.z.allFinite()) evaluate(assembler_, now_, now_.state.t);
    return std::move(now_.state);
  }

  Point at(double t) override {
    move_inside(t, look_);
    evaluate_wanted(inside_assembler_, look_, t);
    return {inside_assembler_, look_};
  }
  std::optional<int> side(int law) const override { return laws_.side(law); }
  std::optional<Range> force_range(int law) override { return expansion_.force_range(laws_, law, step_.s); }
  std::optional<Range> force_reach(int law) override { return expansion_.reach(laws_, law, now_, next_); }
  std::optional<Range> friction_range(int at) const override { return friction_.torque_range(at, step_.s); }
  std::optional<Range> range(const std::vector<Entry>& z, const std::vector<Entry>& v) override {
    return expansion_.range(z, v, step_.s);
  }

 private:
  bool running() const { return summary_.status == RunStatus::success; }
  /// A breakpoint, the end, or a knot of a law's offset: a step's end is evaluated ahead of it, the next start behind it.
  Stop next_stop(const Stops& stops) const {
    const Stop stop = stops.after(now_.state.t);
    const auto knot = expansion_.offsets.next_break(now_.state.t, stop.t);
    if (!knot) return stop;
    const double width = kKnotWidth * std::abs(*knot);
    if (!(*knot + width < stop.t)) return stop;
    return {*knot + width, true, 2.0 * width};
  }

  void run_to(const Stop& stop) {
    known_.locate(now_.state.t, now_.state.z, now_.state.v);
    while (running() && now_.state.t < stop.t) step(stop);
    if (running() && now_.state.t < options_.t_end) restart();
  }

  /// Goes on behind a breakpoint or communication point, where forces and known motions have their new values.
  void restart() {
    next_ = now_;
    controls_.sample(assembler_, now_.state);
    evaluate(assembler_, now_, now_.state.t);
    if (system_.any_prescribed_moves()) laws_.locate(now_.inputs);
    locate_friction();
    energy_->restart(next_, now_);
    for (Observer* o : observers_) o->restart(assembler_, now_);
  }

  /// Finds which contacts stick and which slide, by the forces and speeds of now_.
  void locate_friction() {
    if (friction_.empty()) return;
    friction_.locate(assembler_, now_);
    friction_.hold(assembler_, now_.state.v);
    evaluate(assembler_, now_, now_.state.t);
  }

  /// Where a step ends: s of the series, at a change or knot if there is one.
  struct End {
    double s = 1.0;
    std::optional<LawSeries::Change> change = {};
    bool at_knot = false;      // of a load
    bool at_law_knot = false;  // the step ends at a knot of a law's phase, where its stiffness may jump
    std::optional<FrictionSeries::Change> friction = {};
    bool at_change() const { return change || friction; }
  };

  /// One step towards the stop; it ends earlier at a change, or where the series ends.
  void step(const Stop& stop) {
    const State& from = now_.state;
    const double remaining = stop.t - from.t;
    const End end = find_end(remaining, stop.t);
    if (!running()) return;
    friction_.note_changes(from.t, from.t == options_.t_start, summary_);
    const double s = end.s, got = series_.step();
    const bool reaches = s == 1.0 && got == remaining;
    const double t_new = reaches ? stop.t : std::min(from.t + s * got, stop.t);

    State& to = next_.state;
    to.t = t_new;
    to.history = from.history;
    series_.sum_up(s);
    expansion_.evaluate(s, to.z, to.v);
    if (!friction_.empty()) friction_.write(s, from.history, to.history);
    const bool ahead_of_break = stop.at_break && t_new == stop.t;
    const double evaluated_at = ahead_of_break ? stop.evaluation_time() : t_new;
    const bool whole = forces_ || t_new == stop.t || end.friction;
    whole ? evaluate(assembler_, next_, evaluated_at)
          : evaluate_motion(assembler_, next_, evaluated_at, true);
    const LawWork work = expansion_.work(laws_, s, next_);
    const EvaluatedState& before = watch(t_new, end);
    if (&before != &now_) assembler_.set_time(evaluated_at);
    if (!energy_->step(next_, work.input, work.dissipated)) {
      evaluate(assembler_, next_, evaluated_at);
      return end_not_finite(summary_, assembler_, now_, next_);
    }
    if (s * got > kNoProgress * length_.longest_projected()) changes_here_ = 0;
    ++summary_.steps;
    length_.count();
    if (t_new > from.t)
      for (Observer* o : observers_) o->step(assembler_, before, next_);
    laws_.forget_roots();
    changed_ = end.change;
    beside_knot_ = beside_knot(end, t_new);
    if (end.change) pass(*end.change, t_new);
    if (!ahead_of_break) {
      expansion_.return_to(s, look_.state);
      if (s > 0.0) known_.advance(t_new, to.z, to.v, s == 1.0 || expansion_.sweeps());
      if (end.at_knot) {
        known_.pass_knot();
        count_change(known_.knot_element(), t_new);
      }
    }
    std::swap(now_, next_);
    whole_ = whole;
    if (!friction_.empty()) {
      friction_.forget_roots();
      assembler_.set_time(now_.state.t);
      friction_.hold(assembler_, now_.state.v);
      if (end.friction) pass_friction(*end.friction);
    }
    if (!progress_.goes_on(summary_.steps, t_new)) end_interrupted(summary_, system_.name(), t_new);
    if (!progress_.would_end(summary_.steps, t_new))
      throw SolverError(at_time(system_.name(), t_new) + Progress::kNoEnd + to_text(length_.longest()) +
                        " s");
  }

  void pass_friction(const FrictionSeries::Change& change) {
    const double t = now_.state.t;
    if (!whole_) evaluate(assembler_, now_, t);
    whole_ = true;
    assembler_.set_time(t);
    const bool jumped = friction_.pass(change, assembler_, now_);
    count_change(friction_.element(change.contact), t);
    if (!jumped) return;
    friction_.hold(assembler_, now_.state.v);
    evaluate(assembler_, now_, t);
    for (Observer* o : observers_) o->restart(assembler_, now_);
  }

  /// Expands until the step's end is known. What was projected holds for a whole step only: there, the
  /// step is cut at the change and expanded anew, until the change is at its end.
  End find_end(double remaining, double end_of_steps) {
    double h = length_.next(now_.state.t, end_of_steps);
    End cut;
    expansion_.allow_sweeps(true);
    for (int cuts = 0;; ++cuts) {
      h = expand(h);
      if (!running()) return {};
      expansion_.expand_laws(laws_);
      if (const auto change = laws_.change_at_once()) {
        changed_ = change;
        pass(*change, now_.state.t);
        cut = {};
        continue;
      }
      if (expansion_.sweeps()) {
        if (const auto found = expansion_.first_swept_change(laws_, now_.state.t, next_.state)) {
          if (found->by_kinks) length_.hold_back(h);
          return {.s = found->s, .change = found->change, .at_law_knot = found->at_law_knot};
        }
        expansion_.allow_sweeps(h > length_.longest_projected());
        h = length_.hold_back(h);
        continue;
      }
      if (!friction_.empty()) {
        friction_.expand(series_, now_.state);
        if (const auto change = friction_.change_at_once()) {
          pass_friction(*change);
          known_.locate(now_.state.t, now_.state.z, now_.state.v);
          cut = {};
          continue;
        }
      }
      End end;
      end.change = laws_.first_change(1.0);
      if (end.change) end.s = end.change->s;
      if (const auto change = friction_.first_change(end.s)) end = {.s = change->s, .friction = change};
      if (const auto knot = known_.first_knot(series_, end.s)) end = {.s = *knot, .at_knot = true};
      if (const auto knot = expansion_.first_knot(end.s)) end = {.s = *knot, .at_law_knot = true};
      // So close to the start the motion has had no time to differ.
      const bool at_start = end.s < kAtStart || end.s * h < kTimeRounding * std::abs(now_.state.t);
      if (!known_.projected() || cuts > kMaxCuts || at_start) return end;
      double beyond = end.s - 1.0;
      if (end.s == 1.0) {
        end.at_law_knot |= cut.at_law_knot;
        if (!cut.at_change()) return end;
        beyond = cut.change ? laws_.beyond_end(*cut.change) : friction_.beyond_end(*cut.friction);
        if (!(std::abs(beyond) < kNearEnd)) return end;  // it is not crossed after all
        end.change = cut.change;
        end.friction = cut.friction;
      }
      if (std::abs(beyond) <= kAtEnd || !(h * (1.0 + beyond) > 0.0))
        return {1.0, end.change, end.at_knot, end.at_law_knot, end.friction};
      h = std::min(remaining, h * (1.0 + beyond));
      cut = end;
    }
  }

  /// Time [s] beside a law's knot at the step's end, for which rounding leaves its side open.
  double beside_knot(const End& end, double t) const {
    return end.at_law_knot ? std::max(expansion_.knot_clearance(), kTimeRounding * std::abs(t)) : 0.0;
  }

  /// Shows the observers points inside a step to t_new: where they asked for one, and, if any looks inside, beside a contact
  /// change or a law's knot at either end, so that each side of it is seen, and close enough for a cubic between them to be
  /// off by at most 2e-5 of what moves with the fastest mode. Returns the last one.
  const EvaluatedState& watch(double t_new, const End& end) {
    const EvaluatedState* last = &now_;
    const double t_0 = now_.state.t, length = t_new - t_0;
    if (observers_.empty() || !(length > 0.0)) return *last;
    const double same = kSameTime * std::max(std::abs(options_.t_start), std::abs(options_.t_end));
    step_ = {t_0, length, end.s};
    bool inside = false;
    const double* beyond_cubic =
        expansion_.beyond_cubic(end.s, changed_ || beside_knot_ > 0.0 || end.at_change() || end.at_law_knot);
    for (Observer* o : observers_) inside |= o->looks_inside(now_, next_, beyond_cubic);
    const double parts = inside ? expansion_.parts_to_watch(fastest_ * length, end.s) : 1.0;
    const auto clear = [&](const std::optional<LawSeries::Change>& change, double s, double t,
                           double otherwise) {
      if (!inside) return t_0;
      return change ? t_0 + length * laws_.clear_of_change(*change, s) / end.s : t + otherwise;
    };
    const double behind = clear(changed_, 0.0, t_0, beside_knot_);
    const double ahead = clear(end.change, end.s, t_new, -beside_knot(end, t_new));
    find_kinks();
    auto kink = kinks_.begin();
    for (double i = 1.0;;) {
      double t = i < parts ? t_0 + length * (i / parts) : t_new;
      const double part = t;
      bool exactly = false;
      for (const double beside : {behind, ahead})
        if (beside > last->state.t) t = std::min(t, beside);
      while (kink != kinks_.end() && !(*kink > last->state.t)) ++kink;
      if (kink != kinks_.end() && *kink < t) {
        t = *kink;
        exactly = true;
      }
      for (const Observer* o : observers_) {
        const double wanted = o->next_stop(last->state.t);
        if (!(wanted > last->state.t + same) || wanted > t) continue;
        t = wanted;
        exactly = true;
      }
      if (!(t < t_new - (t == ahead ? 0.0 : same))) return *last;
      if (t == part) i += 1.0;
      EvaluatedState& point = last == &inside_[0] ? inside_[1] : inside_[0];
      exactly ? move_inside(t, point) : move_along(t, point);
      evaluate_wanted(assembler_, point, t);
      for (Observer* o : observers_) o->step(assembler_, *last, point);
      last = &point;
    }
  }

  /// Times at which loads' kinks are passed in the step, where an observer watches loads.
  void find_kinks() {
    kinks_.clear();
    if (watches_loads_) known_.append_knots(step_.s, kinks_);
    for (double& kink : kinks_) kink = step_.t_0 + step_.length * (kink / step_.s);
    std::sort(kinks_.begin(), kinks_.end());
  }

  /// The motion at t on the step's series.
  void move_along(double t, EvaluatedState& point, bool exactly = false) {
    point.state.t = t;
    point.state.history = now_.state.history;
    const double s = step_.s * ((t - step_.t_0) / step_.length);
    expansion_.evaluate(s, point.state.z, point.state.v, exactly);
    if (!friction_.empty()) friction_.write(s, now_.state.history, point.state.history);
  }

  /// The same as exact as the step's end: where kinks are projected, at the end of a series of its own.
  void move_inside(double t, EvaluatedState& point) {
    move_along(t, point, true);
    const double s = step_.s * ((t - step_.t_0) / step_.length);
    if (expansion_.sweeps() || !known_.kinked() || !(s > kAtStart && s < 1.0)) return;
    if (!part_) part_.emplace(system_);
    if (!part_->expand_part(expansion_, now_, laws_, s, limits(series_.step()))) return;
    part_->evaluate(1.0, point.state.z, point.state.v);
    if (!friction_.empty()) part_->friction.write(1.0, now_.state.history, point.state.history);
  }

  /// Expands from now_ over h with the pieces that hold; returns the step got, which may be shorter; 0 ends the run.
  double expand(double h) {
    for (;;) {
      const auto [got, again, longer, stands] = expansion_.attempt(now_, laws_, h, limits(h));
      if (again) {
        h = got == length_.longest_projected() ? length_.hold_back(h) : got;
        continue;
      }
      const double shorter = length_.attempted(h, got, longer);
      if (got == h) return h;
      if (shorter <= kNoProgress * length_.longest_projected()) return give_up(h);
      if (stands) {
        known_.shorten(got / h);
        return got;
      }
      h = shorter;
    }
  }

  StepExpansion::Limits limits(double h) const {
    const double most = length_.longest_projected(), part = h / (options_.t_end - options_.t_start);
    return {std::max(options_.tolerance * part, kLeastShare), options_.tolerance, kShortest * most, most};
  }

  /// No step is short enough: a force that is not finite in the step of length h ends the run.
  double give_up(double h) {
    assembler_.set_time(now_.state.t + h);
    if (what_is_not_finite(assembler_, now_, now_).empty())
      throw SolverError(at_time(system_.name(), now_.state.t) + "the series does not converge");
    end_not_finite(summary_, assembler_, now_, now_);
    return 0.0;
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

  /// Motion and laws alone; energies: and what those need.
  void evaluate_motion(Assembler& assembler, EvaluatedState& point, double t, bool energies) {
    assembler.set_time(t);
    evaluate_laws(assembler, point);
    if (energies) stiffness_.multiply(1.0, point.state.z, point.kz);
    point.state.a.setConstant(system_.size(), std::numeric_limits<double>::quiet_NaN());
  }
  /// What observers want of a point inside a step.
  void evaluate_wanted(Assembler& assembler, EvaluatedState& point, double t) {
    forces_ ? evaluate(assembler, point, t) : evaluate_motion(assembler, point, t, false);
  }

  void evaluate(Assembler& assembler, EvaluatedState& point, double t) {
    assembler.set_time(t);
    evaluate_laws(assembler, point);
    assembler.external(point.state.z, point.state.v, point.p);
    stiffness_.multiply(1.0, point.state.z, point.kz);
    assembler.multiply_damping(point.state.v, point.cv);
    point.total = point.kz + point.cv - point.p;
    add_law_forces(system_, point, 1.0, point.total);
    friction_.add_forces(point.state.history, point.total);
    rhs_ = -point.total;
    series_.solve_mass(rhs_, point.state.a);
  }

  const System& system_;
  const ExactOptions& options_;
  const std::vector<Observer*>& observers_;
  Assembler assembler_, inside_assembler_;
  MatrixProduct stiffness_;
  StepExpansion expansion_;
  TaylorSeries& series_;  // its parts
  LoadSeries& known_;
  LawSeries laws_;
  FrictionSeries& friction_;
  ControlRun controls_;
  std::optional<StepExpansion> part_;         // of a step, to a point inside
  std::optional<LawSeries::Change> changed_;  // at the start of this step
  double beside_knot_ = 0.0;  // s: the step starts at a law's knot, which is passed for certain behind it
  struct {
    double t_0 = 0.0, length = 0.0, s = 1.0;
  } step_;                     // which observers are shown: its end is s of the series
  std::vector<double> kinks_;  // times of, inside this step
  EvaluatedState now_, next_, inside_[2], look_;
  Vector rhs_;
  Progress progress_;
  std::optional<EnergyMonitor> energy_;
  RunSummary summary_;
  double fastest_ = 0.0, allowed_imbalance_ = 0.0;
  StepLength length_;
  int changes_here_ = 0, change_limit_ = 0;
  bool watches_loads_ = false, forces_ = false;  // some observer does, or wants accelerations and forces
  bool whole_ = true;                            // now_ has them
};

}  // namespace

RunSummary propagate(const System& system, const ExactOptions& options, State& state,
                     const std::vector<Observer*>& observers) {
  check_propagation(system, options, state);
  check_observers(observers, system.name() + "/exact", &system);
  ExactRun run(system, options, state, observers);
  try {
    RunSummary summary = run.run();
    state = run.take_state();
    return summary;
  } catch (const SolverError& error) {  // what there is of the run is not lost
    state = run.take_state();
    throw RunError(error, run.so_far());
  } catch (...) {  // a user's function threw
    state = run.take_state();
    throw;
  }
}

}  // namespace drev
