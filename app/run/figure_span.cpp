#include "app/run/figure_span.hpp"

#include <drev/solvers/modes/damped_modes.hpp>

#include "app/base/text_layout.hpp"

namespace drev::app {

FigureSpan figure_span(const std::optional<Settle>& asked, const System& system, bool periodic,
                       double duration, double cycle) {
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
  span.settled = settling.time + cycle < duration;
  if (span.settled) span.from = settling.time;
  if (span.settled)
    span.reason = settling.reason;
  else if (settling.time < duration)
    span.reason = "the run of " + short_digits(duration, 6) + " s ends less than one cycle of " +
                  short_digits(cycle, 6) + " s after it has settled, and figures are of all of it (from " +
                  short_digits(settling.time + cycle, 6) +
                  " s on there is a whole cycle): " + settling.reason;
  else
    span.reason = "the run of " + short_digits(duration, 6) +
                  " s does not settle, and figures are of all of it: " + settling.reason;
  return span;
}

}  // namespace drev::app
