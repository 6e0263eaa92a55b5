#include "solvers/exact/step_expansion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solvers/contact/roots.hpp"
#include "solvers/run/cubic_peak.hpp"
#include "solvers/series/series_kernels.hpp"

namespace drev {

namespace {

constexpr double kShorten = 0.9;  // factor on the step at which the rest of the loads is just small enough
constexpr double kOfFirstChange =
    0.03;                          // of what the last step's first pass changed: tolerance of this step's
constexpr double kLoosest = 1e-3;  // tolerance of a pass that is not the last
constexpr double kPassesAgree = 1e-15;  // rounding of what is projected, relative to the motion
constexpr double kInside = 0.01;        // error of the motion inside a step, relative to the tolerance
// Error of a held torque, relative to the forces on a train that friction holds.
constexpr double kTorqueRest = 1e-10;
constexpr double kJump = 1e-4;  // error allowed per undeclared discontinuity, relative to the tolerance
// How far behind a knot a step ends, relative to the step to it: behind the last node of Gauss's rule.
constexpr double kBehindKnot = 1e-3;
constexpr double kBeforeEnd = 0.98;  // last place in a step at which the nodes of Gauss's rule see a knot
// Longest step of a motion that loads and smooth laws make faster, over the run's longest.
constexpr double kSteepest = 1.125;
constexpr double kNearStart = 1e-8;  // a knot so close to the start does not end a step, relative to the step
constexpr int kMostNewton = 10;
constexpr double kAlong = 1e-9;  // error of points on the way of a swept step, relative to the motion
// A place is settled, relative to the step; rounding of a time, relative to the time.
constexpr double kAtChange = 1e-12, kRoundingOfTime = 4e-16;
constexpr double kPathRounding = 1e-14;  // of the motion: rounding of the forces along two paths
constexpr int kMostLooks = 4;            // at the forces along a path that had settled
constexpr int kMaxPasses = 20;           // passes of projected loads in one step
// Terms of a law's scale, relative to the scale, that its force's range leaves out; how many there are at most.
constexpr double kOfScale = 1e-9, kMostDropped = TaylorSeries::kMaxDegree;
// How far a kink's response, between s^3 and s^7 from somewhere on, lies from the cubic through its ends: of y and y' there,
// twice the most.
constexpr double kOfKinks = 0.5, kOfKinkRates = 0.12;
// omega h of the fastest mode between two points inside a step that observers are shown; the same as points a degree of a
// series whose last term is below 1e-8 of its largest: it turns through a fifth of its degree in rad at most.
constexpr double kWatchedAngle = 0.3, kWatchedPerDegree = 0.5;

using Terms = std::vector<double>;

/// Lanes of places that a series asks for beyond the two of a step of the modes, whose terms are `enough` at most.
std::size_t more_lanes(const Terms& series, std::size_t enough) {
  return series.size() <= enough ? 0 : (series.size() - enough + kLanes - 1) / kLanes;
}
constexpr std::size_t kEnoughTerms = 25, kEnoughOfScale = 13;

/// The range of scale x + more in [0, end], a step of series; its turn as a part of that. Without terms scale is 1, more is 0.
StepMotion::Range range_of(const Terms& x, const Terms& scale, const Terms& more, double end) {
  constexpr std::size_t kMost = kLanes * (2 + 2 * (TaylorSeries::kMaxDegree / kLanes));
  // omega h <= 0.35 between two places
  const std::size_t parts = kLanes * (2 + more_lanes(x, kEnoughTerms) + more_lanes(scale, kEnoughOfScale));
  using Values = std::array<double, kMost + 1>;
  Values s, value, slope;
  const double part = end / static_cast<double>(parts);
  for (std::size_t i = 0; i <= parts; ++i) s[i] = part * static_cast<double>(i);
  const auto evaluate = [&s, parts](const Terms& of, Values& y, Values& rate) {
    y[0] = of[0];
    rate[0] = of.size() > 1 ? of[1] : 0.0;
    polynomial_values(static_cast<int>(parts), static_cast<int>(of.size()), of.data(), &s[1], &y[1],
                      &rate[1]);
  };
  evaluate(x, value, slope);
  Values r, r_slope;
  if (!scale.empty()) {
    evaluate(scale, r, r_slope);
    for (std::size_t i = 0; i <= parts; ++i) {
      slope[i] = r[i] * slope[i] + r_slope[i] * value[i];
      value[i] *= r[i];
    }
  }
  if (!more.empty()) {
    evaluate(more, r, r_slope);
    for (std::size_t i = 0; i <= parts; ++i) {
      value[i] += r[i];
      slope[i] += r_slope[i];
    }
  }
  const auto scale_at = [&scale](double at) { return scale.empty() ? 1.0 : polynomial_value(scale, at); };
  struct Place {
    double s, y, slope;
  };
  const auto value_at = [&](double at) {
    return scale_at(at) * polynomial_value(x, at) + polynomial_value(more, at);
  };
  const auto slope_at = [&](double at) {
    return scale_at(at) * polynomial_slope(x, at) + polynomial_slope(scale, at) * polynomial_value(x, at) +
           polynomial_slope(more, at);
  };
  StepMotion::Range range{value[0], value[0]};
  const auto take = [&range](double y) {
    range.low = std::min(range.low, y);
    range.high = std::max(range.high, y);
  };
  const auto take_turn = [&](const Place& a, const Place& b) {
    const auto inside = cubic_peak(a.y, a.slope, b.y, b.slope, b.s - a.s);
    if (!inside) return;
    const double turn = a.s + (b.s - a.s) * inside->s;
    take(value_at(turn));
    ++range.turns;
    range.turn = turn / end;
  };
  for (std::size_t i = 1; i <= parts; ++i) {
    take(value[i]);
    if (cubic_is_monotone(value[i - 1], slope[i - 1], value[i], slope[i], part)) continue;
    const Place a{s[i - 1], value[i - 1], slope[i - 1]}, b{s[i], value[i], slope[i]};
    if (const auto dip = cubic_dip(a.y, a.slope, b.y, b.slope, part)) {
      const double at = a.s + part * *dip;
      const Place between{at, value_at(at), slope_at(at)};
      take_turn(a, between);
      take_turn(between, b);
    } else {
      take_turn(a, b);
    }
  }
  if (range.turns > 0) {
    const double at = end * range.turn;
    range.bend = scale_at(at) * polynomial_curvature(x, at) + polynomial_curvature(more, at);
    if (!scale.empty())
      range.bend += 2.0 * polynomial_slope(scale, at) * polynomial_slope(x, at) +
                    polynomial_curvature(scale, at) * polynomial_value(x, at);
    range.bend *= end * end;
  }
  return range;
}

}  // namespace

/// The step without passes: only kinks of tables change its forces. False: it wants passes.
bool StepExpansion::attempt_sweep(const EvaluatedState& from, const LawSeries& laws, double h,
                                  const Limits& limits, Attempt& made) {
  sweeps_ = expanded_ = false;
  share_ = limits.share;
  if (refused_ || !known.kinks_alone() || !smooth.empty() || (!expanded.empty() && !expanded.sweeps()) ||
      !friction.empty() || !series.sweeps() || !offsets.none() || !laws.lossless())
    return false;
  made.h = series.expand(from.state.z, from.state.v, h, limits.share);
  if (made.h < h) return true;
  made.again = expanded.turns_back(series) || known.came_further(series);
  if (made.again) return true;
  sweeps_ = kinks.look(limits.share);
  expanded_ = !sweeps_;
  return sweeps_;
}

bool StepExpansion::evaluate(double s, Vector& z, Vector& v, bool exactly) {
  const bool at_hand = sweeps_ && kinks.found() && kinks.end() == s;
  series.evaluate(s, z, v, at_hand && kinks.any());
  if (!sweeps_ || at_hand) return true;
  const bool found = kinks.find(s, z.data(), exactly ? share_ : std::max(share_, kAlong));
  if (found && kinks.any()) series.add_swept(z, v);
  return found;
}

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
  if (known.part_held() < 1.0) return {h * known.part_held(), true};
  // Loads and smooth laws can be stiffer than what bounded the largest step.
  const double steepest = kSteepest * StepLength::longest_angle(limits.tolerance) / series.rate();
  if (h > steepest) return {steepest};
  if (Attempt made; attempt_sweep(from, laws, h, limits, made)) return made;
  bool settled = false, sure = false;
  int looks = 0;
  const bool projects = known.projects() || !smooth.empty();
  if (projects && h > limits.longest) return {limits.longest, true};
  const double loosest = std::max(share, kLoosest);  // a short run's share of a large tolerance may be more
  // Each pass needs to be no better than the next one takes up of it.
  // Nor better than what the first one is about to change.
  double tolerance =
      projects ? std::clamp(std::max(share / contraction_, kOfFirstChange * first_change_), share, loosest)
               : share;
  if (expanded_) tolerance = share;
  double excess = 0.0;
  bool tells_length = false;  // excess grows with the step's length as that of smooth forces does
  const auto fitting = [&excess] { return kShorten * std::pow(excess, -1.0 / kProjectionTerms); };
  for (int pass = 0;; ++pass) {
    const bool last = !projects || settled;
    // A sweep that was given up leaves the first one.
    const double got =
        pass == 0 && expanded_ ? h : series.expand(from.state.z, from.state.v, h, last ? share : tolerance);
    if (got == h && (expanded.turns_back(series) || known.came_further(series))) return {h, true};
    const double of_jump = std::max(share, kJump * limits.tolerance);
    const auto as_got = [&] {
      return Attempt{.h = got,
                     .longer = tells_length ? fitting() : StepLength::kUnlimited,
                     .stands = got > 0.0 && shortens()};
    };
    // What leaves too much: a shorter step.
    const auto shorten = [&]() -> Attempt {
      if (const auto longer = known.find_rounding(smooth)) return {*longer, true};
      // Nearly always a law's knot in the step: a step to just behind it, which is then cut there.
      const auto knot = smooth.first_knot(series, kBeforeEnd);
      if (knot && *knot > kNearStart) return {h * *knot * (1.0 + kBehindKnot), true};
      return {h * std::max(0.2, fitting())};
    };
    const auto done = [&]() -> Attempt {
      if (projects && h > limits.shortest) {
        const double between = known.unseen_between(series, smooth, friction.holds(), of_jump) / of_jump;
        if (between > 1.0) {
          excess = between;
          return shorten();
        }
      }
      return as_got();
    };
    if (got < h || !projects) return as_got();
    if (last && sure) return done();
    if (pass == kMaxPasses) return {0.5 * h};
    const LoadSeries::Pass made =
        known.project(series, smooth, pass == 0, friction.holds(), friction.carried());
    const double unseen = made.unseen / of_jump;
    excess = std::max({made.residual / of_jump, unseen, made.inside / (kInside * limits.tolerance),
                       made.torque / kTorqueRest});
    tells_length = excess > unseen && excess <= 1.0;
    if (made.cut && h > limits.shortest) return {h * *made.cut, true};
    if (excess > 1.0 && h > limits.shortest) return shorten();
    const double seen = std::max(share, kPathRounding);
    if (last && made.change <= seen) return done();
    if (last && ++looks == kMostLooks) {
      // What is left is rounding, or the path goes to and fro beside a kink.
      if (made.change <= of_jump || h <= limits.shortest) return done();
      return {0.5 * h};
    }
    contraction_ = std::max(made.contraction, 1e-300);
    if (pass == 0) first_change_ = made.change;
    // The factor is that of this pass's path: the next one may lead over a kink from which this one kept clear, so that the
    // forces are looked at there once more. Kinks are projected, and off inside the step: with them the second pass looks.
    const bool doubtful = made.follows && made.change > seen;
    sure = !doubtful || known.kinked();
    // The error of this pass comes back in the next one times the contraction factor.
    settled = std::max(made.change, tolerance) * made.contraction <= std::max(share, kPassesAgree) &&
              !(doubtful && known.kinked() && pass == 0);
    tolerance = std::clamp(0.5 * share / contraction_, share, loosest);
  }
}

double StepExpansion::parts_to_watch(double angle, double s) const {
  const double least = known.projected() ? kProjectionDegree : 1.0;  // projected forces swing faster
  return std::ceil(std::max({least, angle / kWatchedAngle, kWatchedPerDegree * series.degree() * s}));
}

const double* StepExpansion::beyond_cubic(double s, bool jumps) {
  const int n = series.size(), stride = series.stride();
  // Room for rates of `stride` each, which are moved to behind the n unknowns then.
  beyond_cubic_.resize(idx(2 * stride));
  series.beyond_cubic(s, beyond_cubic_.data());
  if (sweeps_ && kinks.any()) {
    const std::array<double, 4> of_y_and_rate{kOfKinks, 0.0, kOfKinkRates,
                                              10.0 * kOfKinkRates / series.step()};
    weighted_sums(stride, 0, 2, 2, of_y_and_rate.data(), 2, nullptr, series.swept(0), beyond_cubic_.data(),
                  true);
  }
  if (stride != n) std::copy_n(beyond_cubic_.data() + stride, n, beyond_cubic_.data() + n);
  if (!sweeps_ && known.kinked())
    for (int i = 0; i < n; ++i) {
      beyond_cubic_[idx(i)] += known.kinks_inside() * series.z_scale()[idx(series.kind(i))];
      beyond_cubic_[idx(n + i)] += known.kinks_inside() * series.v_scale()[idx(series.kind(i))];
    }
  if (jumps) std::fill_n(beyond_cubic_.data() + n, n, std::numeric_limits<double>::infinity());
  return beyond_cubic_.data();
}

StepExpansion::Inside StepExpansion::left_by_kinks(std::span<const Entry> row) const {
  Inside left;
  if (sweeps_ && kinks.any())
    for (const Entry& e : row) {
      // From zero at rest, the cubic stays within |y_1| + 4/27 |y'_1|, its rate within 3/2 |y_1| + |y'_1|.
      const double y = std::abs(e.coeff * series.swept(0)[e.index]),
                   rate = std::abs(e.coeff * series.swept(-1)[e.index]);
      left.value += (1.0 + kOfKinks) * y + (kCubicBulge + kOfKinkRates) * rate;
      left.rate += 1.5 * y + (1.0 + 10.0 * kOfKinkRates) * rate;
    }
  else if (!sweeps_ && known.kinked())
    for (const Entry& e : row) {
      const auto kind = idx(series.kind(e.index));
      left.value += std::abs(e.coeff) * known.kinks_inside() * series.z_scale()[kind];
      left.rate += std::abs(e.coeff) * known.kinks_inside() * series.step() * series.v_scale()[kind];
    }
  return left;
}

std::optional<StepMotion::Range> StepExpansion::find_force_range(const LawSeries& laws, int law, double s) {
  const LawPiece* p = laws.force_piece(law);
  if (p == nullptr) return std::nullopt;
  const std::vector<double>& x = laws.deflection(law);
  const double per_time = 1.0 / series.step();
  // r (y_0 + k x) + (c + g x) x', as series; sizes: bounds of r, x and x' by s.
  scale_.clear();
  ranged_.resize(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) ranged_[k] = p->k * x[k];
  ranged_[0] += p->y_0;
  double of_r = 1.0, of_x = 0.0, of_rate = 0.0, elastic = 0.0;
  for (const double term : ranged_) elastic += std::abs(term);
  if (elastic != 0.0 && expanded.scale_of(law, series, scale_)) {
    while (scale_.size() > 1 && std::abs(scale_.back()) <= kOfScale * std::abs(scale_[0])) scale_.pop_back();
    of_r = 0.0;
    for (const double term : scale_) of_r += std::abs(term);
  }
  Terms damped;
  if (p->c != 0.0 || p->product != 0.0) {
    for (std::size_t k = 0; k < x.size(); ++k) {
      of_x += std::abs(x[k]);
      of_rate += static_cast<double>(k) * std::abs(x[k]);
    }
    damped.assign(x.begin(), x.end());
    for (double& term : damped) term *= 0.5 * p->product;
    damped[0] += p->c;
    multiply_polynomial(x, damped);  // its rate is (c + g x) x'
    for (std::size_t k = 1; k < damped.size(); ++k)
      damped[k - 1] = static_cast<double>(k) * per_time * damped[k];
    if (damped.size() > 1) damped.pop_back();
  }
  StepMotion::Range range = range_of(ranged_, scale_, damped, s);
  const Inside left = left_by_kinks(system_.scalars()[idx(law)].z);
  const ExpandedLaws::Turning turning = expanded.turning(law);
  const double damping = std::abs(p->c) + std::abs(p->product) * (of_x + left.value);
  range.error = of_r * std::abs(p->k) * left.value +
                per_time * (damping * left.rate + std::abs(p->product) * of_rate * left.value) +
                (turning.steepest * left_by_kinks(turning.row).value + kOfScale * kMostDropped) * elastic;
  return range;
}

std::optional<StepMotion::Range> StepExpansion::find_force_reach(const LawSeries& laws, int law,
                                                                 const EvaluatedState& from,
                                                                 const EvaluatedState& to) {
  const ScalarTerm& term = system_.scalars()[idx(law)];
  const LawPiece* p = laws.force_piece(law);
  // A law without a gap may jump at a change, where the force at that end of the step is of either side.
  if (!laws.side(law) || p == nullptr || p->c != 0.0 || p->product != 0.0) return std::nullopt;
  const double y_a = from.responses[idx(law)].y, y_b = to.responses[idx(law)].y;
  // Without a slope it is the piece's own, but for what rounding leaves at an end beside a change.
  if (p->k == 0.0 && (p->y_0 == 0.0 || !term.varies))
    return StepMotion::Range{std::min({p->y_0, y_a, y_b}), std::max({p->y_0, y_a, y_b})};
  if (term.phase_node >= 0 && term.force->has_offset()) return std::nullopt;  // nobody knows how far it bends
  const ScalarInput &a = from.inputs[idx(law)], &b = to.inputs[idx(law)];
  double beyond = 0.0;
  for (const Entry& e : term.z) beyond += std::abs(p->k * e.coeff) * beyond_cubic_[idx(e.index)];
  const auto elastic = [&](const ScalarInput& at, double y) {
    return term.varies ? p->y_0 + p->k * at.x : y;
  };
  const Interval e = cubic_reach(elastic(a, y_a), p->k * a.x_dot, elastic(b, y_b), p->k * b.x_dot,
                                 to.state.t - from.state.t);
  StepMotion::Range reach{e.low - beyond, e.high + beyond};
  if (!term.varies) return reach;
  const ExpandedLaws::Turning turning = expanded.turning(law);
  // Orders bend so much that the range would be asked for in any case.
  if (!turning.straight || !expanded.scale_of(law, series, scale_)) return std::nullopt;
  // The scale lies within sum |r_k| max(s - s^k) of its chord.
  double bends = turning.steepest * left_by_kinks(turning.row).value, end = scale_[0];
  for (std::size_t k = 1; k < scale_.size(); ++k) {
    end += scale_[k];
    bends += std::abs(scale_[k]) * std::max(0.0, 1.0 - 1.5 * kInverse[k]);
  }
  reach = {std::min(y_a, y_b), std::max(y_a, y_b)};
  for (const double r : {std::min(scale_[0], end) - bends, std::max(scale_[0], end) + bends})
    for (const double y : {r * (e.low - beyond), r * (e.high + beyond)}) {
      reach.low = std::min(reach.low, y);
      reach.high = std::max(reach.high, y);
    }
  return reach;
}

StepMotion::Range StepExpansion::range(const std::vector<Entry>& z, const std::vector<Entry>& v, double s) {
  const auto terms = idx(series.degree()) + 1;
  const double per_time = 1.0 / series.step();
  ranged_.assign(terms, 0.0);
  for (std::size_t k = 0; k < terms; ++k) {
    for (const Entry& e : z) ranged_[k] += e.coeff * series.coefficient(static_cast<int>(k), e.index);
    for (const Entry& e : v)
      if (k > 0)
        ranged_[k - 1] +=
            static_cast<double>(k) * per_time * e.coeff * series.coefficient(static_cast<int>(k), e.index);
  }
  StepMotion::Range range = range_of(ranged_, {}, {}, s);
  range.error = left_by_kinks(z).value + per_time * left_by_kinks(v).rate;
  return range;
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

LawWork StepExpansion::work(const LawSeries& laws, double s, const EvaluatedState& end) {
  LawWork sum = smooth.work(series, s, end);
  sum += expanded.work(series, s, end, sweeps_ && kinks.any());
  sum.input += known.work(series, s, end.state.z) + laws.input(s) + friction.input(s);
  if (sweeps_) return sum += {kinks.work(), kinks.dissipated()};
  sum.dissipated += series.loss(s, false, false) + laws.dissipated(s) + friction.dissipated(s);
  return sum;
}

std::optional<StepExpansion::SweptEnd> StepExpansion::first_swept_change(LawSeries& laws, double t,
                                                                         State& at) {
  const LawSeries::Beside found = laws.first_change_beside(series, known.kink_sizes().push());
  if (found.unsure) return std::nullopt;
  SweptEnd end;
  std::optional<double> knot;
  if (!found.change) knot = first_knot(1.0);
  // The first sweep goes to where the step is likely to end, and tells whether it holds so far.
  const double likely = found.change ? found.change->s : knot.value_or(1.0);
  if (!find_kinks(likely, at)) return std::nullopt;
  const bool holds = !(kinks.limit() < likely);
  if (!holds) {
    end.s = kinks.limit();
    end.by_kinks = true;
    knot.reset();
  }
  if (found.change && holds) {
    LawSeries::Change change = *found.change;
    const auto later = [&](double s) {
      change.s = s;
      return laws.later(change, series.swept(0), series.swept(-1));
    };
    const auto s = settle(change.s, later, t, at);
    if (!s) return std::nullopt;
    change.s = *s;
    end = {*s, change};
  }
  if (found.change) knot = first_knot(end.s);
  if (!knot && kinks.any() && !expanded.empty()) {
    if (!find_kinks(end.s, at)) return std::nullopt;
    if (kinks.any() && expanded.passes_knot(series, end.s)) knot = end.s;
  }
  if (!knot) return end;
  const auto s = settle(
      *knot, [&](double from) { return expanded.knot_later(series, from); }, t, at);
  if (!s) return std::nullopt;
  return *s < end.s ? SweptEnd{*s, {}, true} : end;
}

/// What kinks add to the motion up to s, where the step is likely to end. False: not to be found.
bool StepExpansion::find_kinks(double s, State& at) {
  if (kinks.found() && kinks.end() == s) return true;
  if (s == 1.0) return kinks.find(1.0, nullptr, share_);
  series.sum_up(s);
  series.evaluate(s, at.z, at.v);
  return kinks.find(s, at.z.data(), share_);
}

/// The s near one on the series' path at which something comes with what kinks add to the motion; later(s): by how much of the
/// step it is later. None: passes have to tell.
template <class Later>
std::optional<double> StepExpansion::settle(double s, const Later& later, double t, State& at) {
  for (int newton = 0; newton < kMostNewton; ++newton) {
    if (!find_kinks(s, at)) return std::nullopt;
    if (!kinks.any()) return s;
    const double by = later(s);
    if (std::abs(by) <= kAtChange || s * series.step() < kRoundingOfTime * std::abs(t)) return s;
    s += by;
    if (!(s > 0.0 && s <= 1.0)) break;
  }
  return std::nullopt;
}

bool StepExpansion::expand_part(const StepExpansion& other, const EvaluatedState& from, const LawSeries& laws,
                                double s, const Limits& limits) {
  known.locate_as(other.known);
  const double h = s * other.series.step();
  contraction_ = other.contraction_;
  series.scale_as(other.series);
  friction.locate_as(other.friction);
  expanded.locate_as(other.expanded);
  const Attempt made = attempt(from, laws, h, {limits.share, limits.tolerance, h, h});
  if (made.again || made.h != h || (sweeps_ && !kinks.find(1.0, nullptr, limits.share))) return false;
  friction.expand(series, from.state);
  return true;
}

}  // namespace drev
