#pragma once
/// SampledController: torques on nodes that a controller computes at its communication points t_k = t_0 + k h, where
/// t_0 is the start of the run. Between them the torque of output j is known, so that a run propagates it as any load:
///
///   zero order    tau_j(t) = y_j(t_k)                                          t_k <= t < t_{k+1}
///   first order   tau_j(t) = y_j(t_k) + (y_j(t_k) - y_j(t_{k-1})) (t - t_k)/h   (zero order over the first step)
///
/// on the RIGHT side of the equation of motion. The controller is asked in sequence with the train: at t_k it goes from
/// t_{k-1} to t_k with the inputs of both points, and what it gives then acts from t_k on. Inputs are signals (signal.hpp)
/// ahead of what jumps at t_k. What is held is the only error of the coupling.
///
/// One run at a time: what the controller holds belongs to the run that opened it. Methods that know no run (modes,
/// sweeps, periodic and static solutions) refuse a system that has one.
#include <drev/core/control/controllers.hpp>
#include <drev/core/element_interface.hpp>
#include <drev/core/load.hpp>

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drev {

/// Between communication points.
enum class Hold { zero_order, first_order };

/// A controller's part of one run; what it throws ends the run.
class ControlSession {
 public:
  virtual ~ControlSession() = default;
  /// At the start of the run: inputs there [units of the signals], outputs [N m or N].
  virtual void start(std::span<const double> inputs, std::span<double> outputs) = 0;
  /// From time t over the communication step h [s], with the inputs at both ends; outputs at t + h.
  virtual void step(double t, double h, std::span<const double> before, std::span<const double> inputs,
                    std::span<double> outputs) = 0;
  /// What it has to say although it went on, a sentence without full stop, which becomes a warning of the run.
  virtual std::string warning() const { return {}; }
};

class SampledController : public Element {
 public:
  /// h [s], > 0; outputs >= 1, one a node.
  SampledController(double step, Hold hold, std::size_t outputs);

  double step() const { return step_; }
  Hold hold() const { return hold_; }
  std::size_t output_count() const { return held_.size(); }
  /// Names of the signals that it reads.
  virtual std::vector<std::string> inputs() const = 0;
  /// Begins a run from t_start to t_end [s]; the controller outlives the session.
  virtual std::unique_ptr<ControlSession> open(double t_start, double t_end) const = 0;

  int min_nodes() const override { return static_cast<int>(held_.size()); }
  /// step(); those that override it call this, too.
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

  /// Takes it for one run; false: another run has it. release() gives it back, with torques of zero.
  bool acquire() const { return !taken_.exchange(true); }
  void release() const;
  /// What acts from t on: value + slope (t' - t).
  void set(std::size_t output, double t, double value, double slope) const;

 private:
  class Held final : public Load {
   public:
    LoadResponse evaluate(const LoadInput& in) const override { return {.torque = at(in.t)}; }
    bool depends_on_motion() const override { return false; }
    std::optional<LoadStretch> stretch(double t, double /*angle*/, double /*direction*/) const override {
      return LoadStretch{.torque = at(t), .time_slope = slope};
    }
    double at(double t) const { return value + slope * (t - t_0); }
    double t_0 = 0.0, value = 0.0, slope = 0.0;
  };

  double step_;
  Hold hold_;
  std::vector<std::unique_ptr<Held>> held_;
  mutable std::atomic<bool> taken_ = false;
};

}  // namespace drev
