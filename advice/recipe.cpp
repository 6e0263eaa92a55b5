#include "advice/recipe.hpp"

#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>

#include <algorithm>

namespace drev {

namespace {

/// Largest |value| of the channels in steady motion.
Estimate steady_peak(const System& system, const FigureOptions& figure, double turns) {
  const PeriodicResponse response =
      solve_periodic(system, {.tolerance = figure.accuracy, .channels = figure.channels, .turns = turns});
  if (!response.found) throw SolverError(response.reason);
  Estimate steady;
  for (const Peak& peak : response.peaks) steady.value = std::max(steady.value, peak.amplitude());
  steady.error = response.error * steady.value;
  return steady;
}

}  // namespace

System Recipe::build() const { return reduction ? reduce(model.build(), *reduction).system : model.build(); }

double Recipe::run() const {
  const System system = build();
  return turns ? steady_peak(system, figure, *turns).value : figure_of_run(system, method, figure);
}

FigureEstimate Recipe::estimate() {
  const System system = build();
  find_channels(system, figure.channels);
  FigureEstimate e;
  if (turns) {
    try {
      static_cast<Estimate&>(e) = steady_peak(system, figure, *turns);
    } catch (const SolverError& error) {
      e.failure = error.what();
    }
    return e;
  }
  e = estimate_figure(system, figure);
  method = e.method;
  return e;
}

}  // namespace drev
