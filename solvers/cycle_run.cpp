#include "solvers/cycle_run.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace drev {

namespace {

constexpr double kUnbounded =
    30.0;  // growth in each half of the cycles that statistics are of: no bound in sight
constexpr int kBatches = 20;
constexpr double kStudent = 2.093;               // 97.5 % quantile of Student's t with 19 degrees of freedom
constexpr int kRunSamples = 64;                  // a cycle
constexpr double kGolden = 0.61803398874989485;  // whose multiples fill the unit interval evenly

}  // namespace

CycleRun::CycleRun(const System& system, double period, State start)
    : system_(system), period_(period), exact_(!why_not_exact(system)), state_(std::move(start)) {
  state_.t = 0.0;
}

void CycleRun::run_to(double t) {
  const Method method = exact_ ? Method{kExact, 0.0, tolerance_} : Method{"sdirk4", period_ / 20.0, 1e-8};
  // A run in which the damping is not in the energy's books is judged by the motion alone.
  const RunSummary run =
      run_method(system_, method, {.t_start = state_.t, .t_end = t, .energy_tolerance = 1e6}, state_);
  if (run.status != RunStatus::success) throw SolverError(run.reason);
}

void CycleRun::advance(int cycles) {
  for (int c = 0; c < cycles; ++c) {
    run_to(period_ * static_cast<double>(++cycles_));
    Vector end(state_.z.size() + state_.v.size());
    end << state_.z, state_.v;
    z_size_ = std::max(0.9 * z_size_, state_.z.cwiseAbs().maxCoeff());
    v_size_ = std::max(0.9 * v_size_, state_.v.cwiseAbs().maxCoeff());
    ends_.insert(ends_.begin(), std::move(end));
    if (ends_.size() > 2 * static_cast<std::size_t>(kMostCycles) + 1) ends_.pop_back();
  }
}

int CycleRun::repeats() const {
  const Eigen::Index n = state_.z.size();
  const auto same = [&](const Vector& a, const Vector& b) {
    return (a - b).head(n).cwiseAbs().maxCoeff() <= kRepeats * z_size_ &&
           (a - b).tail(n).cwiseAbs().maxCoeff() <= kRepeats * std::max(v_size_, 1e-300);
  };
  for (std::size_t k = 1; k <= static_cast<std::size_t>(kMostCycles) && 2 * k < ends_.size(); ++k)
    if (same(ends_[0], ends_[k]) && same(ends_[k], ends_[2 * k])) return static_cast<int>(k);
  return 0;
}

void CycleRun::sample(int cycles, int count, bool shifted, const std::function<void(const State&, int)>& at) {
  for (int i = 0; i < cycles * count; ++i) {
    const double cycle = i / count, shift = shifted ? std::fmod(kGolden * cycle, 1.0) : 0.0;
    const double t = period_ * (static_cast<double>(cycles_) + cycle + (i % count + shift) / count);
    if (t > state_.t) run_to(t);
    at(state_, i);
  }
  cycles_ += cycles;
  run_to(period_ * static_cast<double>(cycles_));
}

void find_statistics(CycleRun& run, const System& system, const std::vector<std::string>& names, int cycles,
                     SweptRun& result) {
  const auto count = static_cast<Eigen::Index>(names.size());
  const std::vector<Channel> channels = find_channels(system, names);
  result.cycles = cycles;
  result.mean = result.mean_error = result.deviation = Vector::Zero(count);
  result.lowest = Vector::Constant(count, INFINITY);
  result.highest = Vector::Constant(count, -INFINITY);
  Eigen::MatrixXd batches = Eigen::MatrixXd::Zero(count, kBatches);
  const int all = cycles * kRunSamples, batch = std::max(1, all / kBatches);
  Vector squares = Vector::Zero(count), values(count);
  std::array<Vector, 3> sizes;  // largest in the first batch, the one in the middle and the last
  sizes.fill(Vector::Zero(count));
  Assembler assembler(system);
  run.sample(cycles, kRunSamples, true, [&](const State& at, int i) {
    assembler.set_time(at.t);
    for (Eigen::Index c = 0; c < count; ++c)
      values[c] = channels[static_cast<std::size_t>(c)].evaluate(assembler, at);
    result.mean += values / all;
    squares += values.cwiseAbs2() / all;
    batches.col(std::min(i / batch, kBatches - 1)) += values;
    for (int part = 0; part < 3; ++part)
      if (i / batch == part * (kBatches - 1) / 2)
        sizes[idx(part)] = sizes[idx(part)].cwiseMax(values.cwiseAbs());
    result.lowest = result.lowest.cwiseMin(values);
    result.highest = result.highest.cwiseMax(values);
  });
  for (Eigen::Index c = 0; c < count; ++c)
    if (sizes[0][c] > 0.0 && sizes[1][c] > kUnbounded * sizes[0][c] &&
        !(sizes[2][c] <= kUnbounded * sizes[1][c]))
      result.reason =
          "the motion grows without bound, a thousandfold in less than " + std::to_string(cycles) + " cycles";
  result.deviation = (squares - result.mean.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  for (int b = 0; b < kBatches; ++b) {
    const int size = b + 1 < kBatches ? batch : all - batch * (kBatches - 1);
    result.mean_error += (batches.col(b) / size - result.mean).cwiseAbs2();
  }
  result.mean_error = kStudent * (result.mean_error / (kBatches * (kBatches - 1.0))).cwiseSqrt();
}

}  // namespace drev
