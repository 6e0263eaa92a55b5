#pragma once
/// Progress: asks the caller of a run, every 100 steps, whether it goes on; and whether the run would ever end.
#include <functional>
#include <utility>

namespace drev {

class Progress {
 public:
  /// report: called with the part done, 0..1; false stops the run; empty: nobody is asked. Times in s.
  Progress(std::function<bool(double)> report, double t_start, double t_end)
      : report_(std::move(report)), t_start_(t_start), t_end_(t_end), paced_at_(t_start) {}

  /// After a step that ends at t, the `steps`-th of the run. False: the caller stops the run.
  bool goes_on(long steps, double t) const {
    return steps % kSteps != 0 || !report_ || report_((t - t_start_) / (t_end_ - t_start_));
  }
  /// The same. False: the last kPaced steps went on by less than 1e-7 of the run, which would take 1e12 steps so.
  bool would_end(long steps, double t) {
    if (steps % kPaced != 0) return true;
    return t - std::exchange(paced_at_, t) >= kLeastPace * (t_end_ - t_start_);
  }
  static constexpr const char* kNoEnd =
      "100000 steps went on by less than 1e-7 of the run, which would not end; its longest step is ";

 private:
  static constexpr long kPaced = 100000;
  static constexpr long kSteps = 100;
  static constexpr double kLeastPace = 1e-7;
  std::function<bool(double)> report_;
  double t_start_, t_end_, paced_at_;
};

}  // namespace drev
