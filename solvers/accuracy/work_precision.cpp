#include "solvers/accuracy/work_precision.hpp"

#include <drev/core/error.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <algorithm>
#include <cmath>

#include "solvers/accuracy/processor_time.hpp"

namespace drev {

namespace {

constexpr std::string_view kControlled = "@tolerance";
constexpr double kReferenceTolerance = 1e-13;
constexpr double kReferenceTime = 4.0;  // time of the reference over the most that a drawn run may take
constexpr double kGivenUp = 10.0;       // the same ratio, beyond which a run is stopped
constexpr double kLeastGivenUp = 1.0;   // s: what the same run takes varies by more than the shortest limits
constexpr int kMostDigits = 12;         // decimal digits of the tolerance of controlled steps
constexpr int kMostHalvings = 24;       // halvings of the sample interval
constexpr double kShortRun = 0.05;      // s: shorter ones are timed several times
constexpr int kRepetitions = 5;
constexpr double kHopeless = 10.0;  // relative error: nothing of the motion is left

struct Samples {
  RunSummary summary;
  std::vector<std::vector<double>> rows;  ///< a channel each
  double seconds = 0.0;                   ///< processor time, the recorder's included
};

double largest(const std::vector<std::vector<double>>& rows) {
  double value = 0.0;
  for (const auto& row : rows)
    for (const double x : row) value = std::max(value, std::abs(x));
  return value;
}

double difference(const Samples& a, const Samples& b) {
  double value = 0.0;
  for (std::size_t c = 0; c < a.rows.size(); ++c)
    for (std::size_t i = 0; i < std::min(a.rows[c].size(), b.rows[c].size()); ++i)
      value = std::max(value, std::abs(a.rows[c][i] - b.rows[c][i]));
  return value;
}

/// NAME of NAME@tolerance; empty: not that.
std::string controlled(const std::string& name) {
  return name.ends_with(kControlled) ? name.substr(0, name.size() - kControlled.size()) : std::string();
}

class Measurement {
 public:
  Measurement(const System& system, const WorkPrecisionOptions& options)
      : system_(system), options_(options), channels_(options.channels) {
    if (channels_.empty())
      for (int i = 0; i < system.node_count(); ++i)
        channels_.push_back(system.node_names()[idx(i)] +
                            (system.node_kind(i) == NodeKind::rotational ? ".angle_rad" : ".position_m"));
    result_.t_end = options.samples * options.sample_interval;
    result_.unit = find_channels(system, channels_).front().unit();
  }

  WorkPrecision run() {
    find_reference();
    for (std::size_t i = 0; i < options_.methods.size() && !result_.interrupted; ++i) {
      part_ = static_cast<double>(i + 1) / static_cast<double>(options_.methods.size() + 1);
      result_.curves.push_back(curve(options_.methods[i]));
    }
    return std::move(result_);
  }

 private:
  double given_up_after() const { return std::max(kGivenUp * options_.most_seconds, kLeastGivenUp); }

  MethodRunOptions run_options() {
    // The energy is not judged: a coarse run is a point of the chart like any other.
    const double end = processor_time() + given_up_after();
    return {.t_end = result_.t_end, .energy_tolerance = 1e300, .progress = [this, end](double) {
              if (options_.progress && !options_.progress(part_)) result_.interrupted = true;
              return !result_.interrupted && processor_time() < end;
            }};
  }

  Samples sample(const Method& method) {
    Recorder recorder(system_, channels_, options_.sample_interval);
    Samples s;
    const double start = processor_time();
    try {
      s.summary = run_method(system_, method, run_options(), {&recorder});
    } catch (const std::runtime_error& error) {  // no solution, or a step that the method refuses
      s.summary.status = RunStatus::no_convergence;
      s.summary.reason = error.what();
    }
    s.seconds = processor_time() - start;
    if (s.summary.status == RunStatus::interrupted && !result_.interrupted)
      s.summary.reason = "given up after " + to_text(given_up_after()) + " s: more than the limit allows";
    for (std::size_t c = 0; c < channels_.size(); ++c) s.rows.push_back(recorder.samples(c));
    return s;
  }

  double halved(int times) const { return std::ldexp(options_.sample_interval, -times); }

  /// The tightest controlled steps that there is time for, or where there are none the finest constant
  /// steps of another method; which of them goes to text.
  Samples tightest(const std::string& name, const std::string& otherwise, std::string& text) {
    Samples best;
    bool found = false;
    const auto try_out = [&](const Method& method) {
      Samples s = sample(method);
      const bool last = 2.0 * s.seconds > kReferenceTime * options_.most_seconds;
      if (s.summary.ok()) {
        text = to_text(method);
        best = std::move(s);
        found = true;
      }
      return !last && !result_.interrupted;
    };
    for (int digits = 4; digits <= kMostDigits; ++digits)
      if (!try_out({.name = name, .tolerance = std::pow(10.0, -digits)})) break;
    if (!found)
      for (int k = 0; k <= kMostHalvings; ++k)
        if (!try_out({.name = otherwise, .step = halved(k)})) break;
    if (!found && !result_.interrupted)
      throw SolverError(system_.name() + ": no reference: neither " + name + " nor " + otherwise +
                        " came to an end");
    return best;
  }

  void find_reference() {
    Samples check;  // where a run was interrupted, there is nothing to compare
    if (!why_not_exact(system_)) {
      const Method exact{.name = kExact, .tolerance = kReferenceTolerance};
      reference_ = sample(exact);
      result_.reference = to_text(exact);
      if (result_.interrupted) return;
      if (!reference_.summary.ok())
        throw SolverError(system_.name() + ": no reference: " + reference_.summary.reason);
      check = tightest("dormand_prince", "average_acceleration", result_.check);
    } else {
      reference_ = tightest("dormand_prince", "average_acceleration", result_.reference);
      if (result_.interrupted) return;
      check = tightest("sdirk4", "generalized_alpha:0.8", result_.check);
    }
    if (result_.interrupted) return;
    result_.peak = largest(reference_.rows);
    if (!(result_.peak > 0.0))
      throw SolverError(system_.name() +
                        ": nothing moves in the channels, so that no error is relative to them");
    result_.agreement = difference(reference_, check) / result_.peak;
  }

  std::vector<Method> parameters(const std::string& name) const {
    std::vector<Method> all;
    if (name == kExact)
      for (int digits = 2; digits <= 12; ++digits)
        all.push_back({.name = name, .tolerance = std::pow(10.0, -digits)});
    else if (const std::string scheme = controlled(name); !scheme.empty())
      for (int digits = 1; digits <= kMostDigits; ++digits)
        all.push_back({.name = scheme, .tolerance = std::pow(10.0, -digits)});
    else
      for (int k = 0; k <= kMostHalvings; ++k) all.push_back({.name = name, .step = halved(k)});
    return all;
  }

  WorkCurve curve(const std::string& name) {
    WorkCurve curve{.name = name, .points = {}};
    int below = 0;
    for (const Method& method : parameters(name)) {
      WorkPoint p = point(method);
      if (result_.interrupted) break;
      below = p.ok && p.error < result_.agreement ? below + 1 : 0;
      const double next = (method.step > 0.0 ? 2.0 : 1.5) * p.seconds;
      curve.points.push_back(std::move(p));
      if (next > options_.most_seconds || below == 2) break;
    }
    return curve;
  }

  WorkPoint point(const Method& method) {
    const Samples s = sample(method);
    if (result_.interrupted) return {};
    WorkPoint p{.method = method, .ok = s.summary.ok(), .reason = s.summary.reason};
    p.seconds = s.seconds;
    if (!p.ok) return p;
    p.error = difference(reference_, s) / result_.peak;
    if (!(p.error < kHopeless)) {
      p.ok = false;
      p.reason = "the error is " + to_text(p.error) + " times the peak";
      return p;
    }
    p.work = static_cast<double>(s.summary.solves);
    double together = 0.0;
    for (int i = 0; i < kRepetitions && (i == 0 || together < kShortRun); ++i) {
      const double start = processor_time();
      run_method(system_, method, run_options());
      const double seconds = processor_time() - start;
      p.seconds = i == 0 ? seconds : std::min(p.seconds, seconds);
      together += seconds;
    }
    return p;
  }

  const System& system_;
  const WorkPrecisionOptions& options_;
  std::vector<std::string> channels_;
  WorkPrecision result_;
  Samples reference_;
  double part_ = 0.0;
};

void check(const System& system, const WorkPrecisionOptions& o) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/work_precision", findings);
  check.positive("sample_interval", o.sample_interval, "s");
  if (o.samples < 2) check.fail("samples", std::to_string(o.samples), "", "must be at least 2");
  check.positive("most_seconds", o.most_seconds, "s");
  if (o.methods.empty()) check.fail("methods", "none", "", "must be at least one");
  for (const std::string& name : o.methods) {
    if (name == kExact) {
      if (const auto why = why_not_exact(system)) check.fail("methods", name, "", *why);
      continue;
    }
    try {
      step_scheme(controlled(name).empty() ? name : controlled(name));
    } catch (const ModelError& error) {
      findings.insert(findings.end(), error.findings().begin(), error.findings().end());
    }
  }
  try {
    find_channels(system, o.channels);
  } catch (const ModelError& error) {
    findings.insert(findings.end(), error.findings().begin(), error.findings().end());
  }
  if (!findings.empty()) throw ModelError(findings);
}

}  // namespace

const WorkPoint* WorkPrecision::cheapest(const WorkCurve& curve, double error) const {
  const WorkPoint* best = nullptr;
  if (agreement > error) return best;
  // From the fine end on, as long as the error is kept.
  for (auto p = curve.points.rbegin(); p != curve.points.rend() && p->ok && p->error <= error; ++p)
    if (best == nullptr || p->seconds < best->seconds) best = &*p;
  return best;
}

std::optional<WorkPrecision::Best> WorkPrecision::cheapest(double error) const {
  Best best;
  for (const WorkCurve& curve : curves)
    if (const WorkPoint* p = cheapest(curve, error))
      if (best.point == nullptr || p->seconds < best.point->seconds) best = {&curve, p};
  if (best.point == nullptr) return {};
  return best;
}

WorkPrecision work_precision(const System& system, const WorkPrecisionOptions& options) {
  check(system, options);
  return Measurement(system, options).run();
}

}  // namespace drev
