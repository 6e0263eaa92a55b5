#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/accuracy/accuracy.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/periodic/spectrum.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>

#include "solvers/accuracy/accuracy_observers.hpp"
#include "solvers/accuracy/processor_time.hpp"
#include "solvers/accuracy/run_statistics.hpp"

namespace drev {

namespace {

constexpr double kSafety = 3.0;           // on the difference of two runs: accelerations were 2.6 of them off
constexpr double kFolded = 3.0;           // error over what more folds back with half the samples
constexpr double kLeastOrder = 0.25;      // a difference over the one before: second order
constexpr double kRounding = 1e-14;       // relative, before growth
constexpr double kFirstTolerance = 1e-2;  // first tolerance of exact propagation over the accuracy
constexpr double kTightening = 1e-3;      // factor of its tolerance from run to run
constexpr double kLeastTolerance = 1e-14, kLargestTolerance = 1e-4;
constexpr double kTighteningSteps = 0.1;  // factor of the tolerance of controlled steps from run to run
constexpr double kLeastOfSteps = 1e-12;   // least tolerance of controlled steps
constexpr double kChaos = 1e6;            // growth past which tightening moves the horizon only
constexpr int kOrders = 5;
constexpr double kLeastOfCycle = 1024.0;  // samples: kinks fold back into the orders
constexpr long kMostSamples = 1L << 18, kLeastSamples = 1L << 9;

std::vector<double> every_other(const std::vector<double>& record) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < record.size(); i += 2) kept.push_back(record[i]);
  return kept;
}

class AccurateRun {
 public:
  AccurateRun(const System& system, const AccuracyOptions& options)
      : system_(system), o_(options), followed_(options.deflection) {
    if (followed_.empty())
      followed_ = o_.torques.empty() ? all_channels(system).front().name() : o_.torques.front();
    choose_sampling();
  }

  AccuracyResult run() {
    Method method = o_.method;
    if (method.exact())
      method.tolerance = std::clamp(kFirstTolerance * o_.accuracy, 100 * kLeastTolerance, kLargestTolerance);
    else if (method.controlled())
      method.tolerance = std::clamp(o_.accuracy, 10 * kLeastOfSteps, 1e-2);
    else
      method.step = every_ / std::ceil(every_ / method.step);  // halves as it is asked to
    Method for_growth = method;
    if (method.exact()) for_growth.tolerance = 1e-13;
    result_.growth =
        measure_error_growth(system_, {.method = for_growth, .t_end = o_.t_end, .progress = [this](double p) {
                                         return going_on(0.2 * p);
                                       }});
    if (result_.growth.status != RunStatus::success) {
      result_.summary.status = result_.growth.status;
      result_.summary.reason = result_.growth.reason;
      return std::move(result_);
    }
    std::unique_ptr<Watched> coarse = watch(method, 0.2, 0.4), fine;
    result_.coarse = method;
    for (int level = 1; coarse->summary.ok(); ++level) {
      result_.fine = tighter(result_.coarse);
      fine = watch(result_.fine, 0.4, 0.7);
      result_.summary = fine->summary;
      if (!fine->summary.ok()) break;
      compare(*coarse, *fine);
      // Two differences of constant steps: one may be small by chance.
      if ((result_.reached && (method.exact() || level > 1)) || ends(level, fine->seconds)) break;
      result_.coarse = result_.fine;
      coarse = std::move(fine);
    }
    if (!coarse->summary.ok()) result_.summary = coarse->summary;
    if (result_.summary.ok() && result_.horizon < o_.t_end)
      add_statistics(system_, o_, *fine, every_, orders_, result_);
    if (result_.summary.ok()) say_why_not();
    return std::move(result_);
  }

 private:
  double span() const { return o_.t_end - o_.from; }  // s
  bool going_on(double part) { return !o_.progress || o_.progress(part); }

  /// Samples four times as often as the fastest mode swings, if that is not too many; whole numbers a cycle.
  void choose_sampling() {
    const double rate = fastest_rate(system_);
    const double length = span();
    double wanted = std::max(4.0 * to_hz(rate) * length, static_cast<double>(kLeastSamples));
    if (o_.cycle > 0.0) wanted = std::max(wanted, kLeastOfCycle * length / o_.cycle);
    double count = std::min(wanted, static_cast<double>(kMostSamples));
    if (!o_.method.exact() && !o_.method.controlled())
      count = std::min(count, std::max(1.0, length / (4.0 * o_.method.step)));
    every_ = length / std::ceil(count);
    if (o_.cycle > 0.0 && o_.cycle <= length)
      every_ = o_.cycle / (4.0 * std::ceil(o_.cycle / (4.0 * every_)));
  }

  std::unique_ptr<Watched> watch(const Method& method, double begin, double end) {
    auto w = std::make_unique<Watched>(system_, o_, followed_, every_);
    const double start = processor_time();
    w->summary = run_method(
        system_, method,
        {.t_end = o_.t_end, .progress = [&](double part) { return going_on(begin + (end - begin) * part); }},
        w->observers());
    w->seconds = processor_time() - start;
    // An energy balance that is off is an error of the figures like any other.
    if (w->summary.status == RunStatus::energy_error) w->summary.status = RunStatus::success;
    return w;
  }

  Method tighter(Method m) const {
    if (m.exact())
      m.tolerance = std::max(kLeastTolerance, kTightening * m.tolerance);
    else if (m.controlled())
      m.tolerance = std::max(kLeastOfSteps, kTighteningSteps * m.tolerance);
    else
      m.step *= 0.5;
    return m;
  }

  bool ends(int level, double seconds) const {
    if (result_.fine.exact()) return result_.fine.tolerance <= kLeastTolerance;
    if (result_.fine.controlled() && result_.fine.tolerance <= kLeastOfSteps) return true;
    if (2.0 * seconds > o_.most_seconds || o_.start_error > o_.accuracy) return true;
    return level >= 2 && result_.growth.factor(o_.t_end) > kChaos;
  }

  /// A figure at time t, from both runs.
  void add(const std::string& name, const std::string& unit, double coarse, double fine, double scale,
           double t) {
    const double error = error_between(name, coarse, fine, scale, t);
    result_.figures.push_back({{fine, error}, name, unit, std::abs(scale)});
  }

  /// The error of a figure from both runs, and with steps from the two before.
  double error_between(const std::string& name, double coarse, double fine, double scale, double t) {
    double error = error_of(coarse, fine, scale, t);
    if (!result_.fine.exact()) {
      double& before = differences_[name];
      error = std::max(error, kSafety * kLeastOrder * before);
      before = std::abs(coarse - fine);
    }
    return error;
  }

  double error_of(double coarse, double fine, double scale, double t) const {
    const double off = std::max(kRounding, result_.fine.tolerance) + o_.start_error;
    return kSafety * std::abs(coarse - fine) + off * result_.growth.factor(t) * std::abs(scale);
  }

  void compare(const Watched& a, const Watched& b) {
    result_.figures.clear();
    find_horizon(a, b);
    if (!b.deflection.empty())
      add("peak deflection", b.deflection.channel().unit(), a.deflection.value(), b.deflection.value(),
          b.deflection.value(), b.deflection.time());
    if (!b.torque.empty()) add_peak_torque(a, b);
    if (!b.mesh.empty())
      add("peak mesh force", b.mesh.channel().unit(), a.mesh.value(), b.mesh.value(), b.mesh.value(),
          b.mesh.time());
    compare_contacts(a.contacts.records(), b.contacts.records());
    compare_edges(a.edges.all(), b.edges.all());
    if (!o_.deflection.empty()) compare_orders(a, b);
    result_.reached = result_.horizon > o_.t_end &&
                      std::all_of(result_.figures.begin(), result_.figures.end(),
                                  [&](const Figure& f) { return f.keeps(o_.accuracy); }) &&
                      std::all_of(result_.contacts.begin(), result_.contacts.end(),
                                  [&](const ContactFigures& c) { return keeps(c); });
  }

  /// Rounding, which shakes stiff elements in each run again, is a part of its error that no finer run takes away.
  void add_peak_torque(const Watched& a, const Watched& b) {
    const Channel& channel = b.torque.channel();
    add("peak torque", channel.unit(), a.torque.value(), b.torque.value(), b.torque.value(), b.torque.time());
    for (const auto& [name, error] : b.summary.rounding)
      if (name == channel.name()) result_.figures.back().error += error;
  }

  /// Relative to the largest force, the span, and the number.
  bool keeps(const ContactFigures& c) const {
    return c.largest_force.error <= o_.accuracy * c.largest_force.value &&
           c.time_separated.error <= o_.accuracy * span() &&
           c.front_impacts.error <= o_.accuracy * c.front_impacts.value &&
           c.back_impacts.error <= o_.accuracy * c.back_impacts.value;
  }

  /// Two runs that round alike may agree past the horizon: what depends on the motion there is not known.
  void compare_contacts(const std::vector<ContactRecord>& a, const std::vector<ContactRecord>& b) {
    const bool known = result_.horizon > o_.t_end;
    result_.contacts.clear();
    for (std::size_t i = 0; i < b.size(); ++i) {
      const std::string& name = b[i].element;
      const auto of = [&](const char* what, double coarse, double fine, double scale, double t) -> Estimate {
        const double error = error_between(name + what, coarse, fine, scale, t);
        return {fine, known || t < result_.horizon ? error : std::numeric_limits<double>::infinity()};
      };
      const auto number = [&](const char* what, long coarse, long fine) {
        return of(what, static_cast<double>(coarse), static_cast<double>(fine), 0.0, o_.t_end);
      };
      const double force = b[i].largest_force;
      result_.contacts.push_back(
          {.element = name,
           // A larger force may come behind the horizon.
           .largest_force =
               of(": force", a[i].largest_force, force, force, known ? b[i].largest_force_time : o_.t_end),
           .time_separated = of(": separated", a[i].time_separated, b[i].time_separated, span(), o_.t_end),
           .front_impacts = number(": front", a[i].front_impacts, b[i].front_impacts),
           .back_impacts = number(": back", a[i].back_impacts, b[i].back_impacts)});
    }
  }

  void find_horizon(const Watched& a, const Watched& b) {
    const auto &x = a.recorder.samples(0), &y = b.recorder.samples(0);
    double peak = 0.0;
    for (const double value : y) peak = std::max(peak, std::abs(value));
    // Two runs that round alike may agree for longer than any other two would.
    result_.horizon = result_.growth.time_of(o_.accuracy / kRounding);
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
      if (std::abs(x[i] - y[i]) > o_.accuracy * peak) {
        result_.horizon = std::min(result_.horizon, b.recorder.times()[i]);
        return;
      }
  }

  void compare_edges(const std::vector<ContactEvent>& a, const std::vector<ContactEvent>& b) {
    if (b.empty() && a.empty()) return;
    std::size_t same = 0;
    while (same < std::min(a.size(), b.size()) && a[same].law == b[same].law &&
           a[same].front == b[same].front && a[same].made == b[same].made &&
           error_of(a[same].t, b[same].t, b[same].t, b[same].t) <= o_.accuracy * b[same].t)
      ++same;
    const double count = static_cast<double>(same);
    result_.figures.push_back({{count, 0.0}, "contact changes, comparable", "", std::max(1.0, count)});
    if (same > 0) {
      add("first contact change", "s", a[0].t, b[0].t, b[0].t, b[0].t);
      add("last comparable contact change", "s", a[same - 1].t, b[same - 1].t, b[same - 1].t, b[same - 1].t);
    }
    if (result_.horizon <= o_.t_end) return;
    const auto all = static_cast<double>(b.size()), coarse = static_cast<double>(a.size());
    result_.figures.push_back(
        {{all, kSafety * std::abs(all - coarse)}, "contact changes", "", std::max(1.0, all)});
  }

  void compare_orders(const Watched& a, const Watched& b) {
    const auto &x = a.recorder.samples(0), &y = b.recorder.samples(0);
    if (x.size() != y.size() || y.size() < 16) return;
    const bool ordered = o_.cycle > 0.0;
    if (ordered && o_.cycle > span()) return;
    const CycleRecord r = ordered ? last_cycles(y, every_, o_.cycle, 0.5)
                                  : CycleRecord{.begin = y.size() / 2, .end = y.size() - 1, .cycles = 1};
    if (r.cycles == 0) return;
    const auto of = [&](const std::vector<double>& all) {
      const std::vector<double> record = samples_between(all, r.begin, r.end);
      return ordered ? cycle_spectrum(record, every_) : line_spectrum(record);
    };
    const Spectrum coarse = of(x), fine = of(y);
    // Lines above the sampling fold back: with every other sample, at least twice as much.
    const std::vector<double> half = every_other(samples_between(y, r.begin, r.end));
    const Spectrum folded = ordered ? cycle_spectrum(half, 2.0 * every_) : fine;
    // One difference may be small by chance.
    const Spectrum twice = ordered ? cycle_spectrum(every_other(half), 4.0 * every_) : fine;
    std::vector<std::size_t> lines;
    for (std::size_t k = r.cycles; k + 1 < fine.amplitude.size(); k += r.cycles)
      if (ordered ||
          (fine.amplitude[k] > fine.amplitude[k - 1] && fine.amplitude[k] >= fine.amplitude[k + 1]))
        lines.push_back(k);
    std::sort(lines.begin(), lines.end(),
              [&](std::size_t i, std::size_t j) { return fine.amplitude[i] > fine.amplitude[j]; });
    if (lines.size() > kOrders) lines.resize(kOrders);
    orders_.clear();
    for (const std::size_t k : lines) {
      std::ostringstream name;
      name.precision(5);
      if (ordered)
        name << "amplitude of order " << k / r.cycles << " (" << fine.frequency_Hz[k] << " Hz)";
      else
        name << "amplitude at " << fine.frequency_Hz[k] << " Hz";
      orders_[name.str()] = k / r.cycles;
      add(name.str(), unit_of_deflection(), coarse.amplitude[k], fine.amplitude[k], b.deflection.value(),
          o_.t_end);
      Figure& line = result_.figures.back();
      if (ordered) {
        const auto at = [k](const Spectrum& s) { return k < s.amplitude.size() ? s.amplitude[k] : 0.0; };
        line.error += kFolded * std::max(std::abs(line.value - at(folded)),
                                         kLeastOrder * std::abs(at(folded) - at(twice)));
        continue;
      }
      line.error += spread_over_halves(y, r, fine.frequency_Hz[k], fine.amplitude[k]);
      // What is no steady line has no one amplitude: it is another in each half of the record.
      if (!line.keeps(o_.accuracy)) result_.figures.pop_back();
    }
  }

  /// By how much the amplitude at a frequency differs in either half of the record.
  double spread_over_halves(const std::vector<double>& all, const CycleRecord& r, double frequency,
                            double amplitude) const {
    double most = 0.0;
    const std::size_t middle = (r.begin + r.end) / 2;
    for (const auto& [begin, end] : {std::pair{r.begin, middle}, {middle, r.end}}) {
      const Spectrum half = line_spectrum(samples_between(all, begin, end));
      std::size_t nearest = 0;
      for (std::size_t i = 1; i < half.frequency_Hz.size(); ++i)
        if (std::abs(half.frequency_Hz[i] - frequency) < std::abs(half.frequency_Hz[nearest] - frequency))
          nearest = i;
      most = std::max(most, std::abs(half.amplitude[nearest] - amplitude));
    }
    return most;
  }

  Spectrum line_spectrum(const std::vector<double>& record) const {
    return spectrum(record, every_, {.window = Window::flat_top, .remove_mean = true});
  }

  std::string unit_of_deflection() const { return find_channel(system_, o_.deflection).unit(); }

  void say_why_not() {
    if (result_.reached) return;
    std::ostringstream text;
    text.precision(3);
    if (result_.horizon < o_.t_end) {
      text << "from t = " << result_.horizon << " s on two runs differ by more than " << o_.accuracy
           << " (a small difference of the state has grown by " << result_.growth.factor(result_.horizon)
           << " there, by " << result_.growth.factor(o_.t_end)
           << " at the end): what depends on it is given as a statistic with its 95 % confidence "
              "interval";
    } else {
      text << "not every figure keeps " << o_.accuracy << " yet, and a finer run would ";
      if (o_.start_error > o_.accuracy)
        text << "not know its start better: the state it starts from has an error of " << o_.start_error;
      else if (result_.fine.exact() || result_.fine.tolerance == kLeastOfSteps)
        text << "only add rounding";
      else
        text << "take more than " << o_.most_seconds << " s";
    }
    result_.reason = text.str();
  }

  const System& system_;
  const AccuracyOptions& o_;
  std::string followed_;
  double every_ = 0.0;
  AccuracyResult result_;
  std::map<std::string, double> differences_;  // between the last two runs with constant steps, by figure
  OrderLines orders_;
};

}  // namespace

const Figure* AccuracyResult::find(const std::string& name) const {
  auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.name == name; });
  if (found == figures.end())
    found = std::find_if(figures.begin(), figures.end(),
                         [&](const Figure& f) { return f.name.starts_with(name); });
  return found == figures.end() ? nullptr : &*found;
}

AccuracyResult run_to_accuracy(const System& system, const AccuracyOptions& o) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/accuracy", findings);
  check.within("accuracy", o.accuracy, o.kAccuracy.low, o.kAccuracy.high, "");
  check.positive("t_end", o.t_end, "s");
  if (!(o.from >= 0.0 && o.from < o.t_end))
    check.fail("from", to_text(o.from), "s", "must be from 0 to less than t_end");
  check.non_negative("cycle", o.cycle, "s");
  check.positive("most_seconds", o.most_seconds, "s");
  check.within("start_error", o.start_error, 0.0, 1.0, "");
  if (o.ensemble < 2) check.fail("ensemble", std::to_string(o.ensemble), "runs", "must be at least 2");
  if (!o.method.exact() && !o.method.controlled() && !(o.method.step > 0.0 && std::isfinite(o.method.step)))
    check.fail("method.step", to_text(o.method.step), "s",
               "must be > 0 for " + o.method.name +
                   " with constant steps; method.tolerance > 0 controls them, "
                   "and method.name = \"exact\" needs none");
  if (o.method.exact())
    if (const auto why = why_not_exact(system)) check.fail("method", kExact, "", *why);
  if (system.size() == 0) check.fail("unknowns", "0", "", "must be at least one");
  if (!findings.empty()) throw ModelError(findings);
  return AccurateRun(system, o).run();
}

}  // namespace drev
