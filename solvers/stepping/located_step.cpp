#include "solvers/stepping/located_step.hpp"

#include <cmath>
#include <limits>

namespace drev {

namespace {
constexpr double kLanding = 1e-6;    // distance from a change within which a step ends at it, over the step
constexpr double kLeastHop = 1e-12;  // least hop over the step: a run that starts on a bound leaves it, too
constexpr int kMaxTries = 30;
constexpr int kMaxHops = 10;
constexpr double kBeyond = 1e-6, kFarther = 8.0;  // first part of a hop added where it falls short; growth
}  // namespace

LocatedStep::Result LocatedStep::step(const EvaluatedState& from, double h, double t_new, double t_evaluate,
                                      EvaluatedState& to) {
  const double landing = kLanding * h;
  Assembler& assembler = stepper_.equation().assembler();
  const int degree = StepPolynomial::degree_for(stepper_.equation().scheme());
  Result result;
  std::optional<ContactLocator::Crossing> target;
  double low = 0.0, high = h, length = h;  // no crossing up to low, one before high
  for (int i = 0; i < kMaxTries; ++i) {
    const bool whole = length == h;
    const double t = whole ? t_new : from.state.t + length;
    const NewtonResult newton = stepper_.step(from, length, t, whole ? t_evaluate : t, to);
    result.newton.iterations += newton.iterations;
    result.newton.status = newton.status;
    result.h = length;
    double next = 0.0;
    if (newton.status != NewtonStatus::converged) {
      // A force that jumps: the crossing is where the motion so far leads.
      if (newton.status != NewtonStatus::no_root) return result;
      target = locator_.predict(from, length);
      if (!target) return result;
      high = length;
      next = target->s * length;
    } else {
      const StepPolynomial motion(from.state, to.state, length, degree);
      const auto crossing = locator_.first(motion, from, to, assembler);
      assembler.set_time(whole ? t_evaluate : t);
      if (crossing) {
        target = crossing;
        high = length;
        next = crossing->s * length;
      } else {
        if (!target) return result;
        low = length;
        const auto [distance, rate] = locator_.distance(*target, to);
        const double left = rate < 0.0 ? std::max(distance, 0.0) / -rate : high - low;
        if (left <= landing || high - low <= landing) {
          result.reached = target;
          result.tau = std::max(std::min(left, high - low), kLeastHop * h);
          return result;
        }
        next = low + left;
      }
    }
    if (next <= landing) {  // at hand
      result.newton.status = NewtonStatus::converged;
      result.h = 0.0;
      result.reached = target;
      result.tau = std::max(next, kLeastHop * h);
      return result;
    }
    next -= 0.5 * landing;
    length = next > low && next < high ? next : 0.5 * (low + high);
  }
  return result;
}

double LocatedStep::hop(const ContactLocator::Crossing& crossing, double tau, const EvaluatedState& from,
                        EvaluatedState& to) {
  // Behind a jump the Taylor series is wrong: little is added at first.
  double more = std::max(4 * std::numeric_limits<double>::epsilon() * std::abs(from.state.t), kBeyond * tau);
  const State& s = from.state;
  for (int i = 0;; ++i) {
    to.state.t = s.t + tau;
    to.state.z = s.z + tau * s.v + (0.5 * tau * tau) * s.a;
    to.state.v = s.v + tau * s.a;
    to.state.a = s.a;
    to.state.history = s.history;
    stepper_.start(to);
    if (locator_.distance(crossing, to).first < 0.0 || i == kMaxHops) return tau;
    tau += more;
    more *= kFarther;
  }
}

}  // namespace drev
