#pragma once
/// Largest and smallest value of channels over a run, with their times.
#include <drev/core/channel.hpp>
#include <drev/core/lanes.hpp>
#include <drev/core/law/law_piece.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/run/peak.hpp>

#include <vector>

namespace drev {

class Assembler;
class System;
struct EvaluatedState;
struct PeakSample;

class Peaks final : public Observer {
 public:
  /// inside_steps: true: extremes are found on the motion itself (observer.hpp), to rounding, inside steps as
  /// at their ends, for channels of every kind (peak_search.hpp). false: values at the ends of steps count;
  /// for constant steps that are short beside the accuracy, and to compare with what samples such ends.
  explicit Peaks(std::vector<Channel> channels, bool inside_steps = true);

  bool fits(const System& system) const override { return are_of(system, channels_); }
  void look_through(StepMotion& motion) override { motion_ = &motion; }
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  bool looks_inside(const EvaluatedState& from, const EvaluatedState& to,
                    const double* beyond_cubic) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  void restart(const Assembler& assembler, const EvaluatedState& point) override;
  bool needs_acceleration() const override;
  bool watches_loads() const override;

  const std::vector<Channel>& channels() const { return channels_; }
  const std::vector<Peak>& peaks() const { return peaks_; }
  /// Channel of the largest amplitude.
  std::size_t largest() const;

 private:
  double value(std::size_t c, const Assembler& assembler, const EvaluatedState& point) const;
  double end_value(std::size_t c, const Assembler& assembler, const EvaluatedState& point) const;
  std::optional<double> rate(std::size_t c, const Assembler& assembler, const EvaluatedState& point) const;
  /// y_0, y_1: values at both ends.
  void look_inside(std::size_t c, const Assembler& assembler, const EvaluatedState& from,
                   const EvaluatedState& to, double y_0, double y_1);

  /// Channels of two entries, in whole lanes: a value is the sum over z, its rate that over v. There are many steps and few new
  /// peaks.
  struct Pairs {
    std::vector<std::size_t> channel;
    std::vector<int> first, second;    ///< indices of the entries
    LaneVector coeff_1, coeff_2;       ///< and their coefficients
    LaneVector last, ahead;            ///< values at the last point, and at the step's end
    LaneVector last_rate, ahead_rate;  ///< the same of the rates
    LaneVector max, min;               ///< the peaks so far; infinite where there is no channel
    LaneVector beyond;                 ///< how far the value may come beyond them in the step at hand
    double sum(int i, const double* x) const {
      const auto at = static_cast<std::size_t>(i);
      return coeff_1[at] * x[first[at]] + coeff_2[at] * x[second[at]];
    }
    std::vector<char>
        in_a_row;  ///< by kLanes of them: each index is one more than the one before, as along a chain
    struct Beyond;
  };
  struct Watched {
    int pair = -1;                 ///< its place among the pairs; -1: of another kind
    double last = 0.0;             ///< value at the last point, of another kind
    std::vector<Entry> row;        ///< of the unknowns that the channel of a deflection follows
    double low = 0.0, high = 0.0;  ///< a value between them is no peak, and next to none
  };
  void set_bounds(std::size_t c);
  void add_pair(std::size_t c);
  double& last(std::size_t c) {
    const int pair = watched_[c].pair;
    return pair >= 0 ? pairs_.last[static_cast<std::size_t>(pair)] : watched_[c].last;
  }
  void find_rows(const System& system);
  /// Of a linear channel: its row over the unknowns times x, and its row over their rates times x_dot.
  double along(std::size_t c, const Vector& x, const Vector& x_dot) const;
  /// Whether values between low and high, both off by at most `error`, are within the peaks so far.
  bool within_peaks(std::size_t c, double low, double high, double error) const {
    return high + error <= peaks_[c].max && low - error >= peaks_[c].min;
  }
  /// Whether the value of a channel that is no pair may pass its peaks within a step.
  bool may_pass(std::size_t c, const EvaluatedState& from, const EvaluatedState& to,
                const double* beyond_cubic);
  struct Sought {
    std::size_t channel;
    std::optional<StepMotion::Range> turn;  ///< where it turns; none: it is monotone
  };
  bool can_seek(std::size_t c, bool opposite);
  void seek(const Sought& sought);
  PeakSample look_at(std::size_t c, double t);
  bool pairs_may_pass(const EvaluatedState& from, const EvaluatedState& to, const double* beyond_cubic);

  std::vector<Channel> channels_;
  std::vector<Peak> peaks_;
  std::vector<Watched> watched_;
  Pairs pairs_;
  bool inside_steps_ = true;
  StepMotion* motion_ = nullptr;
  double longest_ = 0.0;  // step so far [s]
  // No value passes its peaks in this step, inside or at its end, but those of sought_.
  bool passed_over_ = false;
  std::vector<Sought> sought_;
  double begin_t_ = 0.0, ahead_t_ = 0.0;  // its start and end [s]
  bool last_rates_ = false;               // the last step was passed over: rates at its end are known
  std::vector<std::size_t> others_;       // channels of other kinds than two entries
};

}  // namespace drev
