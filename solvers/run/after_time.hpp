#pragma once
/// AfterTime: lets observers see a run from a time on, as if it began there.
#include <drev/solvers/run/observer.hpp>

#include <vector>

namespace drev {

/// The observers start at `begin` [s] exactly, which is a stop of the run, and see every step from there on;
/// a run that starts at or after it, they see whole. They outlive this.
class AfterTime final : public Observer {
 public:
  AfterTime(double begin, std::vector<Observer*> observers);
  void restart(const Assembler& assembler, const EvaluatedState& point) override {
    if (!started_) return;
    for (Observer* o : observers_) o->restart(assembler, point);
  }
  void look_through(StepMotion& motion) override {
    for (Observer* o : observers_) o->look_through(motion);
  }
  bool fits(const System& system) const override;
  bool watches_loads() const override;
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  double next_stop(double t) const override;
  bool looks_inside(const EvaluatedState& from, const EvaluatedState& to,
                    const double* beyond_cubic) override;
  bool needs_acceleration() const override;
  bool started() const { return started_; }

 private:
  double begin_;
  std::vector<Observer*> observers_;
  bool started_ = false;
};

}  // namespace drev
