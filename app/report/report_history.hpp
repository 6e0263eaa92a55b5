#pragma once
/// The history of a run that the report keeps, in memory that does not grow with the run:
///
///   groups   of 1, 2, 4, ... consecutive samples, at most kPlaces / channels of them; of each group the
///            first time, and the lowest and the highest value of every channel, so that no peak of the
///            samples is lost. When all places are taken, neighbours are joined, and groups are twice as long
///            from then on.
///   tail     the last samples unchanged, for spectra: at most kTail / channels, and at most 2^17.
///   contacts the time in each group during which a gap is in contact on its front and on its back flank.
///
/// Samples are taken at times k * every, or at every step (every = 0). The channels are followed by kinetic
/// and stored energy [J].
#include <drev/core/assembler.hpp>
#include <drev/solvers/run/channel_values.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <memory>
#include <string>
#include <vector>

namespace drev::app {

class ReportHistory final : public Observer {
 public:
  /// every: sampling interval [s], >= 0; 0: every step, for methods whose steps output times would shorten.
  ReportHistory(const System& system, const std::vector<std::string>& channels, double every);

  void look_through(StepMotion& motion) override { channels_.look_through(motion); }
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  void restart(const Assembler& assembler, const EvaluatedState& point) override {
    channels_.restart(assembler, point);
  }
  bool watches_loads() const override { return channels_.watches_loads(); }
  double next_stop(double t) const override;

  /// One curve: a channel, or an energy.
  struct Series {
    std::string name, unit;
    std::vector<float> low, high;  ///< lowest and highest value in each group
    std::vector<double> tail;      ///< a ring: see tail_at()
  };
  /// The gap of one element: the times in each group during which its front or its back flank is in contact
  /// [s].
  struct Band {
    std::string element;
    std::vector<float> front, back;
  };

  double every() const { return every_; }
  long samples() const { return samples_; }
  long group() const { return group_; }                        ///< number of samples in a group
  double end() const { return end_; }                          ///< time of the last sample [s]
  const std::vector<double>& times() const { return times_; }  ///< first time of each group [s]
  const std::vector<Series>& series() const { return series_; }
  const std::vector<Band>& bands() const { return bands_; }
  std::size_t channel_count() const { return channels_.channels().size(); }

  std::size_t tail_size() const { return tail_times_.size(); }
  /// Sample i of the tail, the oldest first.
  double tail_time(std::size_t i) const { return tail_times_[tail_place(i)]; }
  double tail_value(std::size_t series, std::size_t i) const { return series_[series].tail[tail_place(i)]; }
  /// Absolute mean speed of the reference shaft [rad/s], nominal speed and drift, over the tail from t =
  /// `from` on; 0 if no shaft turns.
  double mean_speed(double from) const;

 private:
  std::size_t tail_place(std::size_t i) const { return (oldest_ + i) % tail_times_.size(); }
  void sample(const Assembler& assembler, const EvaluatedState& point);
  void open_group(double t);
  void join_neighbours();

  ChannelValues channels_;
  double every_ = 0.0, start_ = 0.0, end_ = 0.0;
  std::size_t places_, tail_places_, oldest_ = 0;
  int drifting_ = -1;  // node of a part that may drift from its nominal speed
  double drifting_ratio_ = 1.0;
  std::vector<double> angle_;  // angle of the reference shaft at each sample of the tail [rad]
  long samples_ = 0, group_ = 1, in_group_ = 0;
  std::vector<double> times_, tail_times_;
  std::vector<Series> series_;
  std::vector<std::size_t> terms_;
  std::vector<Gap> gaps_;
  std::vector<Band> bands_;
  Vector product_;
};

}  // namespace drev::app
