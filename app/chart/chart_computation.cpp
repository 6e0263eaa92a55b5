#include "app/chart/chart_computation.hpp"

#include <drev/solvers/accuracy/error_growth.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/interrupt.hpp"
#include "app/base/progress.hpp"
#include "app/base/text_layout.hpp"
#include "solvers/accuracy/processor_time.hpp"

namespace drev::app {

namespace {

constexpr double kMostGrowth = 1000.0;  // of a small difference
constexpr int kLeastSamples = 64;
constexpr double kGrowthTolerance = 1e-13;
constexpr double kOfLimit = 0.5;   // what the chosen method may take of the limit, so that others have room
constexpr int kFirstParts = 1024;  // of the duration, with which its pace is sought

/// The span over which the method stays within its part of the limit: the duration, or less of it by the pace of
/// longer and longer runs, each four times the one before; what any run takes however short it is no pace.
double affordable_span(const System& system, const Method& method, double duration, double limit) {
  const double most = kOfLimit * limit;
  double span_before = 0.0, seconds_before = 0.0;
  for (double span = duration / kFirstParts;; span = std::min(duration, 4.0 * span)) {
    const double start = processor_time();
    const auto goes_on = [&](double) { return !interrupted() && processor_time() < start + limit; };
    try {
      const RunSummary run =
          run_method(system, method, {.t_end = span, .energy_tolerance = 1e300, .progress = goes_on});
      if (!run.ok()) return span_before > 0.0 ? span_before : duration;
    } catch (const std::runtime_error&) {
      return span;  // what comes next says why
    }
    const double seconds = processor_time() - start;
    if (span_before > 0.0 && (span == duration || seconds > 0.25 * most)) {
      const double pace = std::max(seconds - seconds_before, 0.0) / (span - span_before);
      const double affordable = pace > 0.0 ? span + (most - seconds) / pace : duration;
      return std::clamp(affordable, std::min(span_before, duration), duration);
    }
    span_before = span;
    seconds_before = seconds;
  }
}

}  // namespace

ChartResult compute_chart(const ChartRequest& request) {
  const System& system = request.model.system;
  const ModelCase& model_case = request.model.model_case;
  ChartResult result;
  Progress shown;
  const auto progress = [&](double part) {
    shown.update(part);
    return !interrupted();
  };
  double horizon = model_case.duration;
  Method method = choose_method(system, horizon, std::min(model_case.default_step, horizon)).method;
  if (method.exact()) method.tolerance = kGrowthTolerance;
  if (const double span = affordable_span(system, method, horizon, request.limit); span < horizon) {
    result.horizon_reason = "longer runs pass half of the --limit, " + short_digits(request.limit, 3) +
                            " s; the whole " + short_digits(horizon, 4) + " s take --limit " +
                            short_digits(request.limit * horizon / span, 2);
    horizon = span;
  }
  const ErrorGrowth growth = measure_error_growth(
      system, {.method = method, .t_end = horizon, .progress = [&](double) { return !interrupted(); }});
  if (interrupted()) {
    result.data.interrupted = true;
    return result;
  }
  if (const double comparable = growth.time_of(kMostGrowth); comparable < horizon) {
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
  return result;
}

}  // namespace drev::app
