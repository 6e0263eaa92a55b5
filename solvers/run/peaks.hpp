#pragma once
/// Largest and smallest value of channels over a run, with their times.
#include <drev/core/channel.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/run/peak.hpp>

#include <vector>

namespace drev {

class Assembler;
struct EvaluatedState;

class Peaks final : public Observer {
 public:
  /// inside_steps: false: values at the ends of steps count. true: between them a channel whose rate is
  /// known (deviations, shaft torques, laws) is taken as the cubic through both values and rates, so that a
  /// peak inside a step is found to the fourth order of its length; for methods whose steps are long beside
  /// their accuracy. Laws: a change of mesh phase or time inside the step is left out of the rate.
  explicit Peaks(std::vector<Channel> channels, bool inside_steps = false);

  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  bool needs_acceleration() const override;

  const std::vector<Channel>& channels() const { return channels_; }
  const std::vector<Peak>& peaks() const { return peaks_; }
  /// Channel of the largest amplitude.
  std::size_t largest() const;

 private:
  void look_inside(std::size_t c, const Assembler& assembler, const EvaluatedState& from,
                   const EvaluatedState& to);

  /// What a step needs of a channel, close together: there are many steps and few new peaks.
  struct Watched {
    bool two_entries = false;  ///< its value is the sum over z, its rate that over v
    Entry first{0, 0.0}, second{0, 0.0};
    double sum(const Vector& x) const {
      return first.coeff * x[first.index] + second.coeff * x[second.index];
    }
    double last = 0.0;
    double low = 0.0, high = 0.0;  ///< a value between them is no peak, and next to none
  };
  void set_bounds(std::size_t c);

  std::vector<Channel> channels_;
  std::vector<Peak> peaks_;
  std::vector<Watched> watched_;
  bool inside_steps_ = false;
};

}  // namespace drev
