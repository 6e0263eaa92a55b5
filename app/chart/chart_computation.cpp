#include "app/chart/chart_computation.hpp"

#include <drev/core/scalar_force.hpp>
#include <drev/solvers/accuracy/error_growth.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/interrupt.hpp"
#include "app/base/progress.hpp"
#include "app/base/text_layout.hpp"

namespace drev::app {

namespace {

constexpr double kPeriods = 20.0;       // of the lowest elastic mode
constexpr double kMostGrowth = 1000.0;  // of a small difference
constexpr int kLeastSamples = 64;
constexpr double kSameSpan = 1.01;  // whole samples may leave a little of the duration
constexpr double kGrowthTolerance = 1e-13;

/// Duration, cut to a number of periods of the lowest mode; with gaps modes say little.
double periods_of(const ModelRequest& model, std::string& reason) {
  const double duration = model.model_case.duration;
  for (const ScalarTerm& term : model.system.scalars())
    if (term.force->gap()) return duration;
  try {
    const ModeSet modes = solve_modes(model.system, {});
    if (modes.frequency_Hz.empty()) return duration;
    const double wanted = kPeriods / modes.frequency_Hz.front();
    if (wanted >= duration) return duration;
    reason = short_digits(kPeriods, 3) + " periods of the lowest mode, " +
             digits(modes.frequency_Hz.front(), 4) + " Hz";
    return wanted;
  } catch (const SolverError&) {
    return duration;  // no modes to go by
  }
}

}  // namespace

ChartResult compute_chart(const ChartRequest& request) {
  const System& system = request.model.system;
  const ModelCase& model_case = request.model.model_case;
  ChartResult result;
  double horizon = periods_of(request.model, result.horizon_reason);
  Progress shown;
  const auto progress = [&](double part) {
    shown.update(part);
    return !interrupted();
  };
  Method method = choose_method(system, horizon, std::min(model_case.default_step, horizon)).method;
  if (method.exact()) method.tolerance = kGrowthTolerance;
  const ErrorGrowth growth = measure_error_growth(
      system, {.method = method, .t_end = horizon, .progress = [&](double) { return !interrupted(); }});
  if (interrupted()) {
    result.data.interrupted = true;
    return result;
  }
  const bool grows = growth.time_of(kMostGrowth) < horizon;
  if (const double comparable = growth.time_of(kMostGrowth); grows) {
    horizon = comparable;
    result.horizon_reason =
        "later, a small difference has grown by more than a factor of " + short_digits(kMostGrowth, 3);
  }
  // Samples at a power of two times the source's step, so that it is among the steps tried; fewer
  // than 64 of them where the horizon is short.
  int power = static_cast<int>(std::floor(std::log2(horizon / (kLeastSamples * kSourceStep))));
  if (horizon >= 4.0 * kSourceStep) power = std::max(power, 0);
  const double interval = std::ldexp(kSourceStep, power);
  WorkPrecisionOptions options{.sample_interval = interval,
                               .samples = std::max(2, static_cast<int>(horizon / interval + 1e-9)),
                               .methods = request.methods,
                               .most_seconds = request.limit,
                               .progress = progress};
  result.quantity = "all deflections";
  if (!model_case.deflection.empty()) {
    options.channels = {model_case.deflection};
    result.quantity = model_case.deflection;
  }
  result.data = work_precision(system, options);
  const double measured = result.data.t_end;
  const bool whole = grows || model_case.duration < kSameSpan * measured;
  result.advice_for = whole ? measured : model_case.duration;
  return result;
}

}  // namespace drev::app
