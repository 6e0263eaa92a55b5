#include "solvers/exact/step_expansion.hpp"

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

constexpr double kShorten = 0.9;        // of the step at which the loads' rest is just small enough
constexpr double kLoosest = 1e-3;       // tolerance of a pass that is not the last
constexpr double kPassesAgree = 1e-15;  // of the motion: rounding of what is projected
constexpr double kInside = 0.01;        // of the tolerance: what the motion inside the step may be off by
constexpr double kTorqueRest = 1e-10;   // of the forces on a train that friction holds
constexpr double kJump = 1e-4;          // of the tolerance: error allowed per undeclared discontinuity
constexpr double kBehindKnot = 1e-3;    // of the step to it: behind the last node of Gauss' rule
constexpr double kBeforeEnd = 0.98;     // of the step: a knot that its nodes see
constexpr double kNearStart = 1e-8;     // of the step
constexpr int kMaxPasses = 20;          // of projected loads

}  // namespace

StepExpansion::Attempt StepExpansion::attempt(const EvaluatedState& from, const LawSeries& laws, double h,
                                              const Limits& limits) {
  const double share = limits.share;
  series.reset();
  known.add_to(series, h);
  laws.add_to(series, known, h);
  if (!friction.empty()) friction.add_to(series, known, from.state.t, h);
  const double rest = offsets.expand(series, from.state.t, h);
  smooth.add_to(series, from, h);
  expanded.add_to(series, laws, known, offsets, from, h);
  if (rest > share && h > limits.shortest)
    return {h * std::max(0.3, kShorten * std::pow(share / rest, 1.0 / GaussRule::kNodes))};
  // Loads and smooth laws can be stiffer than what bounded the largest step.
  const double steepest = 1.5 * kFastestTimesStep / series.rate();
  if (h > steepest) return {steepest};
  bool settled = false;
  const bool projects = known.projects() || !smooth.empty();
  // Each pass needs to be no better than the next one takes up of it.
  double tolerance = projects ? std::clamp(share / contraction_, share, kLoosest) : share;
  for (int pass = 0;; ++pass) {
    const bool last = !projects || settled;
    const double got = series.expand(from.state.z, from.state.v, h, last ? share : tolerance);
    if (expanded.turns_back(series)) return {h, true};
    if (got < h || last) return {got};
    if (pass == kMaxPasses) return {0.5 * h};
    const LoadSeries::Pass made = known.project(series, smooth, pass == 0, friction.holds());
    const double excess = std::max({made.residual / std::max(share, kJump * limits.tolerance),
                                    made.inside / (kInside * limits.tolerance), made.torque / kTorqueRest});
    if (excess > 1.0 && h > limits.shortest) {
      // Nearly always a law's knot in the step: a step to just behind it, which is then cut there.
      const auto knot = smooth.first_knot(series, kBeforeEnd);
      if (knot && *knot > kNearStart) return {h * *knot * (1.0 + kBehindKnot), true};
      return {h * std::max(0.2, kShorten * std::pow(excess, -1.0 / kProjectionTerms))};
    }
    if (made.cut && h > limits.shortest) return {h * *made.cut, true};
    contraction_ = std::max(made.contraction, 1e-300);
    // What this pass was off by comes back in the next one times the contraction factor.
    settled = std::max(made.change, tolerance) * made.contraction <= std::max(share, kPassesAgree);
    tolerance = std::clamp(0.5 * share / contraction_, share, kLoosest);
  }
}

std::optional<double> StepExpansion::first_knot(double end) {
  std::optional<double> first;
  const auto take = [&](auto& laws) {
    const auto knot = laws.first_knot(series, end);
    if (!knot) return;
    first = knot;
    end = *knot;
    knot_clearance_ = laws.knot_clearance();
  };
  take(smooth);
  take(expanded);
  return first;
}

bool StepExpansion::expand_part(const StepExpansion& other, const EvaluatedState& from, const LawSeries& laws,
                                double s, const Limits& limits) {
  known.locate_as(other.known);
  const double h = s * other.series.step();
  contraction_ = other.contraction_;
  series.scale_as(other.series);
  friction.locate_as(other.friction);
  expanded.locate_as(other.expanded);
  const Attempt made = attempt(from, laws, h, {limits.share, limits.tolerance, h});
  if (made.to_knot || made.h != h) return false;
  friction.expand(series, from.state);
  return true;
}

}  // namespace drev
