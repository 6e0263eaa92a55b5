#include "solvers/exact/kink_sizes.hpp"

#include <algorithm>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

namespace {
constexpr double kNoKink = 1e200;  // a rate in lanes behind the last kink: never the least
}  // namespace

struct KinkSizes::Find {
  template <class L>
  [[gnu::always_inline]] static void run(int count, std::size_t room, double* x, double* sums) {
    L most_pull{}, most_gain{}, push{}, least_rate;
    take(std::numeric_limits<double>::infinity(), least_rate);
    for (int i = 0; i < count; i += kLanes) {
      const auto at = [&](Quantity q) __attribute__((always_inline)) { return x + q * room + i; };
      L kinks, reach, feedback, rate, slope, value;
      load(first_lanes(count - i), kinks);
      load(at(kReach), reach);
      reach *= kinks;
      load(at(kFeedback), feedback);
      magnitude(feedback);
      load(at(kRate), rate);
      magnitude(rate);
      rate = rate * kinks + kNoKink * (1.0 - kinks);
      load(at(kChord), value);
      value = reach * value * rate;
      store(value, at(kPull));
      raise(most_pull, value);
      load(at(kSlope), slope);
      value = reach * slope * feedback;
      store(value, at(kGain));
      raise(most_gain, value);
      load(at(kPush), value);
      push += (kinks * value) * slope * rate;
      sink(least_rate, rate / feedback);
    }
    sums[0] = largest_of(most_pull);
    sums[1] = largest_of(most_gain);
    sums[2] = sum_of(push);
    sums[3] = -largest_of(-1.0 * least_rate);
  }
};

void KinkSizes::make_room() {
  table_.make_room();
  loads_.resize(table_.room());
}

void KinkSizes::find(double h) {
  most_pull_ = most_gain_ = push_ = 0.0;
  least_rate_ = std::numeric_limits<double>::infinity();
  if (count_ == 0) return;
  std::array<double, 4> sums;
  run_widest<Find>(count(), table_.room(), table_.at(0), sums.data());
  most_pull_ = sums[0];
  most_gain_ = sums[1];
  push_ = (1.0 + kMonotone) * h * h * sums[2];
  least_rate_ = (1.0 - kMonotone) * sums[3];
}

}  // namespace drev
