#pragma once
/// Rainflow counting of load cycles, and damage by Miner's rule.
///
/// Source: ASTM E1049-85 (2017), Standard Practices for Cycle Counting in Fatigue Analysis, section 5.4.4: of the last
/// three turning points with ranges X (last) >= Y (before), Y counts as one cycle, or as half a cycle if it
/// contains the starting point; the remaining ranges count as half cycles at the end. Miner: D = sum n_i /
/// N(range_i).
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
  double count = 0.0;  ///< 1 for a cycle, 0.5 for a half cycle
};

/// Counts cycles while the signal goes on. Memory: the turning points that are not counted yet; their ranges
/// are nested.
class RainflowCounter {
 public:
  using Take = std::function<void(const RainflowCycle&)>;
  /// take: called with each cycle as soon as it is counted.
  explicit RainflowCounter(Take take) : take_(std::move(take)) {}
  /// Adds the next value of the signal, whether or not it is a turning point; finite.
  void add(double value);
  /// Counts the remaining ranges as half cycles, and starts a new count.
  void finish();

 private:
  void count_closed();
  Take take_;
  std::vector<double> points_;  ///< turning points; the last one is the current value of the signal
};

/// All cycles of a signal, in the order in which they are counted. Throws ModelError for values that are not finite.
std::vector<RainflowCycle> count_rainflow(std::span<const double> signal);

/// Damage by Miner's rule [-]: sum count / N(range), with ranges in Pa. 1 means failure.
double miner_sum(std::span<const RainflowCycle> cycles, const SnLine& line);
/// Damage 1 / N(range) of one cycle [-].
double damage_of(double range, const SnLine& line);

/// Cycles in classes of their range, in bounded memory: 8 classes per octave. Classes whose ranges are all below kRounding of
/// the signal's largest size are rounding, not motion, and are left out.
class RainflowHistogram {
 public:
  struct Class {
    double count = 0.0, largest = 0.0, sum = 0.0;  ///< cycles; largest range; sum of count times range
    double mean_range() const { return count > 0.0 ? sum / count : 0.0; }
  };
  void add(const RainflowCycle& cycle);
  /// The classes in order of ascending range.
  std::vector<Class> classes() const;
  double cycles() const;
  /// The largest range; 0: there is no cycle.
  double largest() const;
  static constexpr double kRounding = 1e-10;

 private:
  std::map<int, Class> classes_;
  double size_ = 0.0;  ///< largest |value| of the signal
};

/// A channel whose cycles are counted in a run, with its factor to the stress of the S-N line.
struct RainflowChannel {
  Channel channel;
  double stress_per_unit = SectionStrength::kNone;  ///< Pa per unit of the channel; not a number: no stress
  SnLine line = {};
};

/// Counts cycles of channels over a run. Turning points are found on the motion itself, inside steps as well
/// as at their ends.
class RainflowWatch final : public Observer {
 public:
  explicit RainflowWatch(std::vector<RainflowChannel> channels);
  RainflowWatch(const RainflowWatch&) = delete;
  RainflowWatch& operator=(const RainflowWatch&) = delete;
  bool fits(const System& system) const override;
  void look_through(StepMotion& motion) override { motion_ = &motion; }
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  void restart(const Assembler& assembler, const EvaluatedState& point) override;
  bool needs_acceleration() const override;
  bool watches_loads() const override;

  struct Result {
    RainflowChannel of;
    RainflowHistogram histogram;  ///< ranges in the unit of the channel
    double damage = 0.0;          ///< damage over the run by Miner's rule [-]; 0 without an S-N line
  };
  /// To be called once, at the end of the run: counts the remaining ranges as half cycles.
  const std::vector<Result>& finish();

 private:
  std::vector<Result> results_;
  std::vector<RainflowCounter> counters_;
  std::vector<double> last_;
  StepMotion* motion_ = nullptr;
};

}  // namespace drev
