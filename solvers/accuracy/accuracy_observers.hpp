#pragma once
/// What accuracy.cpp watches in each of its runs: peaks, changes of contact with their times, contacts, time
/// averages in batches, samples of one channel; all of them over the span that figures are of. Internal to accuracy.cpp, but for the peaks.
#include <drev/core/assembler.hpp>
#include <drev/solvers/accuracy/accuracy.hpp>
#include <drev/solvers/run/after_time.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/estimate.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <optional>
#include <vector>

namespace drev {

/// Largest |value| over channels.
class PeakWatch final : public Observer {
 public:
  explicit PeakWatch(std::vector<Channel> channels) : peaks_(std::move(channels)) {}
  void look_through(StepMotion& motion) override { peaks_.look_through(motion); }
  bool watches_loads() const override { return peaks_.watches_loads(); }
  bool looks_inside(const EvaluatedState& from, const EvaluatedState& to,
                    const double* beyond_cubic) override {
    return peaks_.looks_inside(from, to, beyond_cubic);
  }
  void start(const Assembler& assembler, const EvaluatedState& point) override {
    peaks_.start(assembler, point);
  }
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override {
    peaks_.step(assembler, from, to);
  }
  void restart(const Assembler& assembler, const EvaluatedState& point) override {
    peaks_.restart(assembler, point);
  }

  bool empty() const { return peaks_.channels().empty(); }
  double value() const { return empty() ? 0.0 : peaks_.peaks()[peaks_.largest()].amplitude(); }
  double time() const { return empty() ? 0.0 : peaks_.peaks()[peaks_.largest()].time(); }
  const Channel& channel() const { return peaks_.channels()[peaks_.largest()]; }

 private:
  Peaks peaks_;
};

/// Time averages in equal batches over [begin, end]; steps end where batches do.
class BatchWatch final : public Observer {
 public:
  BatchWatch(const System& system, std::vector<Channel> channels, double begin, double end, int batches);
  void look_through(StepMotion& motion) override { statistics_.look_through(motion); }
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  double next_stop(double t) const override;

  /// A mean or rms value of each batch, and what its integration over sampled points may be off by.
  struct Integrals {
    std::vector<double> values = {}, errors = {};
    void add(double value, double error) {
      values.push_back(value);
      errors.push_back(error);
    }
    /// The mean over batches; its interval holds the integration's error too.
    Estimate estimate(int batches) const;
  };
  /// Of one contact or channel: a value a batch.
  struct Contact {
    std::string element, unit;  ///< of its force
    std::vector<double> share_separated = {}, impacts_per_second = {}, impact_power = {};
    Integrals mean_force = {}, rms_force = {};
  };
  struct Average {
    std::string channel, unit;
    Integrals mean = {}, rms = {};
  };
  const std::vector<Contact>& contacts() const { return contacts_; }
  const std::vector<Average>& averages() const { return averages_; }

 private:
  void close();
  void begin_batch();

  std::vector<Channel> channels_;
  double begin_, length_;
  int batches_,
      done_ = 0;  // the next stop ends the first stretch, ahead of the batches, or batch done_
  ContactStatistics statistics_;
  /// Of each contact where the batch began.
  struct Begin {
    double time_separated = 0.0, impact_energy = 0.0;
    long impacts = 0;
  };
  std::vector<Begin> before_;
  std::vector<std::size_t> laws_;
  /// Integrals over a batch of a value and of its square, by single intervals and by pairs of them.
  class Sum {
   public:
    void add(double y_0, double r_0, double y_1, double r_1, double h);
    /// Enters mean and rms value over the batch's length, and begins the next batch.
    void close(double length, Integrals& mean, Integrals& rms);

   private:
    struct Pair {
      double value = 0.0, square = 0.0;
      void add(double y_0, double r_0, double y_1, double r_1, double h);
    };
    Pair fine_, coarse_, open_;  // open_: the first interval of a pair
    double y_ = 0.0, r_ = 0.0, h_ = 0.0;
  };
  std::vector<Sum> forces_, values_;
  std::vector<Contact> contacts_;
  std::vector<Average> averages_;
};

inline constexpr int kBatches = 20;

/// Everything watched in one run.
struct Watched {
  /// followed: the channel whose samples and averages are kept; every: s, between its samples.
  Watched(const System& system, const AccuracyOptions& options, const std::string& followed, double every);
  std::vector<Observer*> observers() { return {&span_}; }
  /// Part of the span that is left out of time averages: nothing of one that begins later than the run.
  static double left_out(const AccuracyOptions& options);

  RunSummary summary;
  PeakWatch deflection, torque, mesh;
  ContactEvents edges;
  BatchWatch batches;
  ContactStatistics contacts;
  Recorder recorder;
  double seconds = 0.0;

 private:
  AfterTime span_;
};

}  // namespace drev
