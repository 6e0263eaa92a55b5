#pragma once
/// What rounding leaves of the torque in stiff elements: it is the stiffness times a small difference of
/// angles, each of which carries a rounding of epsilon |angle|. The errors of the steps add like a random walk,
/// which shakes the stiff mode:
///
///   error = 4 epsilon (k |q_a| + k |q_b|) sqrt(steps)
///
/// four standard deviations of such a walk: an estimate, no bound; methods that damp leave less.
#include <drev/core/channel.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/run/run_summary.hpp>

#include <vector>

namespace drev {

class System;

class StiffTwists final : public Observer {
 public:
  explicit StiffTwists(const System& system);
  /// Whether an element is so stiff that there is anything to watch.
  bool any() const { return !watched_.empty(); }
  void start(const Assembler& assembler, const EvaluatedState& point) override { look(assembler, point); }
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  /// Whether look() wants to see the accepted step at hand: asked once of each, in place of step().
  bool due();
  void look(const Assembler& assembler, const EvaluatedState& point);
  bool needs_acceleration() const override { return false; }
  bool looks_inside(const EvaluatedState&, const EvaluatedState&, const double*) override { return false; }
  /// Adds a warning for the element of which rounding leaves least, and the error of each of which it leaves less than
  /// the digits printed.
  void warn(RunSummary& summary) const;

 private:
  struct Watched {
    Channel channel;
    double largest = 0.0, rounding = 0.0;
  };
  std::vector<Watched> watched_;
  long steps_ = 0, stride_ = 1, taken_ = 0;
};

}  // namespace drev
