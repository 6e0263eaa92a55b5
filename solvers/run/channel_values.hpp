#pragma once
/// ChannelValues: channels along a run, those that are integrals over it (dissipated_J, work_J) with the others.
///
///   y(t) = integral from the start to t of the channel's integrand (a power)
///
/// by Patterson's nested rules of 3, 7 and 15 points on the motion inside each step (observer.hpp): the first of 7 and 15 whose
/// error is at most kTolerance, else the step is halved. The error of a rule is less than (200 d)^1.5 with the difference d
/// from the rule before. Both are over what has been summed up without signs, to which 1e-9 of the train's kinetic and stored
/// energy at the start is added, since powers of less are rounding. Exact propagation's motion is as exact there as at its
/// ends, so that the integral has the run's own accuracy; elsewhere it is that of the polynomial through both ends of the
/// step. Shown without a motion: trapezoids.
///
/// What holds one hands it look_through(), start(), step() and restart() of its own (observer.hpp).
/// Source: T. N. L. Patterson, The optimum addition of points to quadrature formulae, Math. Comp. 22, 1968 (rules); R. Piessens
/// et al., QUADPACK, Springer, 1983 (error and halving).
#include <drev/core/channel.hpp>
#include <drev/solvers/run/observer.hpp>

#include <vector>

namespace drev {

class ChannelValues {
 public:
  static constexpr double kTolerance = 1e-12;

  explicit ChannelValues(std::vector<Channel> channels);
  const std::vector<Channel>& channels() const { return channels_; }

  void look_through(StepMotion& motion) { motion_ = &motion; }
  void start(const Assembler& assembler, const EvaluatedState& point);
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to);
  void restart(const Assembler& assembler, const EvaluatedState& point);
  /// At the point shown last.
  double value(std::size_t c, const Assembler& assembler, const EvaluatedState& point) const;

  bool needs_acceleration() const;
  /// Where an integrand kinks or jumps with the loads, the points at which they do are to be shown.
  bool watches_loads() const;

 private:
  std::vector<double> integrands(const Assembler& assembler, const EvaluatedState& point) const;
  /// The integrals from t_0 to t_1, halved at most `depth` times, added to sums_.
  void add(double t_0, double t_1, int depth);

  std::vector<Channel> channels_;
  std::vector<std::size_t> integrals_;  // places of the channels that are integrals
  std::vector<int> place_;              // of each channel in integrals_; -1: a function of the state
  std::vector<double> sums_, last_;
  std::vector<double> sizes_;  // sums without signs, and the least part of the train's energy
  StepMotion* motion_ = nullptr;
};

}  // namespace drev
