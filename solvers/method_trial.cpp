#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/core/scalar_force.hpp>
#include <drev/core/system.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <sstream>

#include "solvers/method_costs.hpp"

namespace drev {

namespace {

constexpr int kCallEvery = 100;  // steps between calls of progress, of all methods
constexpr int kFirstSteps = 1000, kOtherSteps = 4000;
constexpr int kMostOfCalls = 5;        // times what a run is to have at least, or
constexpr double kMostOfRun = 0.002;   // of what the chosen method would cost, where that is more; up to
constexpr double kLongestTrial = 5e9;  // ns
constexpr std::size_t kMostOfSamples = 400;  // calls
constexpr double kSteady = 1.2;              // growth of the pace from one half to the next
constexpr double kStart = 1e-6;              // of the duration: steps from rest may be tiny until then
constexpr int kSamples = 32;
constexpr std::size_t kMostChannels = 64;
constexpr double kAgrees = 10.0 * kControlledTolerance;
constexpr double kAffordable = 2e9, kFirstTrial = 0.2e9, kOtherTrial = 0.5e9;  // ns
// Measured on gensets, camshafts and chains (ns); kOfUnknown: of a step, energies and peaks of all shafts included.
constexpr double kOfStep = 8000.0, kOfUnknown = 30.0, kOfProduct = 2.0, kOfLoad = 100.0,
                 kProductsOfSolve = 10.0, kLoadsOfStep = 48.0;

/// ns, of a product with the step's matrices.
double product_cost(const System& system) {
  return kOfProduct *
         (kUnknownsOfStep + system.size() + kUnknownsOfContact * static_cast<double>(contact_count(system)));
}

double cost(const System& system, const Method& method, const RunSummary& run) {
  const double product = product_cost(system);
  const auto loads = static_cast<double>(system.loads().size());
  const auto solves = static_cast<double>(run.solves);
  if (!method.exact()) return solves * (kProductsOfSolve * product + kOfLoad * loads);
  const auto smooth = static_cast<double>(
      std::count_if(system.scalars().begin(), system.scalars().end(), [](const ScalarTerm& s) {
        return s.phase_node >= 0 || s.force->pieces().empty() || !is_linear(s.force->pieces());
      }));
  return solves * product + static_cast<double>(run.steps) * (kOfStep + kOfUnknown * system.size() +
                                                              kLoadsOfStep * kOfLoad * (loads + smooth));
}

/// Forces and torques, or all channels where there are none.
std::vector<std::string> compared_channels(const System& system) {
  std::vector<std::string> forces, all;
  for (const Channel& c : all_channels(system)) {
    all.push_back(c.name());
    if (c.force_of() >= 0 || c.name().ends_with(".torque_Nm")) forces.push_back(c.name());
  }
  std::vector<std::string>& names = forces.empty() ? all : forces;
  if (names.size() > kMostChannels) names.resize(kMostChannels);
  return names;
}

class Trial {
 public:
  Trial(const System& system, const MethodChoice& chosen, double duration,
        const std::function<bool()>& progress)
      : system_(system), chosen_(chosen), duration_(duration), progress_(progress) {}

  MethodTrial run() {
    MethodTrial trial{.choice = chosen_};
    if (!(chosen_.method.tolerance > 0.0)) return trial;  // constant steps: no other is fit for the system
    const int calls = within(kFirstTrial, kProductsInStep, kFirstSteps);
    const auto first = paced(chosen_.method, calls, kMostOfCalls * calls);
    if (!first || first->status != RunStatus::interrupted || stopped_) return trial;
    span_ = first->t_end;
    if (!(span_ > 0.0) || !(passed(half_, 0) > 0.0)) return trial;
    trial.chosen_ns = cost_to_end(chosen_.method, *first);
    if (trial.chosen_ns < kAffordable) return trial;
    const std::vector<std::vector<double>> right = samples(chosen_.method);
    if (right.empty()) return trial;
    std::optional<Method> best;
    for (const char* name : {"dormand_prince", "sdirk4"}) {
      const Method other{.name = name, .tolerance = kControlledTolerance};
      if (other.name == chosen_.method.name || stopped_) continue;
      const double ns = cost_of_other(other, trial.chosen_ns, trial.chosen_ns / too_expensive(trial), right);
      if (ns > 0.0 && (!best || ns < trial.other_ns)) best = other, trial.other_ns = ns;
    }
    if (best && too_expensive(trial) * trial.other_ns < trial.chosen_ns) change(trial, *best);
    return trial;
  }

 private:
  static double too_expensive(const MethodTrial& trial) {
    return trial.chosen_ns > kLongRun ? kTooExpensiveLong : kTooExpensive;
  }

  /// As many calls of progress as cost about this much [ns], in two halves.
  int within(double ns, double products_of_step, double most_steps) const {
    const double steps = ns / (products_of_step * product_cost(system_));
    return 2 * static_cast<int>(
                   std::clamp(std::ceil(0.5 * steps / kCallEvery), 2.0, 0.5 * most_steps / kCallEvery));
  }

  /// A run of at most so many calls; none: it failed. goes_on: asked at each of them.
  std::optional<RunSummary> tried(const Method& method, double t_end, const std::vector<Observer*>& observers,
                                  const std::function<bool()>& goes_on) {
    times_.clear();
    const auto progress = [&](double part) {
      stopped_ = stopped_ || (progress_ && !progress_());
      times_.push_back(part * t_end);
      return !stopped_ && goes_on();
    };
    try {
      return run_method(system_, method, {.t_end = t_end, .energy_tolerance = 1e300, .progress = progress},
                        observers);
    } catch (const std::exception&) {  // of a user's function, too
      return std::nullopt;
    }
  }

  /// Time passed in so many calls, the last of which was `before` calls ago [s].
  double passed(std::size_t calls, std::size_t before) const {
    const std::size_t end = times_.size() - before;
    return times_[end - 1] - (end > calls ? times_[end - 1 - calls] : 0.0);
  }

  /// A run of so many calls, or of up to `most` while its steps still grow: behind the last half of them they do not.
  std::optional<RunSummary> paced(const Method& method, int calls, int most) {
    half_ = static_cast<std::size_t>(calls / 2);
    return tried(method, duration_, {}, [&] {
      if (times_.size() < 2 * half_) return true;
      const bool starting =
          times_.back() < kStart * duration_ || passed(half_, 0) > kSteady * passed(half_, half_);
      return starting && times_.size() < static_cast<std::size_t>(most);
    });
  }

  /// What the run paced last would cost to the end [ns], by the last half of its calls.
  double cost_to_end(const Method& method, const RunSummary& run) const {
    const double so_far = cost(system_, method, run);
    if (run.ok()) return so_far;
    const double of_half = so_far * static_cast<double>(half_) / static_cast<double>(times_.size());
    return so_far + of_half * (duration_ - run.t_end) / passed(half_, 0);
  }

  /// [channel][time] over the span; empty: the run did not get through it.
  std::vector<std::vector<double>> samples(const Method& method) {
    const std::vector<std::string> channels = compared_channels(system_);
    Recorder recorder(system_, channels, span_ / kSamples);
    const auto run = tried(method, span_, {&recorder}, [&] { return times_.size() < kMostOfSamples; });
    std::vector<std::vector<double>> all;
    if (!run || !run->ok()) return all;
    for (std::size_t c = 0; c < channels.size(); ++c) all.push_back(recorder.samples(c));
    return all;
  }

  /// Of the whole run [ns], which the chosen method does at chosen_ns; 0: it fails, is off, or cannot be below `most`.
  double cost_of_other(const Method& method, double chosen_ns, double most,
                       const std::vector<std::vector<double>>& right) {
    const int calls = within(kOtherTrial, kProductsOfStages, kOtherSteps);
    const int while_growing =
        within(std::min(kMostOfRun * chosen_ns, kLongestTrial), kProductsOfStages, HUGE_VAL);
    const auto run = paced(method, calls, std::max(kMostOfCalls * calls, while_growing));
    if (!run || (run->status != RunStatus::interrupted && !run->ok()) || stopped_) return 0.0;
    if (!run->ok() && !(passed(half_, 0) > 0.0)) return 0.0;
    const double ns = cost_to_end(method, *run);
    if (ns > most) return 0.0;
    const std::vector<std::vector<double>> found = samples(method);
    if (found.size() != right.size()) return 0.0;
    std::vector<double> peak, off;
    for (std::size_t c = 0; c < right.size(); ++c) {
      peak.push_back(0.0);
      off.push_back(0.0);
      for (std::size_t i = 0; i < std::min(right[c].size(), found[c].size()); ++i) {
        peak[c] = std::max(peak[c], std::abs(right[c][i]));
        off[c] = std::max(off[c], std::abs(found[c][i] - right[c][i]));
      }
    }
    // Forces that hardly act yet, far from what moves, are known to as much of the largest.
    const double least = kAgrees * *std::max_element(peak.begin(), peak.end());
    for (std::size_t c = 0; c < right.size(); ++c)
      if (!(off[c] <= kAgrees * std::max(peak[c], least))) return 0.0;
    return ns;
  }

  void change(MethodTrial& trial, const Method& best) const {
    std::ostringstream text;
    text.precision(2);
    text << chosen_.reason << "; but a trial says that it would cost about "
         << trial.chosen_ns / trial.other_ns << " times as much as " << to_text(best)
         << ", which agrees with it to " << kAgrees << " of every force over the first " << span_
         << " s: that one";
    trial.choice.method = best;
    trial.choice.reason = text.str();
  }

  const System& system_;
  const MethodChoice& chosen_;
  const double duration_;
  const std::function<bool()>& progress_;
  double span_ = 0.0;          // s, of the chosen method's trial
  std::vector<double> times_;  // s, at the calls of the run tried last
  std::size_t half_ = 0;       // of the calls that one was to have at least
  bool stopped_ = false;
};

}  // namespace

MethodTrial try_methods(const System& system, const MethodChoice& chosen, double duration,
                        const std::function<bool()>& progress) {
  return Trial(system, chosen, duration, progress).run();
}

}  // namespace drev
