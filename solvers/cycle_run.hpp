#pragma once
/// A run in time over whole cycles, to find what a train does where no periodic motion that is known is stable.
/// Internal to sweep_nonlinear().
#include <drev/core/channel.hpp>
#include <drev/core/state.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>

#include <functional>
#include <string>
#include <vector>

namespace drev {

class CycleRun {
 public:
  /// system: at its speed. period: of a cycle [s].
  CycleRun(const System& system, double period, State start);

  /// Runs `cycles` more. Throws SolverError where the run fails.
  void advance(int cycles);
  /// In how many cycles, of the last ones, the motion repeats to kRepeats of itself; 0: not within kMostCycles.
  int repeats() const;
  /// Runs `cycles` more, and calls at each of `count` even times of a cycle: its start among them, or, where they are
  /// shifted, others in each cycle, so that a motion that repeats is seen all over.
  void sample(int cycles, int count, bool shifted, const std::function<void(const State&, int)>& at);
  const State& state() const { return state_; }

  static constexpr double kRepeats = 1e-6;
  static constexpr int kMostCycles = 12;

 private:
  void run_to(double t);

  const System& system_;
  double period_, tolerance_ = 1e-9;
  bool exact_;
  State state_;
  long cycles_ = 0;
  std::vector<Vector> ends_;  // (z, v) at the end of the last cycles, the last one first
  double z_size_ = 0.0, v_size_ = 0.0;
};

/// Figures of the channels over `cycles` more cycles of a run, and why there are none of a motion that grows.
void find_statistics(CycleRun& run, const System& system, const std::vector<std::string>& channels,
                     int cycles, SweptRun& result);

}  // namespace drev
