#include <drev/solvers/run/after_time.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <algorithm>
#include <utility>

#include "solvers/run/run_checks.hpp"
#include "solvers/run/stops.hpp"

namespace drev {

AfterTime::AfterTime(double begin, std::vector<Observer*> observers)
    : begin_(begin), observers_(std::move(observers)) {
  check_observers(observers_, "observers from a time on");
}

bool AfterTime::fits(const System& system) const {
  return std::all_of(observers_.begin(), observers_.end(),
                     [&](const Observer* o) { return o->fits(system); });
}

void AfterTime::start(const Assembler& assembler, const EvaluatedState& point) {
  started_ = point.state.t >= begin_;
  if (!started_) return;
  for (Observer* o : observers_) o->start(assembler, point);
}

void AfterTime::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  if (started_) {
    for (Observer* o : observers_) o->step(assembler, from, to);
    return;
  }
  // A stop that differs from it by rounding is that time.
  if (to.state.t < begin_ - kSameStop * (to.state.t - from.state.t)) return;
  started_ = true;
  for (Observer* o : observers_) o->start(assembler, to);
}

double AfterTime::next_stop(double t) const {
  if (!started_) return begin_;
  double stop = std::numeric_limits<double>::infinity();
  for (const Observer* o : observers_) {
    const double wanted = o->next_stop(t);
    if (wanted > t) stop = std::min(stop, wanted);
  }
  return stop;
}

bool AfterTime::looks_inside(const EvaluatedState& from, const EvaluatedState& to,
                             const double* beyond_cubic) {
  if (!started_) return false;
  bool looks = false;  // each is asked: what it hears tells it that nothing passes its peaks
  for (Observer* o : observers_) looks |= o->looks_inside(from, to, beyond_cubic);
  return looks;
}

bool AfterTime::watches_loads() const {
  return std::any_of(observers_.begin(), observers_.end(),
                     [](const Observer* o) { return o->watches_loads(); });
}

bool AfterTime::needs_acceleration() const {
  return std::any_of(observers_.begin(), observers_.end(),
                     [](const Observer* o) { return o->needs_acceleration(); });
}

}  // namespace drev
