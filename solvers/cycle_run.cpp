#include "solvers/cycle_run.hpp"

#include <drev/core/error.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>

#include <algorithm>

namespace drev {

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

void CycleRun::sample(int cycles, int count, const std::function<void(const State&, int)>& at) {
  for (int i = 0; i < cycles * count; ++i) {
    at(state_, i);
    run_to(period_ * (static_cast<double>(cycles_) + static_cast<double>(i + 1) / count));
  }
  cycles_ += cycles;
}

}  // namespace drev
