#pragma once
/// Where the time of a run goes, by phase. Off unless asked for: reading the clock costs some 25 ns each
/// time, several times a step.
#include <array>
#include <chrono>

namespace drev {

enum class RunSection {
  loads,      ///< loads, known motions, the laws' inputs
  linear,     ///< products with K and C, solves on the factor
  contacts,   ///< Newton on the contact forces
  balance,    ///< energy balance
  observers,  ///< recorder, peaks, statistics
  count
};

class RunClock {
 public:
  explicit RunClock(bool on = false) : on_(on) {}
  /// Starts a phase; the one before it ends.
  void enter(RunSection phase) {
    if (!on_) return;
    const auto now = std::chrono::steady_clock::now();
    if (running_) seconds_[index_] += std::chrono::duration<double>(now - since_).count();
    since_ = now;
    index_ = static_cast<std::size_t>(phase);
    running_ = true;
  }
  double seconds(RunSection phase) const { return seconds_[static_cast<std::size_t>(phase)]; }
  bool on() const { return on_; }

 private:
  bool on_ = false, running_ = false;
  std::size_t index_ = 0;
  std::chrono::steady_clock::time_point since_{};
  std::array<double, static_cast<std::size_t>(RunSection::count)> seconds_{};
};

}  // namespace drev
