#pragma once
/// Progress: asks the caller of a run, every 100 steps, whether it goes on.
#include <functional>
#include <utility>

namespace drev {

class Progress {
 public:
  /// report: called with the part done, 0..1; false stops the run; empty: nobody is asked. Times in s.
  Progress(std::function<bool(double)> report, double t_start, double t_end)
      : report_(std::move(report)), t_start_(t_start), t_end_(t_end) {}

  /// After a step that ends at t, the `steps`-th of the run. False: the caller stops the run.
  bool goes_on(long steps, double t) const {
    return steps % kSteps != 0 || !report_ || report_((t - t_start_) / (t_end_ - t_start_));
  }

 private:
  static constexpr long kSteps = 100;
  std::function<bool(double)> report_;
  double t_start_, t_end_;
};

}  // namespace drev
