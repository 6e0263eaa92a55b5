#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/to_drev.hpp"

namespace coverage {

namespace {

constexpr int kTimes = 20;
constexpr double kMoved = 1e-9;    // relative, of the perturbed run
constexpr double kBeside = 1e-13;  // relative, of a time: its two sides

/// Values of channels at given times.
class Watch final : public drev::Observer {
 public:
  Watch(std::vector<drev::Channel> channels, const std::vector<double>& times)
      : channels_(std::move(channels)), times_(times), values(channels_.size()) {}
  void start(const drev::Assembler&, const drev::EvaluatedState&) override {}
  void step(const drev::Assembler& assembler, const drev::EvaluatedState&,
            const drev::EvaluatedState& to) override {
    if (next_ >= times_.size() || to.state.t < times_[next_]) return;
    for (std::size_t c = 0; c < channels_.size(); ++c)
      values[c].push_back(channels_[c].evaluate(assembler, to.state));
    ++next_;
  }
  double next_stop(double t) const override {
    const auto next = std::upper_bound(times_.begin(), times_.end(), t);
    return next == times_.end() ? std::numeric_limits<double>::infinity() : *next;
  }

 private:
  std::vector<drev::Channel> channels_;
  const std::vector<double>& times_;
  std::size_t next_ = 0;

 public:
  std::vector<std::vector<double>> values;
};

double size(const ReferenceResult& r, std::size_t channel) {
  return static_cast<double>(r.peaks[channel].amplitude());
}

/// A tolerance is relative to the largest deflection, or rate, of all: to the largest channel of the same unit.
std::array<double, kUnits> largest_of_units(const ReferenceModel& model, const ReferenceResult& r) {
  std::array<double, kUnits> largest{};
  for (std::size_t c = 0; c < r.peaks.size(); ++c) {
    double& most = largest[unit(model.channels()[c].kind)];
    most = std::max(most, size(r, c));
  }
  return largest;
}

/// By how much two runs differ, relative to the largest channel of each unit.
std::array<double, kUnits> differences(const ReferenceModel& model, const ReferenceResult& a,
                                       const ReferenceResult& b) {
  std::array<double, kUnits> most{};
  const std::array<double, kUnits> largest = largest_of_units(model, a);
  for (std::size_t c = 0; c < model.channels().size(); ++c) {
    const std::size_t u = unit(model.channels()[c].kind);
    for (std::size_t i = 0; i < std::min(a.samples[c].size(), b.samples[c].size()); ++i)
      most[u] = std::max(most[u], static_cast<double>(std::abs(a.samples[c][i] - b.samples[c][i])) /
                                      std::max(largest[u], 1e-300));
  }
  return most;
}

/// What a tolerance of 1 states of each channel.
std::vector<double> scales(const Case& c, const ReferenceModel& model) {
  const std::array<double, kUnits> largest = largest_of_units(model, c.fine);
  std::vector<double> all;
  for (std::size_t i = 0; i < model.channels().size(); ++i)
    all.push_back(c.growths[i] * largest[unit(model.channels()[i].kind)]);
  return all;
}

/// At the time that drev gives for a peak the true value is the peak, on one side of it where it jumps.
void compare_peak_times(const Case& c, const ReferenceModel& model, const drev::Peaks& peaks, double share,
                        const std::vector<double>& scale, Table& table) {
  std::vector<double> times;
  for (const drev::Peak& p : peaks.peaks())
    for (const double side : {1.0 - kBeside, 1.0 + kBeside})
      times.push_back(std::min(p.time() * side, c.spec.duration));
  std::sort(times.begin(), times.end());
  const ReferenceResult there = reference_result(c.spec, kCheck, times);
  if (there.failed) return;
  for (std::size_t i = 0; i < peaks.peaks().size(); ++i) {
    const double time = peaks.peaks()[i].time();
    Real most = 0;
    for (const double side : {1.0 - kBeside, 1.0 + kBeside}) {
      const auto at = std::lower_bound(times.begin(), times.end(), std::min(time * side, c.spec.duration));
      most = std::max(most, std::abs(there.samples[i][static_cast<std::size_t>(at - times.begin())]));
    }
    table.add("peak's time [" + std::string(to_text(model.channels()[i].kind)) + "], exact at 1e-11",
              {.where = c.spec.name + " (" + c.spec.family + ") " + model.channels()[i].name + " at " +
                        std::to_string(time),
               .value = static_cast<double>(most),
               .stated = share * scale[i],
               .truth = size(c.fine, i),
               .truth_error = c.truth_error(i)});
  }
}

}  // namespace

double Case::truth_error(std::size_t channel) const {
  const double a = static_cast<double>(fine.peaks[channel].amplitude());
  return 2.0 * static_cast<double>(
                   std::abs(fine.peaks[channel].amplitude() - check.peaks[channel].amplitude())) +
         1e-17 * a;
}

Case make_case(const Spec& spec) {
  Case c;
  c.spec = spec;
  std::mt19937 engine(static_cast<unsigned>(std::hash<std::string>{}(spec.name)));
  for (int i = 0; i < kTimes; ++i)
    c.times.push_back(spec.duration * static_cast<double>(engine() >> 1) * 0x1p-31);
  std::sort(c.times.begin(), c.times.end());
  c.fine = reference_result(spec, kFine, c.times);
  c.check = reference_result(spec, kCheck, c.times);
  c.usable = !c.fine.failed && !c.check.failed;
  c.problem = c.fine.reason + c.check.reason;
  if (!c.usable) return c;
  const ReferenceModel model(spec);
  const ReferenceResult moved = reference_result_beside(c.fine, kMoved, spec, kCheck, c.times);
  std::array<double, kUnits> grown{};
  if (!moved.failed) grown = differences(model, c.fine, moved);
  c.growth = std::max(
      {1.0, grown[unit(ChannelId::Kind::angle)] / kMoved, grown[unit(ChannelId::Kind::speed)] / kMoved});
  for (const ChannelId& id : model.channels())
    c.growths.push_back(std::max(c.growth, grown[unit(id.kind)] / kMoved));
  return c;
}

void cover_runs(const Case& c, Table& table) {
  const ReferenceModel model(c.spec);
  const drev::System system = to_drev(c.spec);
  const std::vector<double> scale = scales(c, model);
  std::vector<std::string> names;
  for (const ChannelId& id : model.channels()) names.push_back(id.name);
  for (const double tolerance : {1e-8, 1e-11}) {
    Watch watch(drev::find_channels(system, names), c.times);
    drev::Peaks peaks(drev::find_channels(system, names), true);
    drev::RunSummary run;
    try {
      run = drev::propagate(system, {.tolerance = tolerance, .t_end = c.spec.duration}, {&watch, &peaks});
    } catch (const drev::SolverError& e) {
      run.status = drev::RunStatus::no_convergence;
      run.reason = e.what();
    }
    const std::string at = tolerance == 1e-8 ? ", exact at 1e-8" : ", exact at 1e-11";
    const std::string model_name = c.spec.name + " (" + c.spec.family + ")";
    table.add_claim("run is a success" + at, model_name + " " + run.reason, run.ok());
    if (!run.ok() || c.chaotic()) continue;  // where it is chaotic, a tolerance says nothing of a value
    const double share = std::max(tolerance, 1e-14);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string kind = to_text(model.channels()[i].kind);
      std::size_t worst = 0;
      double most = -1.0;
      for (std::size_t t = 0; t < c.times.size(); ++t) {
        const double off = std::abs(watch.values[i][t] - static_cast<double>(c.fine.samples[i][t]));
        if (off > most) most = off, worst = t;
      }
      const Real truth = c.fine.samples[i][worst];
      table.add("history [" + kind + "]" + at,
                {.where = model_name + " " + names[i] + " at " + std::to_string(c.times[worst]),
                 .value = watch.values[i][worst],
                 .stated = share * scale[i],
                 .truth = static_cast<double>(truth),
                 .truth_error = 2.0 * static_cast<double>(std::abs(truth - c.check.samples[i][worst]))});
      table.add("peak [" + kind + "]" + at, {.where = model_name + " " + names[i],
                                             .value = peaks.peaks()[i].amplitude(),
                                             .stated = share * scale[i],
                                             .truth = size(c.fine, i),
                                             .truth_error = c.truth_error(i)});
    }
    if (tolerance == 1e-11) compare_peak_times(c, model, peaks, share, scale, table);
  }
}

}  // namespace coverage
