#include <drev/solvers/accuracy/accuracy.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/random_spec.hpp"
#include "tests/stability/coverage/reference_averages.hpp"
#include "tests/stability/coverage/to_drev.hpp"

namespace coverage {

namespace {

constexpr int kLonger = 8, kParts = 40;          // of drev's run; batches of the reference
constexpr int kOfACycle = 40, kCycleOrders = 6;  // a period
constexpr ReferencePrecision kLoose{18, 1e-12L};

/// A statistic of the long run with the half-width of its own 95 % interval.
struct Truth {
  double value = 0.0, error = 0.0;
};

Truth of_parts(const std::vector<double>& parts) {
  double mean = 0.0, square = 0.0;
  for (const double p : parts) mean += p / static_cast<double>(parts.size());
  for (const double p : parts) square += (p - mean) * (p - mean);
  const auto n = static_cast<double>(parts.size());
  return {mean, 2.02 * std::sqrt(square / (n - 1.0) / n)};
}

struct LongRun {
  Truth mean, rms, force_mean, force_rms, share_apart, impacts, low, high;
  std::array<Truth, kCycleOrders + 1> orders;
};

double quantile(std::vector<double> x, double part) {
  const auto k = static_cast<std::ptrdiff_t>(part * static_cast<double>(x.size() - 1) + 0.5);
  std::nth_element(x.begin(), x.begin() + k, x.end());
  return x[static_cast<std::size_t>(k)];
}

/// The dead band's twist and torque over a run kLonger times as long, its first periods left out.
LongRun long_run(const Spec& spec) {
  ReferenceModel model(spec);
  const Real period = spec.period;
  const long periods = std::lround(spec.duration / spec.period), first = periods / 10;
  const long each = (kLonger * periods - first) / kParts;
  enum { mean, rms, force, force_rms, apart, impacts, low, high, count };
  std::array<std::vector<double>, count> parts;
  std::array<std::vector<double>, kCycleOrders + 1> orders;
  const ChannelId twist{.kind = ChannelId::Kind::polyline_deflection},
      torque{.kind = ChannelId::Kind::polyline_torque};
  run_reference(model, period * first, kLoose, {});
  for (int part = 0; part < kParts; ++part) {
    const Real from = period * (first + part * each), to = from + period * each;
    Averages averages({twist, torque}, from, to);
    Real open = 0;
    long met = 0, sample = 0;
    std::vector<double> values;
    std::array<double, kCycleOrders + 1> amplitudes{};
    const auto watch = [&](const ReferenceStep& step) {
      const bool in_gap = step.model.segment(0) == 1;
      if (in_gap) open += step.h;
      met += step.passes && step.passes->of == Guard::Of::polyline && in_gap;
      const Poly x = step.model.channel(twist);
      for (; from + period * sample / kOfACycle < step.t + step.h && sample < each * kOfACycle; ++sample)
        values.push_back(static_cast<double>(x.value(from + period * sample / kOfACycle - step.t)));
    };
    for (long cycle = 0; cycle < each; ++cycle) {
      const Real begin = from + period * cycle, end = cycle + 1 == each ? to : begin + period;
      Averages one({twist}, begin, end, kTurn / period, kCycleOrders);
      run_reference(model, end, kLoose, {std::ref(averages), std::ref(one), watch});
      for (int n = 1; n <= kCycleOrders; ++n)
        amplitudes[static_cast<std::size_t>(n)] +=
            static_cast<double>(std::abs(one.amplitude(0, n))) / static_cast<double>(each);
    }
    parts[mean].push_back(static_cast<double>(averages.mean(0)));
    parts[rms].push_back(static_cast<double>(std::sqrt(averages.mean_square(0))));
    parts[force].push_back(static_cast<double>(averages.mean(1)));
    parts[force_rms].push_back(static_cast<double>(std::sqrt(averages.mean_square(1))));
    parts[apart].push_back(static_cast<double>(open / (to - from)));
    parts[impacts].push_back(static_cast<double>(met) / static_cast<double>(to - from));
    parts[low].push_back(quantile(values, 0.01));
    parts[high].push_back(quantile(values, 0.99));
    for (std::size_t n = 0; n <= kCycleOrders; ++n) orders[n].push_back(amplitudes[n]);
  }
  LongRun r{of_parts(parts[mean]),      of_parts(parts[rms]),   of_parts(parts[force]),
            of_parts(parts[force_rms]), of_parts(parts[apart]), of_parts(parts[impacts]),
            of_parts(parts[low]),       of_parts(parts[high]),  {}};
  for (std::size_t n = 0; n <= kCycleOrders; ++n) r.orders[n] = of_parts(orders[n]);
  return r;
}

}  // namespace

void cover_statistics(unsigned seed, int runs, Table& table) {
  const Spec spec = random_chaotic_spec(seed);
  const LongRun truth = long_run(spec);
  const std::string channel = "polyline0.deflection_rad";
  for (int run = 0; run < runs; ++run) {
    Spec beside = spec;
    const double reach = spec.polylines[0].x[2];
    beside.nodes[1].angle = 0.3 * reach * std::sin(1.0 + 2.7 * run);
    beside.nodes[1].speed = 0.3 * reach * 6.28 / spec.period * std::cos(0.3 + 1.9 * run);
    const drev::AccuracyResult r = drev::run_to_accuracy(to_drev(beside), {.accuracy = 1e-4,
                                                                           .t_end = spec.duration,
                                                                           .deflection = channel,
                                                                           .torques = {"polyline0.torque_Nm"},
                                                                           .cycle = spec.period,
                                                                           .method = {.name = "exact"}});
    if (!r.summary.ok() || r.horizon > 0.25 * spec.duration) {
      table.add_note(spec.name + " is not chaotic enough: left out");
      return;
    }
    const std::string where = spec.name + " run " + std::to_string(run);
    const auto compare = [&](const char* name, const Truth& t) {
      for (const drev::Figure& f : r.figures)
        if (f.kind == drev::Estimate::Kind::interval && f.name == name)
          table.add_interval(std::string("interval: ") + name, {where, f.value, f.error, t.value, t.error});
    };
    compare("mean of polyline0.deflection_rad", truth.mean);
    compare("rms of polyline0.deflection_rad", truth.rms);
    compare("polyline0: mean force", truth.force_mean);
    compare("polyline0: rms force", truth.force_rms);
    compare("polyline0: share of time separated", truth.share_apart);
    compare("polyline0: impacts", truth.impacts);
    compare("1 % quantile of polyline0.deflection_rad", truth.low);
    compare("99 % quantile of polyline0.deflection_rad", truth.high);
    for (const drev::Figure& f : r.figures) {
      if (f.kind != drev::Estimate::Kind::interval || !f.name.starts_with("amplitude of order ")) continue;
      const int order = std::atoi(f.name.c_str() + 19);
      if (order < 1 || order > kCycleOrders) continue;
      const Truth& t = truth.orders[static_cast<std::size_t>(order)];
      table.add_interval("interval: order amplitude",
                         {where + " " + f.name, f.value, f.error, t.value, t.error});
    }
  }
}

}  // namespace coverage
