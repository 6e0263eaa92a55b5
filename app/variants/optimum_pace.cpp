#include "app/variants/optimum_pace.hpp"

#include <algorithm>

namespace drev::app {

double OptimumPace::part_done(std::uint64_t computed, Clock::time_point now) {
  const auto of = [](std::uint64_t variants) { return static_cast<double>(variants); };
  if (together_ == 0) return std::min(1.0, of(computed) / of(all_));
  const double first = of(together_) / threads_, last = of(all_ - std::min(all_, together_));
  if (computed < together_) return threads_ == 0 ? 0.0 : of(computed) / threads_ / (first + last);
  if (alone_ == Clock::time_point{}) alone_ = now;
  const double passed = std::chrono::duration<double>(now - start_).count();
  const double of_one = std::chrono::duration<double>(now - alone_).count() / of(computed - together_);
  if (computed == together_ || !(of_one > 0.0)) return threads_ == 0 ? 0.0 : first / (first + last);
  return std::min(1.0, passed / (passed + of_one * of(all_ - std::min(all_, computed))));
}

}  // namespace drev::app
