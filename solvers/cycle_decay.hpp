#pragma once
/// CycleDecay: whether the states at the ends of successive cycles come to repeat, and how far the last is from
/// where they lead to. Of the cycles n seen so far, and a number of cycles k:
///
///   d_n = max(|z_n - z_(n-k)| / |z|, |v_n - v_(n-k)| / |v|)       D, D': largest d of the last H, of the H before
///   q = (D / D')^(1/H),   rest = sum_(i>=1) D q^(ik) = D q^k / (1 - q^k),   H = max(4, 2 k)
///
/// They repeat in k cycles where D and rest are below kRepeats. A slow transient, which changes little from cycle to
/// cycle and has far to go, is not taken for a motion that repeats: with a multiplier of 0.999 rest is 1,000 D. Below
/// kRounding d is the run's own error, and tells no ratio. Where d of a divisor of k is below kNear, the
/// cycles may come to repeat in that (a multiplier near -1), and k is not taken yet.
#include <drev/core/state.hpp>

#include <array>
#include <deque>
#include <optional>

namespace drev {

class CycleDecay {
 public:
  static constexpr double kRepeats = 1e-6, kRounding = 1e-9, kNear = 10.0 * kRepeats;
  static constexpr int kMostCycles = 12;

  struct Repetition {
    int cycles = 0;      ///< k
    double ratio = 0.0;  ///< q of one cycle, < 1; 0 where d is the run's own error
    double rest = 0.0;   ///< beside the largest unknown, or rate
    /// What is left of a figure that changed by `change` from one repetition to the next.
    double left(double change) const;
  };

  /// The state at the end of one more cycle.
  void add(const Vector& z, const Vector& v);
  /// The fewest cycles in which they repeat; none: they do not within kMostCycles, or not yet.
  std::optional<Repetition> repeats() const;

 private:
  struct End {
    Vector z, v;
  };
  using Distances = std::array<double, kMostCycles>;
  std::optional<Repetition> repeats_in(int k) const;
  /// Largest d of k in `count` cycles, the last of which is `back` before the last of all.
  double largest(int k, int back, int count) const;

  std::deque<End> ends_;             // the last one first
  std::deque<Distances> distances_;  // of each k; infinite where there are too few cycles
  double z_size_ = 0.0, v_size_ = 0.0;
};

}  // namespace drev
