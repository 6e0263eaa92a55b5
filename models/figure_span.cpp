#include "models/figure_span.hpp"

#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/start.hpp>

#include <cmath>

#include "core/names/rounded_text.hpp"

namespace drev {

namespace {

/// In which loads repeat at a nominal speed that is constant over the run [s]; 0: it is not, or they do not.
double cycle_of(const System& system, double turn, double duration) {
  const double cycle = time_of_turn(system, turn > 0.0 ? turn : 1.0, duration);
  const bool stands = !system.reference() || !system.reference()->at;
  return turn > 0.0 || (cycle == 0.0 && !stands) ? cycle : load_cycle(system);
}

}  // namespace

FigureSpan figure_span(const std::optional<Settle>& asked, const System& system, bool periodic,
                       double duration, double turn) {
  FigureSpan span;
  span.settled = periodic;
  if (!asked) return span;
  if (asked->time) {
    span.from = *asked->time;
    span.reason = "as asked for";
    return span;
  }
  if (periodic) {
    span.reason = "the run starts in its periodic steady state";
    return span;
  }
  const Settling settling = settling_time(system);
  const double cycle = settling.time < duration ? cycle_of(system, turn, duration) : 0.0;
  span.settled = settling.time + cycle < duration;
  if (span.settled) span.from = settling.time;
  const auto seconds = [](double time) { return rounded_text(time, 6) + " s"; };
  if (span.settled)
    span.reason = settling.reason;
  else if (settling.time < duration)
    span.reason = "the run of " + seconds(duration) + " ends less than one cycle of " + seconds(cycle) +
                  " after it has settled, and figures are of all of it (from " +
                  seconds(settling.time + cycle) + " on there is a whole cycle): " + settling.reason;
  else
    span.reason = "the run of " + seconds(duration) +
                  " does not settle, and figures are of all of it: " + settling.reason;
  return span;
}

double time_of_turn(const System& system, double angle, double duration) {
  const auto& reference = system.reference();
  if (!reference || !reference->at) return 0.0;
  const double speed = reference->at(0.0).rate;
  if (speed == 0.0 || reference->at(duration).rate != speed) return 0.0;
  return angle / std::abs(speed);
}

}  // namespace drev
