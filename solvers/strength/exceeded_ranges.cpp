#include "solvers/strength/exceeded_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "solvers/periodic/bracketed_search.hpp"

namespace drev {

namespace {

constexpr double kEndSpeed = 1e-7;  // width of an end's bracket relative to its speed [-]
constexpr int kMostRounds = 120;    // largest number of sweeps for the ends; bisection alone needs 60
constexpr double kTopSpeed = 1e-7;  // tolerance of a top's speed relative to it [-]
constexpr double kLowTop =
    0.1;  // ratio, or part of a largest ratio below 1, below which no top is followed [-]

using Ratio = std::function<double(const CurvePoint&)>;

/// A local maximum of one of a curve's ratios that is followed.
struct FollowedTop {
  std::size_t curve = 0;
  const Ratio* ratio = nullptr;
  double known = 0.0;  // ratio at the point from which it is followed [-]
  bool at_end = false;
  MaximumSearch search;
  CurvePoint best = {};
  bool found = false;
};

void find_tops(std::size_t number, const LimitedCurve& curve, const Ratio& ratio,
               std::vector<FollowedTop>& tops) {
  std::vector<double> speeds, ratios;
  double largest = 0.0;
  for (const CurvePoint& p : curve.points) {
    speeds.push_back(p.speed), ratios.push_back(ratio(p));
    if (std::isfinite(ratios.back())) largest = std::max(largest, ratios.back());
  }
  const double least = kLowTop * std::min(largest, 1.0);
  for (const TopBracket& top : tops_of(speeds, ratios)) {
    const double here = ratios[top.point], speed = speeds[top.point];
    if (!std::isfinite(here) || !(here > least) || !(top.high > top.low)) continue;
    tops.push_back(
        {number, &ratio, here, top.at_end, MaximumSearch(top.low, top.start, top.high, kTopSpeed * speed)});
  }
}

/// Solves the sweep at all trial speeds that are not 0, in any order, and calls look(number of the trial, sweep, number of its
/// speed) for each. false: all are 0.
template <class Look>
bool solve_at(const std::vector<double>& trials, const SweepAt& sweep_at, const Look& look) {
  std::vector<double> speeds;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(speeds), [](double s) { return s > 0.0; });
  if (speeds.empty()) return false;
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end()), speeds.end());
  const LinearSweep sweep = sweep_at(speeds);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (!(trials[i] > 0.0)) continue;
    look(i, sweep, std::lower_bound(speeds.begin(), speeds.end(), trials[i]) - speeds.begin());
  }
  return true;
}

/// One round: looks at the next speeds of all tops that are not found yet. false: all are.
bool climb(std::vector<FollowedTop>& tops, const std::vector<LimitedCurve>& curves, const SweepAt& sweep_at) {
  std::vector<double> trials;
  for (const FollowedTop& top : tops) trials.push_back(top.found ? 0.0 : top.search.next());
  return solve_at(trials, sweep_at, [&](std::size_t i, const LinearSweep& sweep, Eigen::Index at) {
    FollowedTop& top = tops[i];
    const LimitedCurve& curve = curves[top.curve];
    const CurvePoint here{trials[i], curve.value(sweep, at)};
    top.search.take((*top.ratio)(here));
    const BracketedMaximum best = top.search.best();
    if (best.at == here.speed) top.best = here;
    top.found = top.search.found() || (top.at_end && !(best.value > top.known));
  });
}

/// A speed and the ratio to the limit at it.
struct RatioPoint {
  double speed = 0.0, ratio = 0.0;
};

/// An end of a range, between a speed inside it (low in `root`) and a neighbour outside, which may be below it.
struct EndBracket {
  std::size_t curve = 0, range = 0;
  bool upper = false;
  RatioPoint inside, outside;
  IllinoisBracket root;                // of (r - 1)/(r + 1)
  double earlier = 0.0, before = 0.0;  // widths two rounds and one round ago [rad/s]

  double width() const { return std::abs(inside.speed - outside.speed); }
  bool found() const { return width() <= kEndSpeed * inside.speed; }
  double trial() const {
    const double middle = 0.5 * (inside.speed + outside.speed);
    if (width() > 0.5 * earlier) return middle;
    const double part = (root.next() - inside.speed) / (outside.speed - inside.speed);
    // Not at an end of the bracket, so that each round makes it smaller from both sides in turn.
    const double least = 0.25 * kEndSpeed * inside.speed / width();
    return inside.speed + std::clamp(part, least, 1.0 - least) * (outside.speed - inside.speed);
  }
  /// The interpolated end.
  double end() const {
    const double step = outside.speed - inside.speed;
    if (std::isinf(inside.ratio)) return inside.speed + step * outside.ratio;
    return inside.speed + step * (inside.ratio - 1.0) / (inside.ratio - outside.ratio);
  }
};

double weight(double ratio) { return std::isinf(ratio) ? 1.0 : (ratio - 1.0) / (ratio + 1.0); }

EndBracket bracket(std::size_t curve, std::size_t range, bool upper, const RatioPoint& inside,
                   const RatioPoint& outside) {
  EndBracket b{curve,  range,   upper,
               inside, outside, {inside.speed, weight(inside.ratio), outside.speed, weight(outside.ratio)}};
  b.earlier = b.before = 4.0 * b.width();
  return b;
}

void take(EndBracket& b, const RatioPoint& point) {
  b.earlier = b.before;
  b.before = b.width();
  (point.ratio > 1.0 ? b.inside : b.outside) = point;
  b.root.take(point.speed, std::isnan(point.ratio) ? -1.0 : weight(point.ratio));
}

/// Ranges between the points; the ends that lie between two points whose ratios are known are added to `ends`.
void find_ranges(std::size_t number, LimitedCurve& curve, std::vector<EndBracket>& ends) {
  RatioPoint last{0.0, std::nan("")};
  bool inside = false;
  for (const CurvePoint& p : curve.points) {
    const RatioPoint now{p.speed, curve.ratio(p)};
    const bool over = now.ratio > 1.0;
    if (over && !inside) {
      ExceededRange& range = curve.ranges.emplace_back();
      range.from = now.speed;
      range.open_from = std::isnan(last.ratio);
      if (!range.open_from) ends.push_back(bracket(number, curve.ranges.size() - 1, false, now, last));
    }
    if (!over && inside) {
      curve.ranges.back().open_to = std::isnan(now.ratio);
      if (!std::isnan(now.ratio)) ends.push_back(bracket(number, curve.ranges.size() - 1, true, last, now));
    }
    if (over) {
      ExceededRange& range = curve.ranges.back();
      if (now.ratio > range.worst) range.worst = now.ratio, range.worst_speed = now.speed;
      range.to = now.speed;
    }
    inside = over;
    last = now;
  }
  if (inside) curve.ranges.back().open_to = true;
}

/// One round: solves the sweep at the trial speeds of all ends that are not found yet. false: all are.
bool narrow(std::vector<EndBracket>& ends, const std::vector<LimitedCurve>& curves, const SweepAt& sweep_at) {
  std::vector<double> trials;
  for (const EndBracket& b : ends) trials.push_back(b.found() ? 0.0 : b.trial());
  return solve_at(trials, sweep_at, [&](std::size_t i, const LinearSweep& sweep, Eigen::Index at) {
    const LimitedCurve& curve = curves[ends[i].curve];
    take(ends[i], {trials[i], curve.ratio({trials[i], curve.value(sweep, at)})});
  });
}

}  // namespace

void add_tops(std::vector<LimitedCurve>& curves, const SweepAt& sweep_at) {
  std::vector<FollowedTop> tops;
  for (std::size_t c = 0; c < curves.size(); ++c)
    for (const Ratio* ratio : {&curves[c].ratio, &curves[c].transient_ratio})
      if (*ratio) find_tops(c, curves[c], *ratio, tops);
  while (climb(tops, curves, sweep_at)) {
  }
  for (const FollowedTop& top : tops) {
    if (!(top.search.best().value > top.known)) continue;
    std::vector<CurvePoint>& points = curves[top.curve].points;
    const auto at = std::lower_bound(points.begin(), points.end(), top.best.speed,
                                     [](const CurvePoint& p, double speed) { return p.speed < speed; });
    if (at == points.end() || at->speed != top.best.speed) points.insert(at, top.best);
  }
}

void find_exceeded_ranges(std::vector<LimitedCurve>& curves, const SweepAt& sweep_at) {
  std::vector<EndBracket> ends;
  for (std::size_t c = 0; c < curves.size(); ++c) find_ranges(c, curves[c], ends);
  if (sweep_at)
    for (int round = 0; round < kMostRounds && narrow(ends, curves, sweep_at);) ++round;
  for (const EndBracket& b : ends) {
    ExceededRange& range = curves[b.curve].ranges[b.range];
    (b.upper ? range.to : range.from) = b.end();
    (b.upper ? range.kept_above : range.kept_below) = b.outside.speed;
  }
}

}  // namespace drev
