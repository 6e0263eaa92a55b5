#include "solvers/batch/lockstep.hpp"

#include <drev/core/control/controllers.hpp>
#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/run/progress.hpp"
#include "solvers/run/run_verdict.hpp"
#include "solvers/run/stops.hpp"
#include "solvers/stepping/halved_step.hpp"

namespace drev {

namespace {

constexpr double kSameStep = 1e-10;  // as in step_equation.cpp

/// Up to kLanes variants; the last one fills what is left.
std::array<const System*, kLanes> fill(const std::vector<const System*>& systems) {
  std::array<const System*, kLanes> all;
  for (std::size_t lane = 0; lane < kLanes; ++lane) all[lane] = systems[std::min(lane, systems.size() - 1)];
  return all;
}

}  // namespace

std::optional<std::string> why_not_lockstep(const System& system, const TransientOptions& o) {
  if (o.scheme.tableau) return "lockstep is for methods of the generalized-alpha family";
  if (o.tolerance > 0.0) return "steps controlled by their error differ between variants";
  if (o.locate_contacts.value_or(false)) return "located contact changes differ between variants";
  if (!system.frictions().empty()) return "the model has dry friction";
  if (!system.generals().empty()) return "the model has general elements";
  if (!system.varying_inertias().empty()) return "the model has an inertia that follows the angle";
  if (const auto why = why_not_controllers(system, "lockstep")) return why;
  if (system.rows().rows() > 0) return "the model is a projected one";
  if (static_cast<int>(system.scalars().size()) > o.newton.max_dense_contacts)
    return "the model has more laws than max_dense_contacts";
  return std::nullopt;
}

Lockstep::Lockstep(const std::vector<const System*>& systems, const TransientOptions& options,
                   const std::vector<std::string>& channels)
    : systems_(fill(systems)),
      count_(systems.size()),
      options_(options),
      scheme_(options.scheme),
      results_(count_),
      matrices_(systems_),
      factor_(matrices_.pattern, matrices_.chain),
      laws_(systems_),
      loads_(systems_),
      watch_(systems_, channels),
      lambda_(idx(laws_.count())) {
  const std::size_t n = idx(matrices_.n);
  for (const System* system : systems_) {
    steppers_.push_back(std::make_unique<GeneralizedAlpha>(*system, scheme_, options.newton));
    assemblers_.emplace_back(*system);
    coarse_.emplace_back(*system);
    stiff_.emplace_back(*system);
  }
  for (LanePoint* point : {&now_, &next_}) {
    for (LaneArray* a : {&point->z, &point->v, &point->a, &point->p}) a->resize(n);
    if (scheme_.alpha_f != 0.0) point->total.resize(n);
    laws_.prepare(point->laws);
  }
  for (LaneArray* a : {&known_, &a_}) a->resize(n);
  w_.rows.resize(n * lambda_.size());
  for (std::size_t lane = 0; lane < count_; ++lane) alive_[static_cast<int>(lane)] = -1;
}

std::vector<VariantResult> Lockstep::run(const std::function<bool(double)>& go_on) {
  t_ = options_.t_start;
  for (std::size_t i = 0; i < count_; ++i) {
    RunSummary& s = results_[i].summary;
    s.scheme = scheme_.name;
    s.step = options_.step;
    results_[i].in_lockstep = true;
  }
  start(t_, true);
  watch_.start(assemblers_, now_, t_);
  // All systems have the same breakpoints.
  const Stops stops(*systems_[0], options_.t_end, kSameStop * options_.step);
  const Progress progress(go_on, options_.t_start, options_.t_end);
  while (any(alive_) && t_ < options_.t_end) {
    const Stop stop = stops.after(t_);
    const EvenSteps steps(t_, stop.t, options_.step);
    prepare(steps.h);
    for (double i = 1.0; i <= steps.count && any(alive_); i += 1.0) {
      const double t_new = steps.end_of(i);
      step(steps.h, t_new, i == steps.count ? stop.evaluation_time() : t_new);
      if (progress.goes_on(steps_, t_)) continue;
      for (int lane = 0; lane < kLanes; ++lane)
        if (alive(lane)) {
          end_interrupted(results_[idx(lane)].summary, systems_[idx(lane)]->name(), t_);
          finish_lane(lane, t_);
        }
    }
    if (stop.at_break && t_ < options_.t_end) start(t_, false);
  }
  for (int lane = 0; lane < kLanes; ++lane)
    if (alive(lane)) finish_lane(lane, t_);
  return std::move(results_);
}

/// Consistent accelerations, at the start and behind breakpoints.
void Lockstep::start(double t, bool first) {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!first && !alive(lane)) continue;
    EvaluatedState& point = *to_alone_;
    if (first)
      point.state = State::initial(*systems_[idx(lane)], t);
    else
      now_.get(lane, point);
    point.state.t = t;
    if (!first) {
      *from_alone_ = point;
      assemblers_[idx(lane)].multiply_stiffness(point.state.z, from_alone_->kz);
    }
    GeneralizedAlpha& stepper = *steppers_[idx(lane)];
    stepper.start(point);
    now_.set(lane, point);
    for (std::size_t j = 0; j < lambda_.size(); ++j) lambda_[j].v[lane] = point.responses[j].y;
    force_scale_.v[lane] = std::max<double>(force_scale_.v[lane], largest_force(point));
    if (first) {
      monitors_.push_back(std::make_unique<EnergyMonitor>(stepper.assembler(), point));
    } else {
      monitors_[idx(lane)]->restore(energy_.get(lane));
      monitors_[idx(lane)]->restart(*from_alone_, point);
    }
    energy_.set(lane, monitors_[idx(lane)]->balance());
    assemblers_[idx(lane)].set_time(t);
    if (!first || !alive(lane)) continue;
    RunSummary& s = results_[idx(lane)].summary;
    check_start(s, assemblers_[idx(lane)], point);
    if (!s.ok()) finish_lane(lane, t);
  }
}

/// The factor and the compliance of the contacts for steps of length h.
void Lockstep::prepare(double h) {
  if (std::abs(h - h_) <= kSameStep * h) return;
  h_ = h;
  const Weights weights = scheme_.weights(h);
  matrices_.combine(weights, values_);
  factor_.factorize(values_);
  ++factorizations_;
  for (int lane = 0; lane < kLanes; ++lane)
    if (alive(lane) && !factor_.ok(lane)) {
      alive_[lane] = 0;
      results_[idx(lane)].error = why_no_factor(*systems_[idx(lane)], scheme_.name, h, weights);
    }
  const LaneArray zero(idx(matrices_.n));
  LaneArray column(zero.size());
  for (int j = 0; j < laws_.count(); ++j) {
    laws_.row(j, column);
    factor_.solve(column.data(), 0.0, zero.data(), column.data());
    for (std::size_t i = 0; i < column.size(); ++i) w_.rows[i * lambda_.size() + idx(j)] = column[i];
  }
  w_.find_common();
  laws_.set_compliance(w_.rows, weights.k, weights.c);
}

DREV_WIDEST
void Lockstep::solve(double h, double t_evaluate, LaneMask& failed) {
  const double phi = 1.0 - scheme_.alpha_f;
  const StepOptions& newton = options_.newton;
  // Loads start at the acceleration so far.
  LaneMotion motion{next_.z.data(), next_.v.data(), now_.a.data(), scheme_.beta * h * h, scheme_.gamma * h};
  LaneMask open = alive_;
  const Lanes none{}, one = none + 1.0;
  loads_.evaluate(motion, open, next_.p);
  if (laws_.phased()) laws_.take_angles(assemblers_, motion, next_.laws);
  for (int pass = 1;; ++pass) {
    passes_.v += open ? one : none;
    factor_.solve(known_.data(), phi, next_.p.data(), a_.data());
    LaneRow scale = force_scale_, change, steepness;
    if (any(scale.v <= 0.0)) {
      largest(next_.p, change);
      scale.v = scale.v > 0.0 ? scale.v : change.v;
    }
    if (laws_.count() > 0) {
      LaneMotion free = motion;
      free.a = a_.data();
      LaneMask unsolved = open;
      laws_.solve(free, t_evaluate, scale, newton.contact.tolerance, unsolved, lambda_.data(), next_.laws,
                  iterations_);
      failed |= unsolved;
      open &= ~unsolved;
    } else {
      iterations_.v += open ? one : none;
    }
    correct(phi, w_, lambda_, motion.a, a_, change);
    a_.swap(next_.a);
    motion.a = next_.a.data();
    if (!loads_.depend_on_motion()) return;
    const Lanes small = newton.load_tolerance * scale.v;
    if (loads_.steepness_known()) {
      loads_.steepness(steepness);
      open &= steepness.v * (motion.kappa_z * change.v) > small;
      if (!any(open)) return;
      loads_.evaluate(motion, open, next_.p);
    } else {
      p_before_ = next_.p;
      loads_.evaluate(motion, open, next_.p);
      largest_difference(next_.p, p_before_, change);
      open &= change.v > small;
      if (!any(open)) return;
    }
    if (pass == newton.max_load_passes) {
      failed |= open;
      return;
    }
  }
}

DREV_WIDEST
void Lockstep::step(double h, double t_new, double t_evaluate) {
  for (Assembler& assembler : assemblers_) assembler.set_time(t_evaluate);
  loads_.set_time(assemblers_);
  if (laws_.has_known()) laws_.take_known(assemblers_);
  predict(matrices_, scheme_, h, now_, known_, next_);
  LaneMask failed{};
  solve(h, t_evaluate, failed);
  LaneMask good = alive_ & ~failed;
  next_.laws.t = t_evaluate;
  laws_.energies(next_.laws);
  laws_.forces(next_.laws.y, by_);
  LaneRow extra;
  if (laws_.extra_input())
    laws_.add_extra_input(
        now_.laws, now_.z.data(), next_.laws,
        {next_.z.data(), next_.v.data(), next_.a.data(), scheme_.beta * h * h, scheme_.gamma * h}, extra);
  finish(matrices_, scheme_, h, t_new, now_, by_, extra, next_, good, energy_, force_scale_);
  watch_.step(assemblers_, now_, next_, h, t_new, good);
  for (int lane = 0; lane < static_cast<int>(count_); ++lane)
    if (good[lane]) look_at(lane, h, t_new);
  if (const LaneMask alone = alive_ & ~good; any(alone))
    for (int lane = 0; lane < kLanes; ++lane)
      if (alone[lane]) step_alone(lane, h, t_new, t_evaluate);
  std::swap(now_, next_);
  t_ = t_new;
  ++steps_;
  // As grew() in run_verdict.hpp.
  const Lanes limit = options_.energy_growth_limit * energy_.given.v;
  const LaneMask grow =
      alive_ & (energy_.imbalance.v > limit) & (energy_.given.v > 0.0) & (energy_.imbalance.v > kNoEnergy);
  if (any(grow & grow_))
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!alive(lane) || !grow[lane] || !grow_[lane]) continue;
      end_growing_run(results_[idx(lane)].summary, systems_[idx(lane)]->name(), t_,
                      options_.energy_growth_limit);
      finish_lane(lane, t_);
    }
  grow_ = grow;
}

/// What the run's warnings are made from, of a step that the lane made with the others.
void Lockstep::look_at(int lane, double h, double t_new) {
  const bool coarse = coarse_[idx(lane)].due(h), stiff = stiff_[idx(lane)].due();
  if (!coarse && !stiff) return;
  Assembler& assembler = assemblers_[idx(lane)];
  now_.get(lane, look_from_);
  look_from_.state.t = t_;
  next_.get(lane, look_to_);
  look_to_.state.t = t_new;
  if (stiff) stiff_[idx(lane)].look(assembler, look_to_);
  if (!coarse) return;
  const double time = assembler.time();
  coarse_[idx(lane)].look(assembler, look_from_, look_to_, h);
  assembler.set_time(time);
}

void Lockstep::step_alone(int lane, double h, double t_new, double t_evaluate) {
  now_.get(lane, *from_alone_);
  from_alone_->state.t = t_;
  assemblers_[idx(lane)].multiply_damping(from_alone_->state.v, from_alone_->cv);
  StepEquation& equation = steppers_[idx(lane)]->equation();
  equation.start_from(*from_alone_);
  equation.expect_force(force_scale_.v[lane]);
  monitors_[idx(lane)]->restore(energy_.get(lane));
  ++results_[idx(lane)].steps_alone;
  RunSummary& s = results_[idx(lane)].summary;
  HalvedStep halved(*steppers_[idx(lane)], from_alone_, to_alone_, options_.max_halvings, s,
                    [this, lane](double length, double) { return accept_alone(lane, length); });
  const bool goes_on = halved.make(h, t_new, t_evaluate);
  const EvaluatedState& end = *from_alone_;  // of its last step
  if (!goes_on) {
    now_.set(lane, end);
    return finish_lane(lane, end.state.t);
  }
  --s.steps;  // one of them is everybody's
  next_.laws.t = t_evaluate;
  for (std::size_t j = 0; j < lambda_.size(); ++j) lambda_[j].v[lane] = end.responses[j].y;
  force_scale_.v[lane] = std::max<double>(force_scale_.v[lane], largest_force(end));
}

/// Enters a step that the lane made by itself, from from_alone_ to to_alone_, and swaps them; returns whether
/// the lane's run goes on.
bool Lockstep::accept_alone(int lane, double h) {
  RunSummary& s = results_[idx(lane)].summary;
  const Assembler& assembler = steppers_[idx(lane)]->assembler();
  ++s.steps;
  if (!monitors_[idx(lane)]->step(*from_alone_, *to_alone_, h)) {
    end_not_finite(s, assembler, *from_alone_, *to_alone_);
    return false;
  }
  energy_.set(lane, monitors_[idx(lane)]->balance());
  now_.set(lane, *from_alone_);
  next_.set(lane, *to_alone_);
  LaneMask this_lane{};
  this_lane[lane] = -1;
  assemblers_[idx(lane)].set_time(assembler.time());
  watch_.step(assemblers_, now_, next_, h, to_alone_->state.t, this_lane);
  std::swap(from_alone_, to_alone_);
  return true;
}

/// The lane's result, from what it stands at at time t.
void Lockstep::finish_lane(int lane, double t) {
  VariantResult& r = results_[idx(lane)];
  RunSummary& s = r.summary;
  EvaluatedState point;
  now_.get(lane, point);
  r.state = std::move(point.state);
  r.state.t = t;
  r.peaks = watch_.peaks(lane);
  r.contacts = watch_.contacts(lane);
  const StepEquation& equation = steppers_[idx(lane)]->equation();
  s.t_end = t;
  s.steps += steps_;
  s.iterations += static_cast<long>(iterations_.v[lane]);
  s.load_passes = static_cast<long>(passes_.v[lane]) + equation.load_passes();
  s.factorizations = factorizations_ + equation.factorizations();
  s.solves = s.load_passes + equation.solves() - equation.load_passes();
  s.energy = energy_.get(lane);
  judge_energy(s, options_.energy_tolerance);
  coarse_[idx(lane)].warn(s, options_.step);
  stiff_[idx(lane)].warn(s);
  alive_[lane] = 0;
}

}  // namespace drev
