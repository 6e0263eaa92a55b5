#include "advice/figure_estimate.hpp"

#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/run/after_time.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>

#include "solvers/accuracy/accuracy_observers.hpp"

namespace drev {

namespace {

constexpr double kSafety = 2.0;  // error over the difference of two runs
constexpr double kFirstOfExact = 1e-2,
                 kTighterExact = 1e-3;  // tolerance over accuracy, from run to run
constexpr double kTighterSteps = 0.1;
constexpr double kLeastTolerance = 1e-12;
constexpr int kLevels = 4, kLevelsOfSteps = 8;
constexpr double kFirstSteps = 500.0;    // steps of the run, in the first run
constexpr double kLeastOrder = 0.25;     // difference of constant steps over the one before, at least
constexpr double kSecondsOfWork = 2e-9;  // s for each unit of MethodChoice::exact_work
constexpr double kWorthAsking = 5e-3;    // s of exact propagation beyond which stepping may be cheaper
constexpr double kSensitive = 0.01;      // relative difference of the last states: another trajectory
constexpr int kEnsemble = 8;

struct Run {
  double value = 0.0;
  State end;
  std::vector<Peak> watched;
  std::string failure;
};

/// To two digits: more of a measured time mean nothing.
std::string rounded(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", seconds);
  return text;
}

Run run_once(const System& system, const Method& method, const FigureOptions& o, State state,
             double most_seconds = std::numeric_limits<double>::infinity()) {
  PeakWatch peak(find_channels(system, o.channels));
  AfterTime figure(o.from, {&peak});  // the part of the run that counts
  Peaks watched(find_channels(system, o.watch));
  std::vector<Observer*> observers{&figure};
  if (!o.watch.empty()) observers.push_back(&watched);
  Run run;
  // A balance that is off is an error of the figure like any other, and shows in its estimate.
  const std::clock_t begin = std::clock();
  const RunSummary summary =
      run_method(system, method,
                 {.t_end = o.t_end,
                  .energy_tolerance = 1e300,
                  .progress =
                      [&](double) {
                        if (o.pause) o.pause();
                        return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC < most_seconds;
                      }},
                 state, observers);
  if (!summary.ok()) run.failure = summary.reason;
  if (summary.status == RunStatus::interrupted)
    run.failure = "a run takes longer than the time allowed for it, " + rounded(most_seconds) + " s";
  run.value = peak.value();
  run.end = std::move(state);
  run.watched = watched.peaks();
  return run;
}

Run run_once(const System& system, const Method& method, const FigureOptions& o,
             double most_seconds = std::numeric_limits<double>::infinity()) {
  return run_once(system, method, o, State::initial(system), most_seconds);
}

Method tighter(Method m) {
  if (m.exact())
    m.tolerance = std::max(kLeastTolerance, kTighterExact * m.tolerance);
  else if (m.controlled())
    m.tolerance = std::max(kLeastTolerance, kTighterSteps * m.tolerance);
  else
    m.step *= 0.5;
  return m;
}

double largest(const Vector& x) { return x.size() == 0 ? 0.0 : x.cwiseAbs().maxCoeff(); }

bool apart(const State& a, const State& b) {
  return largest(a.z - b.z) > kSensitive * largest(b.z) || largest(a.v - b.v) > kSensitive * largest(b.v);
}

/// Mean and prediction interval over neighbouring runs.
void as_statistic(const System& system, const FigureOptions& o, const Run& first, const Run& second,
                  FigureEstimate& e) {
  std::vector<double> values{first.value, second.value};
  const double z = largest(first.end.z), v = largest(first.end.v);
  for (int i = 1; i <= kEnsemble; ++i) {
    const Run run = run_once(system, e.method, o, neighbour(system, i, z, v));
    if (run.failure.empty()) values.push_back(run.value);
  }
  const auto n = static_cast<int>(values.size());
  static_cast<Estimate&>(e) = batch_mean(values, n);
  e.error *= std::sqrt(n + 1.0);  // of one more run, not of the mean
  for (const double value : values) e.error = std::max(e.error, std::abs(value - e.value));
}

/// The estimate with one method; fails where a run takes longer than most_seconds.
FigureEstimate estimate_with(const System& system, const Method& first, const FigureOptions& o,
                             double most_seconds) {
  FigureEstimate e;
  e.method = first;
  // Contacts let small differences of the state grow without bound.
  const bool contacts = contact_count(system) > 0, constant = first.tolerance == 0.0;
  double before = 0.0;  // the last difference: one of constant steps may be small by chance
  try {
    Run coarse = run_once(system, e.method, o, most_seconds);
    for (int level = 1; coarse.failure.empty(); ++level) {
      const Method fine_method = tighter(e.method);
      const Run fine = run_once(system, fine_method, o, most_seconds);
      e.failure = fine.failure;
      e.value = coarse.value;
      e.watched = coarse.watched;
      const double difference = std::abs(coarse.value - fine.value);
      e.error = kSafety * std::max(difference, kLeastOrder * before) + e.method.tolerance * coarse.value;
      before = difference;
      const bool uncertain = contacts && apart(coarse.end, fine.end);
      const bool enough = e.error <= o.accuracy * e.value && (!constant || level > 1);
      if (!e.failure.empty() || enough || level == (constant ? kLevelsOfSteps : kLevels) ||
          (uncertain && !constant && level > 1)) {
        if (e.failure.empty() && uncertain) as_statistic(system, o, coarse, fine, e);
        return e;
      }
      e.method = fine_method;
      coarse = fine;
    }
    e.failure = coarse.failure;
  } catch (const SolverError& error) {
    e.failure = error.what();
  }
  return e;
}

}  // namespace

FigureEstimate estimate_figure(const System& system, const FigureOptions& o) {
  const MethodChoice choice = choose_method(system, o.t_end, o.step);
  Method method = choice.method;
  if (!method.exact()) {
    if (method.controlled()) method.tolerance = std::clamp(o.accuracy, kLeastTolerance, 1e-2);
    return estimate_with(system, method, o, o.most_seconds);
  }
  // Implicit steps that leave the fastest modes aside.
  if (const double seconds = kSecondsOfWork * choice.exact_work; seconds > kWorthAsking) {
    const FigureEstimate stepped = estimate_with(system, {.name = "sdirk4", .step = o.t_end / kFirstSteps}, o,
                                                 std::min(seconds, o.most_seconds));
    if (stepped.failure.empty() && stepped.kind == Estimate::Kind::estimate &&
        stepped.error <= o.accuracy * stepped.value)
      return stepped;
  }
  method.tolerance = std::clamp(kFirstOfExact * o.accuracy, kLeastTolerance, 1e-4);
  return estimate_with(system, method, o, o.most_seconds);
}

double figure_of_run(const System& system, const Method& method, const FigureOptions& options) {
  const Run run = run_once(system, method, options);
  if (!run.failure.empty()) throw SolverError(run.failure);
  return run.value;
}

}  // namespace drev
