#pragma once
/// Distribution of positive values in bounded memory: logarithmic bins, 16 an octave.
///
/// Count, mean and largest are exact. A quantile is the middle of the bin that holds it: within 2.2 %
/// (2^(1/32) - 1) of a value of that rank.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace drev {

class Distribution {
 public:
  void add(double value) {
    ++count_;
    sum_ += value;
    largest_ = std::max(largest_, value);
    ++bins_[value > 0.0 ? static_cast<int>(std::floor(kAnOctave * std::log2(value))) : kZero];
  }
  void add(const Distribution& other) {
    count_ += other.count_;
    sum_ += other.sum_;
    largest_ = std::max(largest_, other.largest_);
    for (const auto& [bin, count] : other.bins_) bins_[bin] += count;
  }

  long count() const { return count_; }
  double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0.0; }
  double largest() const { return largest_; }
  /// The least value that `part` (0..1) of all do not exceed; 0 without values.
  double quantile(double part) const {
    const double rank = std::max(1.0, std::ceil(part * static_cast<double>(count_)));
    long below = 0;
    for (const auto& [bin, count] : bins_) {
      below += count;
      if (static_cast<double>(below) >= rank)
        return bin == kZero ? 0.0 : std::min(largest_, std::exp2((bin + 0.5) / kAnOctave));
    }
    return 0.0;
  }

 private:
  static constexpr double kAnOctave = 16.0;
  static constexpr int kZero = std::numeric_limits<int>::min();
  long count_ = 0;
  double sum_ = 0.0, largest_ = 0.0;
  std::map<int, long> bins_;  // by floor(16 log2(value))
};

}  // namespace drev
