#include "solvers/cycle_run.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/law_force.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "solvers/at_speed.hpp"
#include "solvers/cycle_decay.hpp"
#include "solvers/periodic/order_content.hpp"
#include "solvers/run/for_all.hpp"

namespace drev {

namespace {

constexpr int kBatches = 20;
// No bound is in sight of a motion whose largest values grow by this factor in each of so many parts of the cycles that
// statistics are of: a motion that has a bound has settled, or meets it.
constexpr double kGrowth = 1.25;
constexpr std::size_t kGrowthParts = 5;
/// Batches, each of as many of those, and the 97.5 % quantile of Student's t with one degree of freedom less. The fewer
/// there are, the slower a modulation may be that does not make their means alike.
struct BatchCount {
  int count;
  double student;
};
constexpr std::array<BatchCount, 3> kBatchCounts{{{20, 2.093}, {10, 2.262}, {5, 2.776}}};
constexpr int kQuarters = 4;                          // points in a step, for statistics
constexpr double kGoldenRatio = 0.61803398874989485;  // whose multiples fill 0 to 1 evenly
constexpr double kRunTolerance = 1e-9;                // of a cycle

/// Mean, mean square and extremes of channels over a part of a run, and the mean torque left over on floating parts.
struct CycleFigures {
  Vector mean, square, lowest, highest, left_over;
  Vector largest() const { return highest.cwiseMax(-lowest); }
  Vector deviation() const { return (square - mean.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt(); }
};

/// The mean of figures of parts that last equally long.
struct FigureSum {
  CycleFigures all;
  int count = 0;
  void add(const CycleFigures& part) {
    if (count++ == 0) {
      all = part;
      return;
    }
    all.mean += (part.mean - all.mean) / count;
    all.square += (part.square - all.square) / count;
    all.left_over += (part.left_over - all.left_over) / count;
    all.lowest = all.lowest.cwiseMin(part.lowest);
    all.highest = all.highest.cwiseMax(part.highest);
  }
};

/// Mean and mean square of each run that it is shown, extremes of all of them.
class FigureObserver final : public Observer {
 public:
  /// fine: Gauss's points in a step, and extremes located, for figures of one motion; else as statistics are.
  FigureObserver(const std::vector<Channel>& channels, bool fine) : peaks_(channels, fine), fine_(fine) {}

  void look_through(StepMotion& motion) override {
    motion_ = &motion;
    peaks_.look_through(motion);
  }
  void start(const Assembler& assembler, const EvaluatedState& point) override {
    sum_ = squares_ = Vector::Zero(static_cast<Eigen::Index>(peaks_.channels().size()));
    lasted_ = 0.0;
    if (lowest_.size() == sum_.size()) {
      peaks_.restart(assembler, point);
    } else {
      peaks_.start(assembler, point);
      lowest_ = Vector::Constant(sum_.size(), INFINITY);
      highest_ = -lowest_;
    }
    end_ = values(assembler, point.state);
  }
  bool looks_inside(const EvaluatedState& from, const EvaluatedState& to,
                    const double* beyond_cubic) override {
    return peaks_.looks_inside(from, to, beyond_cubic);
  }
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override {
    const double h = to.state.t - from.state.t;
    if (h > 0.0 && fine_) {
      const double half = 0.5 * h, middle = from.state.t + half;
      for (std::size_t g = 0; g < kGaussPoints.size(); ++g)
        for (const double side : {-half, half})
          add(motion_->at(middle + side * kGaussPoints[g]), half * kGaussWeights[g]);
    } else if (h > 0.0) {
      add_quarters(assembler, from.state.t, h, to.state);
    }
    lasted_ += h;
    peaks_.step(assembler, from, to);
  }
  void restart(const Assembler& assembler, const EvaluatedState& point) override {
    peaks_.restart(assembler, point);
    end_ = values(assembler, point.state);
  }
  bool needs_acceleration() const override { return peaks_.needs_acceleration(); }
  bool watches_loads() const override { return peaks_.watches_loads(); }

  CycleFigures figures() const {
    CycleFigures found{sum_ / lasted_, squares_ / lasted_, lowest_, highest_, {}};
    for (Eigen::Index c = 0; c < sum_.size(); ++c) {
      const Peak& peak = peaks_.peaks()[static_cast<std::size_t>(c)];
      found.lowest[c] = std::min(lowest_[c], peak.min);
      found.highest[c] = std::max(highest_[c], peak.max);
    }
    return found;
  }

 private:
  Vector values(const Assembler& assembler, const State& state) const {
    Vector y(sum_.size());
    for (Eigen::Index c = 0; c < y.size(); ++c)
      y[c] = peaks_.channels()[static_cast<std::size_t>(c)].evaluate(assembler, state);
    return y;
  }
  void add(const StepMotion::Point& point, double weight) {
    const Vector y = values(point.assembler, point.at.state);
    sum_ += weight * y;
    squares_ += weight * y.cwiseAbs2();
    lowest_ = lowest_.cwiseMin(y);
    highest_ = highest_.cwiseMax(y);
  }
  /// One point in each quarter, all at the same place u in it, which is even in 0 to 1 over the steps. What is off the middle
  /// has the mean 0; of what is smooth, the ends' difference takes it away at once.
  void add_quarters(const Assembler& assembler, double t, double h, const State& end) {
    place_ += kGoldenRatio;
    place_ -= std::floor(place_);
    const double quarter = h / kQuarters;
    for (int i = 0; i < kQuarters; ++i) add(motion_->at(t + (i + place_) * quarter), quarter);
    const Vector to = values(assembler, end);
    const double off = (place_ - 0.5) * quarter;
    sum_ -= off * (to - end_);
    squares_ -= off * (to.cwiseAbs2() - end_.cwiseAbs2());
    end_ = to;
  }

  Peaks peaks_;
  bool fine_;
  StepMotion* motion_ = nullptr;
  Vector sum_, squares_, lowest_, highest_;
  Vector end_;  // values at the end of the last step
  double lasted_ = 0.0, place_ = 0.0;
};

class CycleRun {
 public:
  CycleRun(const System& system, State start, const CycleRunOptions& options)
      : system_(system),
        options_(options),
        exact_(!why_not_exact(system)),
        hold_(system, options.floating),
        channels_(find_channels(system, options.channels)),
        state_(std::move(start)) {
    state_.t = 0.0;
  }
  CycleRunResult run();

 private:
  void run_to(double t, const std::vector<Observer*>& observers);
  bool cycle(FigureObserver* watch, FigureSum* figures);
  Vector end_cycle();
  bool settle();
  void of_repetitions(const CycleDecay::Repetition& found);
  void of_statistics(const std::vector<CycleFigures>& cycles);
  void sample(int cycles);

  const System& system_;
  const CycleRunOptions& options_;
  bool exact_;
  SpeedHold hold_;
  std::vector<Channel> channels_;
  State state_;
  long cycles_ = 0;
  CycleDecay decay_;
  CycleRunResult result_;
};

void CycleRun::run_to(double t, const std::vector<Observer*>& observers) {
  const Method method =
      exact_ ? Method{kExact, 0.0, kRunTolerance} : Method{"sdirk4", options_.period / 20.0, 1e-8};
  // A run in which the damping is not in the energy's books is judged by the motion alone.
  const RunSummary run = run_method(
      hold_.system(), method, {.t_start = state_.t, .t_end = t, .energy_tolerance = 1e6}, state_, observers);
  if (run.status != RunStatus::success) throw SolverError(run.reason);
}

/// One cycle more, whose figures are added where it is watched. False: ended.
bool CycleRun::cycle(FigureObserver* watch, FigureSum* figures) {
  if (options_.go_on && !options_.go_on()) {
    result_.ended = true;
    return false;
  }
  std::vector<Observer*> observers;
  if (watch != nullptr) observers.push_back(watch);
  hold_.begin_cycle(state_);
  run_to(options_.period * static_cast<double>(cycles_ + 1), observers);
  const Vector left_over = end_cycle();
  decay_.add(state_.z, state_.v);
  if (watch != nullptr) {
    CycleFigures of = watch->figures();
    of.left_over = left_over;
    figures->add(of);
  }
  return true;
}

Vector CycleRun::end_cycle() {
  ++cycles_;
  return hold_.end_cycle(state_, options_.period, kRunTolerance);
}

CycleRunResult CycleRun::run() {
  try {
    if (!settle()) result_ = {.run = {}, .motion = {}, .ended = true};
  } catch (const SolverError& error) {
    result_ = {};
    result_.run.reason = error.what();
  }
  return std::move(result_);
}

/// False: ended.
bool CycleRun::settle() {
  const int half = options_.cycles / 2;
  std::vector<CycleFigures> watched;
  FigureObserver watch(channels_, false);
  for (int c = 0; c < 2 * half; ++c) {
    FigureSum one;
    if (!cycle(c < half ? nullptr : &watch, &one)) return false;
    if (c >= half) watched.push_back(one.all);
    if (const auto found = decay_.repeats()) {
      of_repetitions(*found);
      return !result_.ended;
    }
  }
  of_statistics(watched);
  return true;
}

void CycleRun::of_repetitions(const CycleDecay::Repetition& found) {
  SweptRun& run = result_.run;
  run.repeats = run.cycles = found.cycles;
  const auto repetition = [&](CycleFigures& figures) {
    FigureObserver watch(channels_, true);
    FigureSum sum;
    for (int c = 0; c < found.cycles; ++c)
      if (!cycle(&watch, &sum)) return false;
    figures = sum.all;
    return true;
  };
  CycleFigures before, now;
  if (!repetition(before)) return;
  while (true) {
    if (!repetition(now)) return;
    const Vector of_mean = (now.mean - before.mean).cwiseAbs();
    const Vector change = of_mean.cwiseMax((now.deviation() - before.deviation()).cwiseAbs())
                              .cwiseMax((now.lowest - before.lowest).cwiseAbs())
                              .cwiseMax((now.highest - before.highest).cwiseAbs());
    run.mean_error = of_mean.unaryExpr([&](double of) { return found.left(of); });
    run.error = 0.0;
    for (Eigen::Index c = 0; c < change.size(); ++c)
      if (const double largest = now.largest()[c]; largest > 0.0)
        run.error = std::max(run.error, found.left(change[c]) / largest);
    if (run.error <= options_.tolerance || cycles_ >= options_.cycles) break;
    before = now;
  }
  run.mean = now.mean;
  run.deviation = now.deviation();
  run.lowest = now.lowest;
  run.highest = now.highest;
  run.left_over = now.left_over;
  sample(found.cycles);
}

void CycleRun::sample(int cycles) {
  const int count = (options_.samples + cycles - 1) / cycles;
  for (int c = 0; c < cycles; ++c) {
    hold_.begin_cycle(state_);
    for (int i = 0; i < count; ++i) {
      const double t = options_.period * (static_cast<double>(cycles_) + static_cast<double>(i) / count);
      if (i > 0) run_to(t, {});
      result_.motion.push_back(state_.z);
    }
    if (c + 1 == cycles) break;
    run_to(options_.period * static_cast<double>(cycles_ + 1), {});
    end_cycle();
  }
}

/// Statistics of cycles that do not repeat, and why there are none of a motion that grows.
void CycleRun::of_statistics(const std::vector<CycleFigures>& cycles) {
  SweptRun& run = result_.run;
  const auto all = static_cast<int>(cycles.size());
  FigureSum sum;
  std::vector<FigureSum> batches(kBatches);
  for (int c = 0; c < all; ++c) {
    sum.add(cycles[static_cast<std::size_t>(c)]);
    batches[static_cast<std::size_t>(c * kBatches / all)].add(cycles[static_cast<std::size_t>(c)]);
  }
  run.cycles = all;
  run.mean = sum.all.mean;
  run.deviation = sum.all.deviation();
  run.lowest = sum.all.lowest;
  run.highest = sum.all.highest;
  run.left_over = sum.all.left_over;
  run.mean_error = Vector::Zero(run.mean.size());
  for (const auto& [count, student] : kBatchCounts) {
    const int joined = kBatches / count;
    Vector squares = Vector::Zero(run.mean.size()), mean;
    for (int b = 0; b < kBatches; ++b) {
      const Vector& next = batches[static_cast<std::size_t>(b)].all.mean;
      mean = b % joined == 0 ? next : mean + next;
      if (b % joined == joined - 1) squares += (mean / joined - run.mean).cwiseAbs2();
    }
    run.mean_error = run.mean_error.cwiseMax(student * (squares / (count * (count - 1.0))).cwiseSqrt());
  }
  // Largest values of each part of the cycles.
  std::array<Vector, kGrowthParts> sizes;
  for (int b = 0; b < kBatches; ++b) {
    const Vector largest = batches[static_cast<std::size_t>(b)].all.largest();
    Vector& size = sizes[static_cast<std::size_t>(b) * kGrowthParts / kBatches];
    size = size.size() > 0 ? Vector(size.cwiseMax(largest)) : largest;
  }
  for (Eigen::Index c = 0; c < run.mean.size(); ++c) {
    bool grows = sizes.front()[c] > 0.0;
    for (std::size_t part = 1; part < sizes.size(); ++part)
      grows = grows && !(sizes[part][c] <= kGrowth * sizes[part - 1][c]);
    if (grows)
      run.reason = "the motion grows without bound, by a quarter or more in each fifth of " +
                   std::to_string(all) + " cycles";
  }
}

}  // namespace

CycleRunResult run_cycles(const System& system, State start, const CycleRunOptions& options) {
  return CycleRun(system, std::move(start), options).run();
}

std::optional<std::vector<CycleRunResult>> run_at_speeds(const System& system,
                                                         const std::vector<RunStart>& starts, double turns,
                                                         const CycleRunOptions& options, int threads,
                                                         const std::function<bool(double)>& progress) {
  std::vector<CycleRunResult> results(starts.size());
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stop{false};
  for_all(starts.size(), threads, [&](std::size_t i, std::size_t thread) {
    const double speed = starts[i].speed;
    const System here = at_speed(system, reference_direction(system) * speed);
    State state = State::initial(here);
    if (starts[i].z.size() > 0) {
      state.z = starts[i].z;
      state.v = starts[i].v;
    }
    CycleRunOptions of = options;
    of.period = turns * kTwoPi / speed;
    // Progress and interrupts are the affair of the thread that called.
    of.go_on = [&] {
      if (thread == 0 && !stop && progress)
        stop = !progress(static_cast<double>(done) / static_cast<double>(starts.size()));
      return !stop;
    };
    results[i] = run_cycles(here, std::move(state), of);
    results[i].run.speed = speed;
    ++done;
  });
  if (stop) return std::nullopt;
  return results;
}

}  // namespace drev
