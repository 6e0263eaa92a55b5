#include "app/study/study_runs.hpp"

#include <drev/core/units.hpp>
#include <drev/solvers/accuracy/error_growth.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/statics.hpp>

#include <algorithm>
#include <cmath>
#include <future>
#include <map>
#include <mutex>

#include "app/base/interrupt.hpp"
#include "app/base/text_layout.hpp"
#include "app/run/run_computation.hpp"
#include "app/run/static_force.hpp"
#include "models/camshaft/published.hpp"
#include "solvers/run/for_all.hpp"

namespace drev::app {

namespace {

constexpr double kSettled = 1.0;                 // s
constexpr double kNudge = 1e-9;                  // rad
constexpr double kCoarse = 1e-7, kFine = 1e-11;  // tolerances of exact propagation
constexpr std::size_t kStepRuns = 8;

}  // namespace

void for_all(std::size_t count, const std::function<void(std::size_t)>& task) {
  drev::for_all(count, 0, [&task](std::size_t i, std::size_t) {
    if (interrupted()) throw SolverError("interrupted");
    task(i);
  });
}

Method source_method() { return {.name = "average_acceleration", .step = published::kStep}; }

Method exact_method(double tolerance) { return {.name = kExact, .tolerance = tolerance}; }

RunSummary run_watched(const System& system, const Method& method, double t_end,
                       const std::vector<Observer*>& observers) {
  const RunSummary summary = run_method(
      system, method, {.t_end = t_end, .progress = [](double) { return !interrupted(); }}, observers);
  if (!summary.ok() && summary.status != RunStatus::energy_error)
    throw SolverError(system.name() + ": " + summary.reason);
  return summary;
}

WindowPeaks::WindowPeaks(std::vector<Channel> channels, bool inside_steps, double start, double length)
    : peaks_(std::move(channels), inside_steps),
      start_(start),
      length_(length),
      window_(start > 0.0 ? -1 : 0) {}

void WindowPeaks::start(const Assembler& assembler, const EvaluatedState& point) {
  peaks_.start(assembler, point);
}

void WindowPeaks::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  peaks_.step(assembler, from, to);
  if (to.state.t < edge(window_ + 1) - 1e-9 * length_) return;
  largest_ = std::max(largest_, amplitude());
  if (window_ >= 0) amplitudes_.push_back(amplitude());
  peaks_.start(assembler, to);
  ++window_;
}

namespace {

CamshaftFigures make_run(const ParameterValues& parameters, const Method& method, double nudge) {
  ModelCase model_case = build_case("camshaft", parameters);
  if (nudge != 0.0) model_case.model.set_initial("end", nudge, 0.0);
  const System system = model_case.model.build();
  const bool inside = method.exact();
  Peaks deflection(find_channels(system, {model_case.deflection}), false);
  Peaks torque(find_channels(system, model_case.torques), false);
  const double revolution = model_case.static_turn / system.reference_speed();
  WindowPeaks settled_deflection(find_channels(system, {model_case.deflection}), inside, kSettled,
                                 revolution);
  WindowPeaks settled_torque(find_channels(system, model_case.torques), inside, kSettled, revolution);
  ContactStatistics contacts(system, inside);
  std::vector<Observer*> observers{&contacts};
  // Constant steps would be cut at the windows' ends, and a run that rattles be another.
  if (method.exact())
    observers.insert(observers.end(), {&settled_deflection, &settled_torque});
  else
    observers.insert(observers.end(), {&deflection, &torque});
  CamshaftFigures figures;
  figures.summary = run_watched(system, method, model_case.duration, observers);
  figures.deflection = to_deg(inside ? settled_deflection.largest() : deflection.peaks()[0].amplitude());
  figures.torque = inside ? settled_torque.largest() : torque.peaks()[torque.largest()].amplitude();
  figures.settled_deflection = to_deg(mean_of(settled_deflection.amplitudes()).value);
  figures.settled_torque = mean_of(settled_torque.amplitudes()).value;
  for (const ContactRecord& record : contacts.records()) {
    figures.front += static_cast<double>(record.front_impacts);
    figures.back += static_cast<double>(record.back_impacts);
  }
  return figures;
}

}  // namespace

CamshaftFigures run_camshaft(const ParameterValues& parameters, const Method& method, double nudge) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_future<CamshaftFigures>> runs;
  const std::string name = join(values_of(find_model("camshaft"), parameters).values()) + ", " +
                           to_text(method) + ", " + short_digits(nudge, 17);
  std::promise<CamshaftFigures> promise;
  std::unique_lock lock(mutex);
  const auto [entry, is_new] = runs.try_emplace(name);
  if (!is_new) {
    const std::shared_future<CamshaftFigures> made = entry->second;
    lock.unlock();
    return made.get();
  }
  entry->second = promise.get_future().share();
  lock.unlock();
  try {
    const CamshaftFigures figures = make_run(parameters, method, nudge);
    promise.set_value(figures);
    return figures;
  } catch (...) {
    promise.set_exception(std::current_exception());
    throw;
  }
}

Estimate CamshaftCase::estimate(Member member) const {
  if (!statistic) return from_two(exact[0].*member, exact[1].*member, kFine);
  std::vector<double> values;
  for (const CamshaftFigures& run : exact) values.push_back(run.*member);
  return mean_of(values);
}

double CamshaftCase::at_step(Member member) const {
  double sum = 0.0;
  for (const CamshaftFigures& run : source) sum += run.*member;
  return sum / static_cast<double>(source.size());
}

std::string CamshaftCase::step_cell(Member member) const {
  if (!statistic) return cell(source[0].*member);
  const auto [low, high] = std::minmax_element(
      source.begin(), source.end(), [member](const auto& a, const auto& b) { return a.*member < b.*member; });
  return digits(at_step(member), 4) + " (" + digits((*low).*member, 3) + " to " + digits((*high).*member, 3) +
         ")";
}

std::vector<CamshaftCase> run_cases(const std::vector<ParameterValues>& cases, int runs) {
  const bool statistic = runs > 2;
  const std::size_t at_step = statistic ? kStepRuns : 1, each = at_step + static_cast<std::size_t>(runs);
  std::vector<CamshaftCase> results(cases.size());
  for (CamshaftCase& result : results) {
    result.statistic = statistic;
    result.source.resize(at_step);
    result.exact.resize(each - at_step);
  }
  for_all(cases.size() * each, [&](std::size_t i) {
    ParameterValues parameters{{"loads", "source"}};
    for (const auto& parameter : cases[i / each]) parameters.push_back(parameter);
    CamshaftCase& result = results[i / each];
    const std::size_t run = i % each;
    if (run < at_step) {
      result.source[run] = run_camshaft(parameters, source_method(), kNudge * static_cast<double>(run));
      return;
    }
    const std::size_t k = run - at_step;
    result.exact[k] = statistic
                          ? run_camshaft(parameters, exact_method(1e-10), kNudge * static_cast<double>(k))
                          : run_camshaft(parameters, exact_method(k == 0 ? kCoarse : kFine), 0.0);
  });
  return results;
}

double static_torque(const ModelCase& model_case) {
  const System system = model_case.model.build();
  double largest = 0.0;
  for (const Peak& peak : static_sweep(system, find_channels(system, model_case.torques), 0.0,
                                       model_case.static_turn, kStaticAngles))
    largest = std::max(largest, peak.amplitude());
  return largest;
}

Estimate mean_of(const std::vector<double>& values) {
  return batch_mean(values, static_cast<int>(values.size()));
}

Estimate from_two(double coarse, double fine, double tolerance) {
  return {fine, 2.0 * std::abs(fine - coarse) + std::max(tolerance, 1e-14) * std::abs(fine)};
}

double shown_at_step(double frequency_Hz, double h) {
  return to_hz(2.0 / h * std::atan(0.5 * hz(frequency_Hz) * h));
}

std::string stands(bool it_does) { return it_does ? "stands" : "does not stand"; }

std::string cell(double value) { return digits(value, 5); }

std::string printed(double value) { return short_digits(value, 6); }

std::string percent(double value, double reference) {
  const double change = 100.0 * (value / reference - 1.0);
  return (change < 0.0 ? "-" : "+") + digits(std::abs(change), std::abs(change) < 1.0 ? 1 : 2) + " %";
}

}  // namespace drev::app
