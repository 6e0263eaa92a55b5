#include "solvers/exact_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "solvers/law_pieces.hpp"

namespace drev {

namespace {

constexpr double kFastestTimesStep = 3.0;  // omega h: bounds degree and growth of rounding
constexpr double kKnotMargin = 1.05;       // step past the knot expected next
constexpr double kWatchedAngle = 0.3;      // omega h between points that observers see
constexpr double kGrowth = 1.5;            // of the step after one that had to be shortened
constexpr double kRetreat = 1.0 / 16.0;    // of the step where the series overflowed
constexpr double kSameTime = 1e-14;        // relative to the run's times
constexpr double kNoProgress = 1e-12;      // relative to the largest step
constexpr double kLeastTolerance = 1e-16;  // a step's own: below it is rounding
constexpr long kProgressSteps = 100;

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
        laws_(system) {
    now_.state = std::move(state);
    now_.state.t = options.t_start;
    summary_.scheme = "exact";
    summary_.factorizations = system.mass_is_diagonal() ? 0 : 1;
    change_limit_ = 20 + 20 * static_cast<int>(system.scalars().size() + system.loads().size());
    laws_.add_stiffest(series_);
    const double fastest = fastest_ = series_.bound_rates();
    const double duration = options.t_end - options.t_start;
    largest_step_ = fastest > 0.0 ? std::min(duration, kFastestTimesStep / fastest) : duration;
    growing_step_ = largest_step_;
  }

  RunSummary run() {
    evaluate(now_, now_.state.t);
    laws_.locate(now_.inputs);
    EnergyMonitor energy(assembler_, now_);
    energy_ = &energy;
    for (Observer* o : observers_) o->start(assembler_, now_);
    if (!now_.state.a.allFinite()) fail(RunStatus::not_finite, "the initial acceleration");
    while (running() && now_.state.t < options_.t_end) run_to_next_stop();
    summary_.t_end = now_.state.t;
    summary_.energy = energy.balance();
    judge_energy();
    return summary_;
  }

  State take_state() { return std::move(now_.state); }

 private:
  bool running() const { return summary_.status == RunStatus::success; }

  void run_to_next_stop() {
    const double t = now_.state.t;
    known_.locate(t, now_.state.z, now_.state.v);
    const double same = kSameTime * std::max(std::abs(options_.t_start), std::abs(options_.t_end));
    const auto& breaks = system_.breakpoints();
    const auto next_break = std::upper_bound(breaks.begin(), breaks.end(), t);
    double stop = options_.t_end;
    if (next_break != breaks.end()) stop = std::min(stop, *next_break);
    for (;;) {
      double wanted_stop = stop;
      for (const Observer* o : observers_) {
        const double wanted = o->next_stop(now_.state.t);
        if (wanted > now_.state.t + same) wanted_stop = std::min(wanted_stop, wanted);
      }
      if (stop - wanted_stop <= same) wanted_stop = stop;
      const bool last = wanted_stop == stop;
      const bool at_break = last && next_break != breaks.end() && stop == *next_break;
      while (running() && now_.state.t < wanted_stop) step(wanted_stop, at_break);
      if (last || !running()) break;
    }
    if (running() && now_.state.t < options_.t_end) restart();
  }

  /// Behind a breakpoint: forces and known motions have their new values.
  void restart() {
    next_ = now_;
    evaluate(now_, now_.state.t);
    if (system_.any_prescribed_moves()) laws_.locate(now_.inputs);
    energy_->restart(next_, now_);
  }

  /// One step towards the stop; it ends earlier at a change, or where the series ends.
  void step(double stop, bool at_break) {
    const State& from = now_.state;
    const double remaining = stop - from.t;
    double h = expand(remaining);
    const double got = series_.step();
    std::optional<LawPieces::Change> change = laws_.first_change(1.0);
    const std::optional<double> knot = known_.first_knot(series_, change ? change->s : 1.0);
    if (knot) change.reset();
    const double s = knot ? *knot : change ? change->s : 1.0;
    const bool reaches = s == 1.0 && got == h && h == remaining;
    const double t_new = reaches ? stop : std::min(from.t + s * got, stop);

    const StepPoint& before = watch(t_new, s);
    State& to = next_.state;
    to.t = t_new;
    to.history = from.history;
    series_.evaluate(s, to.z, to.v);
    if (!to.z.allFinite() || !to.v.allFinite()) return not_finite(to);
    const bool ahead_of_break = at_break && t_new == stop;
    evaluate(next_, ahead_of_break ? std::nextafter(stop, -std::numeric_limits<double>::infinity())
                                   : t_new);
    energy_->step(next_, known_.work(series_, s) + laws_.input(s),
                  series_.dissipated(s) + laws_.dissipated(s));
    if (s * got > kNoProgress * largest_step_) changes_here_ = 0;
    laws_.forget_roots();
    if (change) pass(*change, t_new);
    if (!ahead_of_break) {
      known_.advance(t_new, to.z, to.v);
      if (knot) {
        known_.pass_knot();
        count_change(known_.knot_element(), t_new);
      }
    }
    ++summary_.steps;
    if (t_new > from.t)
      for (Observer* o : observers_) o->step(assembler_, before, next_);
    std::swap(now_, next_);
    if (options_.progress && summary_.steps % kProgressSteps == 0 &&
        !options_.progress((now_.state.t - options_.t_start) / (options_.t_end - options_.t_start)))
      fail(RunStatus::interrupted, "interrupted");
  }

  /// Shows the observers points inside a step to t_new (s of the series), close enough for a cubic between
  /// them to be off by at most 2e-5 of what moves with the fastest mode. Returns the last one.
  const StepPoint& watch(double t_new, double s) {
    const StepPoint* last = &now_;
    const double length = t_new - now_.state.t;
    if (observers_.empty() || !(length > 0.0)) return *last;
    const double parts = std::ceil(fastest_ * length / kWatchedAngle);
    for (double i = 1.0; i < parts; i += 1.0) {
      StepPoint& point = last == &inside_[0] ? inside_[1] : inside_[0];
      point.state.t = now_.state.t + length * (i / parts);
      point.state.history = now_.state.history;
      series_.evaluate(s * (i / parts), point.state.z, point.state.v);
      evaluate(point, point.state.t);
      for (Observer* o : observers_) o->step(assembler_, *last, point);
      last = &point;
    }
    return *last;
  }

  /// Expands from now_ with pieces that hold; returns the step tried.
  double expand(double remaining) {
    const State& from = now_.state;
    for (;;) {
      double h = std::min(remaining, growing_step_);
      const double knot = kKnotMargin * known_.time_to_knot();
      if (knot > kNoProgress * largest_step_ && knot < h)
        h = knot;
      else if (h < remaining)
        h = remaining / std::ceil(remaining / h);
      series_.reset();
      for (Vector& p : series_.right_side()) p.setZero();
      known_.add_to(series_, h);
      laws_.add_to(series_, known_, h);
      const double share = options_.tolerance * h / (options_.t_end - options_.t_start);
      const double got = series_.expand(from.z, from.v, h, std::max(share, kLeastTolerance),
                                        known_.composed() ? &known_ : nullptr);
      if (got == 0.0) {
        growing_step_ = kRetreat * h;
        if (growing_step_ > kNoProgress * largest_step_) continue;
        throw SolverError(where(from.t) + "the series does not converge; is a load not finite?");
      }
      if (got < h) known_.shorten(got / h);
      growing_step_ = std::min(largest_step_, kGrowth * (got < h ? got : growing_step_));
      laws_.expand(series_, known_);
      const auto change = laws_.change_at_once();
      if (!change) return h;
      pass(*change, from.t);
    }
  }

  void pass(const LawPieces::Change& change, double t) {
    const int from = laws_.piece(change.law);
    laws_.pass(change);
    ++summary_.contact_changes;
    if (options_.on_change) options_.on_change({t, change.law, from, laws_.piece(change.law)});
    count_change(system_.scalars()[at(change.law)].element, t);
  }

  void count_change(ElementId element, double t) {
    if (++changes_here_ > change_limit_)
      throw SolverError(where(t) + system_.placements()[at(index(element))].name +
                        " changes its piece to and fro without the motion going on");
  }

  void evaluate(StepPoint& point, double t) {
    const State& s = point.state;
    assembler_.set_time(t);
    point.inputs.resize(system_.scalars().size());
    point.responses.resize(system_.scalars().size());
    assembler_.external(s.z, s.v, point.p);
    assembler_.multiply_stiffness(s.z, point.kz);
    assembler_.multiply_damping(s.v, point.cv);
    point.total = point.kz + point.cv - point.p;
    for (std::size_t j = 0; j < system_.scalars().size(); ++j) {
      const ScalarTerm& term = system_.scalars()[j];
      point.inputs[j] = assembler_.input(term, s.z, s.v);
      point.responses[j] = term.force->evaluate(point.inputs[j]);
      for (const Entry& e : term.z) point.total[e.index] += e.coeff * point.responses[j].y;
    }
    rhs_ = -point.total;
    series_.solve_mass(rhs_, point.state.a);
  }

  void judge_energy() {
    if (!running()) return;
    const EnergyBalance& b = summary_.energy;
    if (std::abs(b.relative_error()) <= options_.energy_tolerance) return;
    std::ostringstream text;
    text << "the energy balance is off by " << b.relative_error()
         << " of the energy, worst at t = " << b.worst_time << " s; at most "
         << options_.energy_tolerance << " passes: ask for a smaller tolerance";
    summary_.status = RunStatus::energy_error;
    summary_.reason = text.str();
  }

  void not_finite(const State& state) {
    for (int k = 0; k < system_.size(); ++k)
      if (!std::isfinite(state.z[k]) || !std::isfinite(state.v[k]))
        return fail(RunStatus::not_finite, "the motion of " + system_.unknown_name(k));
  }

  std::string where(double t) const {
    std::ostringstream text;
    text.precision(12);
    text << system_.name() << ": at t = " << t << " s: ";
    return text.str();
  }

  void fail(RunStatus status, const std::string& what) {
    if (!running()) return;
    summary_.status = status;
    summary_.reason = where(now_.state.t) + what;
  }

  const System& system_;
  const ExactOptions& options_;
  const std::vector<Observer*>& observers_;
  Assembler assembler_;
  TaylorSeries series_;
  KnownForces known_;
  LawPieces laws_;
  StepPoint now_, next_, inside_[2];
  Vector rhs_;
  EnergyMonitor* energy_ = nullptr;
  RunSummary summary_;
  double fastest_ = 0.0, largest_step_ = 0.0, growing_step_ = 0.0;
  int changes_here_ = 0, change_limit_ = 0;
};

void check_options(const System& system, const ExactOptions& o, const State& state) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/exact", findings);
  check.within("tolerance", o.tolerance, 1e-15, 1e-3, "");
  check.finite("t_start", o.t_start, "s");
  if (!(o.t_end > o.t_start) || !std::isfinite(o.t_end))
    check.fail("t_end", to_text(o.t_end), "s",
               "must be greater than t_start = " + to_text(o.t_start));
  check.positive("energy_tolerance", o.energy_tolerance, "");
  if (state.z.size() != system.size() || state.v.size() != system.size())
    check.fail("state", std::to_string(state.z.size()), "unknowns",
               "must have " + std::to_string(system.size()));
  else if (!state.z.allFinite() || !state.v.allFinite())
    check.fail("state", "not finite", "", "must be finite");
  if (state.history.size() != system.history_size())
    check.fail("state's history", std::to_string(state.history.size()), "numbers",
               "must have " + std::to_string(system.history_size()));
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
