#pragma once
/// Whether constant steps are short enough to see what acts and what moves: judged on the run itself, so that
/// modes that carry no motion do not count.
///
///   loads   sum int |p - line between the ends| dt / sum h max |p|      (Omega h)^2/12 of a sine
///   motion  sqrt( sum h |a_1 - a_0|^2 / sum h (|a_0|^2 + |a_1|^2)/2 )   omega h of a vibration
///
/// in the norms of M^-1 and M, M by its diagonal. Steps that a stop cut to less than a tenth of the longest are
/// left out: a jolt that they follow (a speed that changes within microseconds) has accelerations beside which
/// those of the vibration that it leaves, which the long steps must follow, do not count. The integral is Gauss's, whose three points no period that
/// the step divides hits alike. All of the first steps are looked at, then ever fewer: the run does not notice.
#include <drev/core/assembler.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/run_summary.hpp>

namespace drev {

class CoarseSteps {
 public:
  explicit CoarseSteps(const System& system);
  /// Whether look() wants to see the accepted step at hand, of length h [s]: asked once of each.
  bool due(double h) {
    if (h > longest_) longest_ = h;
    return h >= kCutShort * longest_ && ++steps_ % stride_ == 0;
  }
  /// The step, without kinks of known loads inside; moves the assembler's time.
  void look(Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to, double h);
  /// Adds what was found to the summary's warnings. step: as asked for [s].
  void warn(RunSummary& summary, double step) const;

 private:
  static constexpr double kCutShort = 0.1;

  Vector mass_;  // diagonal
  EvaluatedState inside_;
  Vector off_, largest_;
  long steps_ = 0, stride_ = 1, taken_ = 0;
  double longest_ = 0.0, load_off_ = 0.0, load_size_ = 0.0, change_ = 0.0, size_ = 0.0;
};

}  // namespace drev
