#pragma once
/// What watches a run: recorder, peaks, contact statistics. An observer sees every accepted step and keeps
/// no more than it needs, so that memory does not grow with the run.
#include <limits>
#include <optional>
#include <vector>

namespace drev {

class Assembler;
class System;
struct Entry;
struct EvaluatedState;

/// The motion inside the step, or part of one, that observers are being shown.
class StepMotion {
 public:
  virtual ~StepMotion() = default;
  struct Point {
    const Assembler& assembler;  ///< stands at the point's time
    /// Its motion, with accelerations if some observer needs them, and the laws' inputs and responses.
    const EvaluatedState& at;
  };
  /// At a time [s] between the two points that step() was given; valid until the next call. To the accuracy
  /// of the step's end in exact propagation; elsewhere on the polynomial through both ends of the step.
  virtual Point at(double t) = 0;
  /// Where a law (of System::scalars()) that has a gap is between the two points: 1 on the flank above it, 0 in
  /// the gap, -1 below; none where the method does not end its steps at changes.
  virtual std::optional<int> side(int /*law*/) const { return std::nullopt; }
  /// The smallest and the largest value of something between the two points that looks_inside() was given, both off by at most
  /// `error`; how often it turns round between them, about where it last does, as a part of the time between them, and its second
  /// derivative by that part there. None where that costs as much as to show the points inside; where it is given, at() holds
  /// anywhere between those two points until the next ones are shown.
  struct Range {
    double low = 0.0, high = 0.0, error = 0.0;
    int turns = 0;
    double turn = 0.0, bend = 0.0;
  };
  /// Of the force of a law (of System::scalars()) [N or N m].
  virtual std::optional<Range> force_range(int /*law*/) { return std::nullopt; }
  /// At less cost, an interval that this force stays in, with no more told of it; none where it is not known to be r (y_0 + k x) of a
  /// deflection x that unknowns alone move, with r constant or straight along an angle, or the law has no gap.
  virtual std::optional<Range> force_reach(int /*law*/) { return std::nullopt; }
  /// Of what dry friction keeps at a place of State::history; none where that is no torque or force.
  virtual std::optional<Range> friction_range(int /*place*/) const { return std::nullopt; }
  /// Of a sum over unknowns, z [rad or m], and over their rates, v [rad/s or m/s].
  virtual std::optional<Range> range(const std::vector<Entry>& /*z*/, const std::vector<Entry>& /*v*/) {
    return std::nullopt;
  }
};

class Observer {
 public:
  virtual ~Observer() = default;
  /// Whether it may watch a run of this system: what is made of one system's channels or laws fits no other.
  virtual bool fits(const System& /*system*/) const { return true; }
  /// Once, before start(): where to look inside steps. It may be asked in step() alone. An observer that holds
  /// others hands it on.
  virtual void look_through(StepMotion& /*motion*/) {}
  /// Once, at the first point.
  virtual void start(const Assembler& assembler, const EvaluatedState& point) = 0;
  /// After every accepted step, or part of one; the assembler stands at to's time.
  virtual void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) = 0;
  /// Behind a jump of loads or known motions, at the time where the last step ended: the point with the forces
  /// that hold from there on. The next step starts from it. An observer that holds others hands it on.
  virtual void restart(const Assembler& /*assembler*/, const EvaluatedState& /*point*/) {}
  /// The next time after t that must be seen exactly [s]: constant steps end there, controlled ones are
  /// interpolated to the method's order.
  virtual double next_stop(double /*t*/) const { return std::numeric_limits<double>::infinity(); }
  /// Whether it reads accelerations, or loads and forces of the whole system (p, kz, cv, total). Where no
  /// observer does, points inside a step of exact propagation have none: a is not a number there.
  virtual bool needs_acceleration() const { return true; }
  /// Asked before exact propagation shows a step: whether it wants points inside, close enough for cubics between them;
  /// where no observer does, the step is shown whole except for next_stop(). beyond_cubic: of each unknown, how far it
  /// lies at most from the cubic through its values and rates at both ends [rad or m]; behind them the same of each rate.
  virtual bool looks_inside(const EvaluatedState& /*from*/, const EvaluatedState& /*to*/,
                            const double* /*beyond_cubic*/) {
    return true;
  }
  /// Whether it watches what kinks where a load does (loads, accelerations, reactions, ideal gears): exact
  /// propagation then shows it the points at which tables' kinks are passed.
  virtual bool watches_loads() const { return false; }
};

}  // namespace drev
