#pragma once
/// What watches a run: recorder, peaks, contact statistics. An observer sees every accepted step and keeps
/// no more than it needs, so that memory does not grow with the run.
#include <limits>

#include "solvers/step_solver.hpp"

namespace drev {

class Observer {
 public:
  virtual ~Observer() = default;
  /// Once, at the first point.
  virtual void start(const Assembler& assembler, const StepPoint& point) = 0;
  /// After every accepted step; the assembler stands at to's time.
  virtual void step(const Assembler& assembler, const StepPoint& from, const StepPoint& to) = 0;
  /// The next time after t that a step must end at exactly [s].
  virtual double next_stop(double /*t*/) const {
    return std::numeric_limits<double>::infinity();
  }
};

}  // namespace drev
