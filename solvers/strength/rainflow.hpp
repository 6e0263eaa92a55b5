#pragma once
/// Rainflow counting of load cycles, and Miner's sum.
///
/// Source: ASTM E1049-85 (2017), Standard Practices for Cycle Counting in Fatigue Analysis, section 5.4.4: of the last
/// three turning points with ranges X (last) >= Y (before), Y counts as one cycle, as half a cycle where it holds the
/// starting point; what is left at the end counts as half cycles. Miner: D = sum n_i / N(range_i).
#include <drev/core/channel.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/strength/section_strength.hpp>

#include <functional>
#include <map>
#include <span>
#include <vector>

namespace drev {

struct RainflowCycle {
  double range = 0.0;  ///< maximum - minimum, > 0, in the unit of the signal
  double mean = 0.0;   ///< (maximum + minimum) / 2
  double count = 0.0;  ///< 1, or 0.5 of a half cycle
};

/// Counts turning points as they come. Memory: the turning points that are not counted yet, which are nested.
class RainflowCounter {
 public:
  using Take = std::function<void(const RainflowCycle&)>;
  /// take: called with each cycle as soon as it is counted.
  explicit RainflowCounter(Take take) : take_(std::move(take)) {}
  /// The next value of the signal, a turning point or not; finite.
  void add(double value);
  /// Counts what is left as half cycles, and begins again.
  void finish();

 private:
  void count_closed();
  Take take_;
  std::vector<double> points_;  ///< turning points, the last one as far as the signal has gone
};

/// All cycles of a signal, in the order in which they are counted. Throws ModelError for values that are not finite.
std::vector<RainflowCycle> count_rainflow(std::span<const double> signal);

/// sum count / N(range); ranges in Pa. 1: failure.
double miner_sum(std::span<const RainflowCycle> cycles, const SnLine& line);
/// 1 / N(range) of one cycle.
double damage_of(double range, const SnLine& line);

/// Cycles by the size of their range, in bounded memory: 8 classes an octave.
class RainflowHistogram {
 public:
  struct Class {
    double count = 0.0, largest = 0.0, sum = 0.0;  ///< sum: of count times range
    double mean_range() const { return count > 0.0 ? sum / count : 0.0; }
  };
  void add(const RainflowCycle& cycle);
  /// From the smallest ranges to the largest.
  std::vector<Class> classes() const;
  double cycles() const { return cycles_; }
  double largest() const { return largest_; }

 private:
  std::map<int, Class> classes_;
  double cycles_ = 0.0, largest_ = 0.0;
};

/// What is counted of a run: a channel, scaled to what the S-N line is given for.
struct RainflowChannel {
  Channel channel;
  double stress_per_unit = SectionStrength::kNone;  ///< Pa per unit of the channel; not a number: no stress
  SnLine line = {};
};

/// Counts channels over a run; turning points are found on the motion itself, inside steps as at their ends.
class RainflowWatch final : public Observer {
 public:
  explicit RainflowWatch(std::vector<RainflowChannel> channels);
  RainflowWatch(const RainflowWatch&) = delete;
  RainflowWatch& operator=(const RainflowWatch&) = delete;
  void look_through(StepMotion& motion) override { motion_ = &motion; }
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  void restart(const Assembler& assembler, const EvaluatedState& point) override;
  bool needs_acceleration() const override;
  bool watches_loads() const override;

  struct Result {
    RainflowChannel of;
    RainflowHistogram histogram;  ///< ranges in the unit of the channel
    double damage = 0.0;          ///< Miner's sum over the run; 0 without an S-N line
  };
  /// Once, at the end of the run: counts what is left as half cycles.
  const std::vector<Result>& finish();

 private:
  std::vector<Result> results_;
  std::vector<RainflowCounter> counters_;
  std::vector<double> last_;
  StepMotion* motion_ = nullptr;
};

}  // namespace drev
