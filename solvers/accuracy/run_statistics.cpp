#include "solvers/accuracy/run_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/accuracy/accuracy_observers.hpp"

namespace drev {

namespace {

constexpr double kOfEnsemble = 1e-6;  // tolerance of exact propagation of runs that are averaged

double quantile(std::vector<double> x, double part) {
  const auto k = static_cast<std::ptrdiff_t>(part * static_cast<double>(x.size() - 1) + 0.5);
  std::nth_element(x.begin(), x.begin() + k, x.end());
  return x[static_cast<std::size_t>(k)];
}

class RunStatistics {
 public:
  RunStatistics(const System& system, const AccuracyOptions& options, const Watched& fine, double every,
                const OrderLines& orders, AccuracyResult& result)
      : system_(system), o_(options), fine_(fine), every_(every), orders_(orders), result_(result) {}

  void add() {
    std::vector<Figure> kept;
    bool peaks = false;
    for (const Figure& f : result_.figures) {
      if (f.keeps(o_.accuracy)) {
        kept.push_back(f);
        continue;
      }
      peaks |= f.name.starts_with("peak");
    }
    std::swap(kept, result_.figures);
    if (peaks) add_ensemble(kept);
    add_cycles(kept, fine_.recorder.samples(0));
    for (const BatchWatch::Contact& c : fine_.batches.contacts()) {
      add_statistic(c.element + ": share of time separated", "", batch_mean(c.share_separated, kBatches));
      add_statistic(c.element + ": impacts", "1/s", batch_mean(c.impacts_per_second, kBatches));
      if (std::all_of(c.impact_power.begin(), c.impact_power.end(),
                      [](double p) { return std::isfinite(p); }))
        add_statistic(c.element + ": rattle index", "W", batch_mean(c.impact_power, kBatches));
      add_statistic(c.element + ": mean force", c.unit, c.mean_force.estimate(kBatches));
      add_statistic(c.element + ": rms force", c.unit, c.rms_force.estimate(kBatches));
    }
    for (const BatchWatch::Average& a : fine_.batches.averages()) {
      add_statistic("mean of " + a.channel, a.unit, a.mean.estimate(kBatches));
      add_statistic("rms of " + a.channel, a.unit, a.rms.estimate(kBatches));
    }
    add_quantiles(fine_.recorder.samples(0), fine_.batches.averages().front());
  }

 private:
  bool going_on(double part) const { return !o_.progress || o_.progress(part); }

  void add_statistic(const std::string& name, const std::string& unit, const Estimate& mean) {
    result_.figures.push_back({mean, name, unit, std::abs(mean.value)});
  }

  /// Peaks over runs that start beside the first.
  void add_ensemble(const std::vector<Figure>& replaced_from) {
    std::vector<double> deflections, torques, meshes;
    Method method = result_.coarse;
    // They differ by much more than a tolerance.
    if (method.exact()) method.tolerance = std::max(method.tolerance, kOfEnsemble);
    for (int i = 1; i <= o_.ensemble && going_on(0.7 + 0.3 * i / o_.ensemble); ++i) {
      PeakWatch deflection(o_.deflection.empty() ? std::vector<Channel>{}
                                                 : find_channels(system_, {o_.deflection}));
      PeakWatch torque(find_channels(system_, o_.torques)), mesh(find_channels(system_, o_.meshes));
      AfterTime span(o_.from, {&deflection, &torque, &mesh});
      State state = neighbour(system_, i, result_.growth.z_scale, result_.growth.v_scale);
      const RunSummary run =
          run_method(system_, method, {.t_end = o_.t_end, .energy_tolerance = 1e300}, state, {&span});
      if (!run.ok()) continue;
      deflections.push_back(deflection.value());
      torques.push_back(torque.value());
      meshes.push_back(mesh.value());
    }
    const std::string of = ", mean of " + std::to_string(deflections.size()) + " runs";
    for (const Figure& f : replaced_from)
      if (!f.keeps(o_.accuracy) && f.name.starts_with("peak"))
        add_statistic(f.name + of, f.unit,
                      batch_mean(f.name == "peak torque"       ? torques
                                 : f.name == "peak mesh force" ? meshes
                                                               : deflections,
                                 o_.ensemble));
  }

  /// Order amplitudes of the single cycles.
  void add_cycles(const std::vector<Figure>& figures, const std::vector<double>& samples) {
    if (!(o_.cycle > 0.0)) return;
    for (const Figure& f : figures) {
      const auto order = orders_.find(f.name);
      if (f.keeps(o_.accuracy) || order == orders_.end()) continue;
      const CycleRecord r = last_cycles(samples, every_, o_.cycle, Watched::left_out(o_));
      const std::size_t length = (r.end - r.begin) / r.cycles;
      std::vector<double> amplitudes;
      for (std::size_t i = 0; i < r.cycles; ++i)
        amplitudes.push_back(
            cycle_spectrum(samples_between(samples, r.begin + i * length, r.begin + (i + 1) * length), every_)
                .amplitude[order->second]);
      add_statistic(f.name + ", mean of " + std::to_string(r.cycles) + " cycles", f.unit,
                    batch_mean(amplitudes, kBatches));
    }
  }

  void add_quantiles(const std::vector<double>& samples, const BatchWatch::Average& of) {
    const auto first = static_cast<std::size_t>(Watched::left_out(o_) * static_cast<double>(samples.size()));
    const std::size_t count = (samples.size() - first) / kBatches;
    if (count < 100) return;  // a quantile of 1 % means nothing
    for (const int percent : {1, 99}) {
      std::vector<double> each;
      for (std::size_t b = 0; b < kBatches; ++b)
        each.push_back(quantile(samples_between(samples, first + b * count, first + (b + 1) * count - 1),
                                percent / 100.0));
      add_statistic(std::to_string(percent) + " % quantile of " + of.channel, of.unit,
                    batch_mean(each, kBatches));
    }
  }

  const System& system_;
  const AccuracyOptions& o_;
  const Watched& fine_;
  double every_;
  const OrderLines& orders_;
  AccuracyResult& result_;
};

}  // namespace

CycleRecord last_cycles(const std::vector<double>& samples, double every, double cycle, double left_out) {
  const auto per_cycle = static_cast<std::size_t>(std::round(cycle / every));
  const std::size_t steps = samples.size() - 1;
  auto cycles = static_cast<std::size_t>((1.0 - left_out) * static_cast<double>(steps / per_cycle));
  if (cycles == 0) cycles = steps / per_cycle;
  return {steps - cycles * per_cycle, steps, cycles};
}

std::vector<double> samples_between(const std::vector<double>& all, std::size_t begin, std::size_t end) {
  return {all.begin() + static_cast<std::ptrdiff_t>(begin),
          all.begin() + static_cast<std::ptrdiff_t>(end + 1)};
}

Spectrum cycle_spectrum(std::vector<double> record, double every) {
  record.front() = 0.5 * (record.front() + record.back());
  return spectrum(record, every);
}

void add_statistics(const System& system, const AccuracyOptions& options, const Watched& fine, double every,
                    const OrderLines& orders, AccuracyResult& result) {
  RunStatistics(system, options, fine, every, orders, result).add();
}

}  // namespace drev
