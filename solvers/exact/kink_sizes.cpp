#include "solvers/exact/kink_sizes.hpp"

#include <algorithm>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

struct KinkSizes::Find {
  template <class L>
  [[gnu::always_inline]] static void run(int count, std::size_t room, double* x, double* sums) {
    L most_pull{}, most_gain{}, push{}, least_rate;
    take(std::numeric_limits<double>::infinity(), least_rate);
    for (int i = 0; i < count; i += kLanes) {
      const auto at = [&](Quantity q) __attribute__((always_inline)) { return x + q * room + i; };
      L reach, feedback, rate, slope, value;
      load(at(kReach), reach);
      load(at(kFeedback), feedback);
      magnitude(feedback);
      load(at(kRate), rate);
      magnitude(rate);
      load(at(kChord), value);
      value = reach * value * rate;
      store(value, at(kPull));
      raise(most_pull, value);
      load(at(kSlope), slope);
      value = reach * slope * feedback;
      store(value, at(kGain));
      raise(most_gain, value);
      load(at(kPush), value);
      push += value * slope * rate;
      sink(least_rate, rate / feedback);
    }
    sums[0] = largest_of(most_pull);
    sums[1] = largest_of(most_gain);
    sums[2] = sum_of(push);
    sums[3] = -largest_of(-1.0 * least_rate);
  }
};

void KinkSizes::make_room() {
  const std::size_t more = room_ + kLanes;
  LaneVector values(kQuantities * more);
  for (std::size_t q = 0; q < kQuantities; ++q)
    std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(q * room_), room_,
                values.begin() + static_cast<std::ptrdiff_t>(q * more));
  values_ = std::move(values);
  room_ = more;
  loads_.resize(room_);
}

void KinkSizes::find(double h) {
  most_pull_ = most_gain_ = push_ = 0.0;
  least_rate_ = std::numeric_limits<double>::infinity();
  if (count_ == 0) return;
  for (std::size_t i = count_; i % kLanes != 0; ++i) {  // no kink, but one that turns
    for (const Quantity q : {kReach, kPush, kFeedback, kChord, kSlope}) at(q)[i] = 0.0;
    at(kRate)[i] = 1.0;
  }
  std::array<double, 4> sums;
  run_widest<Find>(count(), room_, values_.data(), sums.data());
  most_pull_ = sums[0];
  most_gain_ = sums[1];
  push_ = (1.0 + kMonotone) * h * h * sums[2];
  least_rate_ = (1.0 - kMonotone) * sums[3];
}

}  // namespace drev
