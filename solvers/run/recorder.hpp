#pragma once
/// Keeps chosen channels at chosen times k * every, from the start on, and at no other. Constant steps are
/// cut so that they end there; controlled steps and exact propagation show their polynomial there. Channels that are
/// integrals over the run are taken, too (channel_values.hpp).
#include <drev/solvers/run/channel_values.hpp>

#include <functional>
#include <string>
#include <vector>

namespace drev {

class Assembler;
struct EvaluatedState;

class Recorder final : public Observer {
 public:
  /// channels: as find_channels() takes them; every > 0 [s]. Throws ModelError for unknown channels or a bad interval.
  Recorder(const System& system, const std::vector<std::string>& channels, double every);

  /// Instead of keeping rows in memory, hands each to the sink (to write it out).
  void set_sink(std::function<void(double t, const std::vector<double>& row)> sink) {
    sink_ = std::move(sink);
  }

  bool fits(const System& system) const override { return are_of(system, channels()); }
  void look_through(StepMotion& motion) override { values_.look_through(motion); }
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  double next_stop(double t) const override;
  void restart(const Assembler& assembler, const EvaluatedState& point) override {
    values_.restart(assembler, point);
  }
  bool looks_inside(const EvaluatedState&, const EvaluatedState&, const double*) override {
    return values_.watches_loads();
  }
  bool needs_acceleration() const override { return values_.needs_acceleration(); }
  bool watches_loads() const override { return values_.watches_loads(); }

  const std::vector<Channel>& channels() const { return values_.channels(); }
  const std::vector<double>& times() const { return times_; }
  /// Samples of channel c, one per time.
  const std::vector<double>& samples(std::size_t c) const { return samples_[c]; }

 private:
  void record(const Assembler& assembler, const EvaluatedState& point);

  ChannelValues values_;
  double every_ = 0.0, start_ = 0.0;
  long next_ = 0;
  std::vector<double> times_, row_;
  std::vector<std::vector<double>> samples_;
  std::function<void(double, const std::vector<double>&)> sink_;
};

}  // namespace drev
