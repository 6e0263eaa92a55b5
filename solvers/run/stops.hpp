#pragma once
/// Where the steps of a run end: breakpoints of loads and known motions, communication points of sampled controllers,
/// times that observers ask for, and the end of the run. Stops that differ by rounding are one.
#include <drev/core/system.hpp>
#include <drev/solvers/run/observer.hpp>

#include <vector>

namespace drev {

class ControlRun;

struct Stop {
  double t = 0.0;         ///< s
  bool at_break = false;  ///< loads and known motions may jump here
  double width = 0.0;     ///< s, at a break: it lies within this time before t
  /// Time at which a step that ends here evaluates its end [s]: just before a breakpoint, loads have their
  /// old values.
  double evaluation_time() const;
};

/// Of a step: stops of constant steps this close together are one.
inline constexpr double kSameStop = 1e-9;

class Stops {
 public:
  /// same >= 0: stops within this time of each other are one [s]. observers: whose times are stops, too; they
  /// outlive this. controls: whose communication points are breaks, too; null: none.
  Stops(const System& system, double t_end, double same, std::vector<Observer*> observers = {},
        const ControlRun* controls = nullptr);
  /// The first stop after t.
  Stop after(double t) const;

 private:
  const System& system_;
  double t_end_, same_;
  std::vector<Observer*> observers_;
  const ControlRun* controls_;
};

/// A span of time in steps of equal length, of the length asked for or (except for rounding) less.
struct EvenSteps {
  /// begin < end, longest > 0 [s].
  EvenSteps(double begin, double end, double longest);
  /// Where step i of 1 ... count ends [s].
  double end_of(double i) const { return i == count ? end : begin + i * h; }

  double begin, end;
  double count;  ///< a whole number
  double h;      ///< s
};

}  // namespace drev
