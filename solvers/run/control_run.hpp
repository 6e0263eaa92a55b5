#pragma once
/// ControlRun: the sampled controllers of a system in one run (sampled_controller.hpp): when they are asked, what they
/// see, and what acts from then on.
#include <memory>
#include <vector>

#include "core/control/signal.hpp"

namespace drev {

class ControlSession;
class SampledController;
struct RunSummary;

class ControlRun {
 public:
  /// Takes the system's controllers until it ends. Throws SolverError where another run has one of them. The system
  /// outlives it.
  ControlRun(const System& system, double t_start, double t_end);
  ~ControlRun();
  ControlRun(const ControlRun&) = delete;
  ControlRun& operator=(const ControlRun&) = delete;

  bool empty() const { return all_.empty(); }
  /// At the start of the run; the assembler stands there. Then the state's accelerations are to be found again.
  void start(const Assembler& assembler, const State& state);
  /// The next communication point after t [s]; infinite if there is none.
  double next_stop(double t) const;
  /// Asks the controllers whose communication point the state's time is; the assembler stands ahead of it. Throws
  /// SolverError with time and controller.
  void sample(const Assembler& assembler, const State& state);
  /// Adds what the controllers warn of.
  void warn(RunSummary& summary) const;

 private:
  struct Controlled {
    std::string name;
    const SampledController* controller = nullptr;
    std::vector<Signal> signals;
    std::shared_ptr<ControlSession> session = {};
    double points = 0.0;  ///< asked so far, without the first
    std::vector<double> inputs = {}, outputs = {};
  };
  double point(const Controlled& c, double number) const;
  void ask(Controlled& c, const Assembler& assembler, const State& state, bool first);

  const System& system_;
  double t_start_, t_end_;
  std::vector<Controlled> all_;
};

}  // namespace drev
