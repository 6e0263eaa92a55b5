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

System started(System system, const FigureOptions& figure) {
  if (figure.start == Start::rest) return system;
  FoundStart found = find_start(system, figure.start,
                                {.duration = figure.t_end,
                                 .method = choose_method(system, figure.t_end, figure.step).method,
                                 .progress = [&](double) {
                                   if (figure.pause) figure.pause();
                                   return true;
                                 }});
  // A figure that begins anywhere on a motion that does not repeat is none of the model.
  if (const std::string why = found.unsettled(); !why.empty()) throw SolverError(system.name() + ": " + why);
  return std::move(found.system);
}

System Recipe::build() const {
  System system = turns ? model.build() : started(model.build(), figure);
  return reduction ? reduce(system, *reduction).system : system;
}

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
