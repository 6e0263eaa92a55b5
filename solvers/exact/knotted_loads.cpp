// SmoothLoads: loads that say their knots.
#include <algorithm>
#include <cmath>

#include "solvers/exact/smooth_loads.hpp"
#include "solvers/series/series_kernels.hpp"

namespace drev {

namespace {

constexpr std::size_t kNodes = GaussRule::kNodes, kRoom = whole_lanes(GaussRule::kNodes);
constexpr int kMostKnots = 64;  // knots of one load in a step; more of them end the step
// A knot so close to the step's ends need not end it, relative to the step.
constexpr double kNearSpanEnd = 1e-6;
constexpr int kMaxKnotNewton = 20;
constexpr double kTurnRounding = 1e-13;  // of an angle, of a train at rest [rad] or relative to the angle
// Part of a step in which an angle turns back beside a knot, to be tried next.
constexpr double kAtTurn = 0.5;

struct Cubic {
  double value, slope;
};
Cubic cubic_at(const CubicPiece& p, double x) {
  const auto& c = p.terms;
  return {c[0] + x * (c[1] + x * (c[2] + x * c[3])), c[1] + x * (2.0 * c[2] + 3.0 * x * c[3])};
}

/// Value and slope of sum terms[k] s^k.
Cubic polynomial_at(const std::vector<double>& terms, double s) {
  Cubic f{};
  for (std::size_t k = terms.size(); k-- > 0;) {
    f.slope = f.slope * s + f.value;
    f.value = f.value * s + terms[k];
  }
  return f;
}

/// s in (from, 1) at which the monotone polynomial is `target`.
double place_of(const std::vector<double>& terms, double target, double from, double start, double end) {
  double low = from, high = 1.0;
  double s = std::clamp(from + (1.0 - from) * (target - start) / (end - start), low, high);
  for (int i = 0; i < kMaxKnotNewton; ++i) {
    const Cubic f = polynomial_at(terms, s);
    ((f.value < target) == (end > start) ? low : high) = s;
    double next = s - (f.value - target) / f.slope;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double step = next - s;
    s = next;
    if (std::abs(step) < 1e-15) break;
  }
  return s;
}

}  // namespace

/// A load at the nodes of a rule: its node's turn since the step's start and its rate by s, torque and slopes.
struct SmoothLoads::Samples {
  std::array<double, kRoom> turn{}, rate{}, torque{}, slope{}, speed_slope{};
};

double SmoothLoads::beyond_tangent(const Place& l, const Samples& at, std::size_t q) const {
  return at.torque[q] - l.torque - l.slope * at.turn[q] - l.speed_slope * (at.rate[q] / h_ - l.speed);
}

/// Torque and slopes at the places s, where turn and rate are known.
void SmoothLoads::sample(const Place& l, const double* s, Samples& at) const {
  for (std::size_t q = 0; q < kNodes; ++q) {
    const double nominal_turn = l.ratio * (phi_[1] + phi_[2] * s[q]) * s[q];
    const LoadResponse r =
        l.term->load->evaluate({.t = t_ + h_ * s[q],
                                .nominal_angle = l.ratio * nominal_ + nominal_turn,
                                .deviation = l.deviation + (at.turn[q] - nominal_turn),
                                .speed = at.rate[q] / h_,
                                .nominal_speed = l.ratio * (phi_[1] + 2.0 * phi_[2] * s[q]) / h_});
    at.torque[q] = r.torque;
    at.slope[q] = r.dtorque_dangle;
    at.speed_slope[q] = r.dtorque_dspeed;
  }
}

/// Adds the Legendre coefficients of what the load differs from its tangent over from <= s <= to. Returns how much of a
/// change of the path comes back.
double SmoothLoads::add_interval(Place& l, double from, double to, LegendreProjection& kinks) const {
  const GaussRule& rule = gauss_rule();
  std::array<double, kRoom> s{};
  const double length = to - from;
  for (std::size_t q = 0; q < kNodes; ++q) s[q] = from + length * rule.s[q];
  Samples at;
  polynomial_values(kRoom, static_cast<int>(turn_.size()), turn_.data(), s.data(), at.turn.data(),
                    at.rate.data());
  sample(l, s.data(), at);
  double slope = 0.0, speed_slope = 0.0;
  std::array<double, kProjectionTerms> sum{};
  for (std::size_t q = 0; q < kNodes; ++q) {
    const double u = 2.0 * s[q] - 1.0;
    double below = rule.weight[q] * beyond_tangent(l, at, q), now = u * below;
    sum[0] += below;
    sum[1] += now;
    for (int j = 1; j < kProjectionDegree; ++j) {
      const double next = ((2.0 * j + 1.0) * u * now - j * below) / (j + 1.0);
      below = now;
      now = next;
      sum[idx(j + 1)] += now;
    }
    slope = std::max(slope, std::abs(at.slope[q] - l.slope));
    speed_slope = std::max(speed_slope, std::abs(at.speed_slope[q] - l.speed_slope));
  }
  for (int j = 0; j < kProjectionTerms; ++j)
    kinks.coefficient(j, l.row) += (2.0 * j + 1.0) * length * l.coeff * sum[idx(j)];
  return l.feedback ? 0.5 * h_ * h_ * slope + h_ * speed_slope : 0.0;
}

/// s of the first knot inside the step that the monotone path, turn_, passes until it ends at `end`; 1: there is none.
double SmoothLoads::first_knot_inside(const Place& l, double end) const {
  CubicPiece piece = l.piece;
  for (int count = 0; count < kMostKnots; ++count) {
    const double bound = (end > 0.0 ? piece.high : piece.low) - l.angle;
    if (end > 0.0 ? end <= bound : end >= bound) break;
    const double s = place_of(turn_, bound, 0.0, 0.0, end);
    if (s > kNearSpanEnd) return s < 1.0 - kNearSpanEnd ? s : 1.0;
    piece = l.knots->piece(l.angle + bound, end, l.piece_speed);
  }
  return 1.0;
}

/// Gauss's nodes between each two knots that the monotone path, turn_, passes until it ends at `end`.
double SmoothLoads::pass_knots(Place& l, const TaylorSeries& series, double end, LegendreProjection& kinks) {
  const bool rises = end > 0.0;
  CubicPiece piece = l.piece;
  double about = l.about, from = 0.0, start = 0.0, gain = 0.0, strength = 0.0;
  for (int count = 0;; ++count) {
    const double bound = (rises ? piece.high : piece.low) - l.angle;
    const bool last = rises ? end <= bound : end >= bound;
    const double to = last ? 1.0 : place_of(turn_, bound, from, start, end);
    gain = std::max(gain, add_interval(l, from, to, kinks));
    if (last) break;
    l.kinked = true;
    places_.push_back(to);
    const CubicPiece next = l.knots->piece(l.angle + bound, end, l.piece_speed);
    const Cubic before = cubic_at(piece, l.angle + bound - about);
    const double factor = l.knots->curves(l.angle + bound).factor;
    const double jump = std::abs((next.terms[0] - before.value) * factor);
    const double size = jump + std::abs((next.terms[1] - before.slope) * factor * end);
    if (l.feedback) gain = std::max(gain, 0.5 * h_ * h_ * jump / std::abs(end));
    l.unfinished = count == kMostKnots;
    if (to > kNearSpanEnd && to < 1.0 - kNearSpanEnd && (size > strength || l.unfinished)) {
      strength = size;
      l.strongest = to;
    }
    if (l.unfinished) break;
    piece = next;
    about = l.angle + bound;
    from = to;
    start = bound;
  }
  l.contraction = l.coeff * l.coeff * series.mobility(l.row) * gain;
  return gain;
}

double SmoothLoads::differ_knotted(Place& l, const TaylorSeries& series, NodeForces& forces,
                                   LegendreProjection& kinks) {
  const GaussRule& rule = gauss_rule();
  l.kinked = l.unfinished = false;
  l.off_at_ends = 0.0;
  l.strongest = 1.0;
  Samples at;
  double low = 0.0, high = 0.0, slowest = 1e300, fastest = -1e300;
  for (std::size_t q = 0; q < kNodes; ++q) {
    const double s = rule.s[q];
    const std::size_t place = q * idx(stride_) + idx(l.row);
    at.turn[q] = l.ratio * (phi_[1] + phi_[2] * s) * s;
    at.rate[q] = l.ratio * (phi_[1] + 2.0 * phi_[2] * s);
    if (l.feedback) {
      at.turn[q] += l.coeff * path_[place] - l.deviation;
      at.rate[q] += l.coeff * rate_[place] * h_;
    }
    low = std::min(low, at.turn[q]);
    high = std::max(high, at.turn[q]);
    slowest = std::min(slowest, at.rate[q]);
    fastest = std::max(fastest, at.rate[q]);
  }
  // The last node is .009 of the step before its end.
  low -= 0.02 * std::max(0.0, -slowest);
  high += 0.02 * std::max(0.0, fastest);
  const bool rises = slowest > 0.0, monotone = rises || fastest < 0.0;
  // Turn to the next knot on a monotone path [rad].
  const double ahead = (rises ? l.piece.high : l.piece.low) - l.angle;
  bool knots = !(l.angle + high < l.piece.high && l.angle + low > l.piece.low);
  double end = 0.0;
  if (knots && monotone) {
    find_angle(l, series, turn_);
    for (const double term : turn_) end += term;
    knots = rises ? end > ahead : end < ahead;
  }
  // The nodes have to follow it: a step ends at its knot.
  if (l.is_called()) {
    const double over = std::max(l.angle + high - l.piece.high, l.piece.low - l.angle - low);
    if (knots && over > kTurnRounding * std::max(1.0, std::abs(l.angle)))
      l.strongest = monotone ? first_knot_inside(l, end) : kAtTurn;
    l.kinked = l.unfinished = l.strongest < 1.0;
    if (l.kinked) places_.push_back(l.strongest);
    return differ_called(l, series, forces);
  }
  if (knots && monotone) return pass_knots(l, series, end, kinks);
  // Its angle may turn back in the step: each node on its own side of the knots.
  if (knots) return differ_called(l, series, forces);
  sample(l, rule.s.data(), at);
  double slope = 0.0, speed_slope = 0.0;
  for (std::size_t q = 0; q < kNodes; ++q) {
    forces.at(q, l.row) += l.coeff * beyond_tangent(l, at, q);
    slope = std::max(slope, std::abs(at.slope[q] - l.slope));
    speed_slope = std::max(speed_slope, std::abs(at.speed_slope[q] - l.speed_slope));
  }
  return l.feedback ? 0.5 * h_ * h_ * slope + h_ * speed_slope : 0.0;
}

}  // namespace drev
