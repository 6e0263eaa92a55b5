#include <drev/elements/time_curve.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

constexpr int kMostHalvings = 24;
constexpr int kLooks = 257;  // points at which the largest value is looked for
// How far inside a stretch, relative to the times, its slope at an end that may be a kink is taken: rounding of the formula's
// parts does not lead across the kink there.
constexpr double kBesideKink = 1e-14;

using Cubic = std::array<double, 4>;

double cubic_at(const Cubic& c, double s) { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }

/// With these values and slopes at 0 and h.
Cubic hermite(const Dual& a, const Dual& b, double h) {
  const double rise = (b.value - a.value) / h;
  return {a.value, a.by_x, (3.0 * rise - 2.0 * a.by_x - b.by_x) / h,
          (a.by_x + b.by_x - 2.0 * rise) / (h * h)};
}

}  // namespace

TimeCurve::TimeCurve(Params params) : params_(std::move(params)) {
  if (!usable()) return;
  const Params& p = params_;
  std::vector<double> ends{p.from};
  ends.insert(ends.end(), p.breakpoints.begin(), p.breakpoints.end());
  ends.push_back(p.to);
  double largest = 0.0;
  for (int i = 0; i < kLooks; ++i)
    largest = std::max(largest, std::abs(value(p.from + (p.to - p.from) * i / (kLooks - 1), false).value));
  permitted_ = p.accuracy * largest;
  const double least = std::ldexp(p.to - p.from, -kMostHalvings);
  struct Stretch {
    double from, to;
  };
  for (std::size_t e = 0; e + 1 < ends.size(); ++e) {
    std::vector<Stretch> open{{ends[e], ends[e + 1]}};
    while (!open.empty()) {
      const Stretch s = open.back();
      open.pop_back();
      const double h = s.to - s.from;
      Dual a = value(s.from, false), b = value(s.to, s.to == ends[e + 1]);
      const double beside = kBesideKink * std::max({p.to - p.from, std::abs(p.from), std::abs(p.to)});
      if (s.from == ends[e]) a.by_x = value(std::min(s.from + beside, s.to), false).by_x;
      if (s.to == ends[e + 1]) b.by_x = value(std::max(s.to - beside, s.from), false).by_x;
      const Cubic c = hermite(a, b, h);
      double error = 0.0;
      bool finite = std::isfinite(permitted_);
      for (const double part : {0.25, 0.5, 0.75}) {
        const double off = std::abs(cubic_at(c, part * h) - value(s.from + part * h, false).value);
        error = std::max(error, off);
        finite = finite && std::isfinite(off);
      }
      if (error > permitted_ && h > least) {
        const double middle = s.from + 0.5 * h;
        open.push_back({middle, s.to});
        open.push_back({s.from, middle});
        continue;
      }
      reached_ = reached_ && finite && error <= permitted_;
      knots_.push_back(s.from);
      pieces_.push_back(c);
    }
  }
  knots_.push_back(p.to);
  pieces_.push_back({value(p.to, false).value, 0.0, 0.0, 0.0});
}

Dual TimeCurve::value(double t, bool before) const {
  if (before) t = std::nextafter(t, params_.from);  // of a jump the value that leads up to it
  const Dual time(t, 1.0, 0.0);
  return params_.formula ? params_.formula->at(std::array{time}) : params_.function(time);
}

bool TimeCurve::usable() const {
  const Params& p = params_;
  double last = p.from;
  for (const double t : p.breakpoints) {
    if (!(t > last)) return false;
    last = t;
  }
  return bool(p.function) != p.formula.has_value() && std::isfinite(p.from) && std::isfinite(p.to) &&
         p.to > last && p.accuracy >= 1e-14 && p.accuracy <= 1e-2;
}

std::array<double, 4> TimeCurve::at(double t) const {
  if (knots_.empty()) return {};
  const auto above = std::upper_bound(knots_.begin(), knots_.end(), t);
  if (above == knots_.begin()) return {pieces_.front()[0], 0.0, 0.0, 0.0};
  const auto k = static_cast<std::size_t>(above - knots_.begin()) - 1;
  const Cubic& c = pieces_[k];
  const double s = k + 1 == knots_.size() ? 0.0 : t - knots_[k];
  return {cubic_at(c, s), c[1] + s * (2.0 * c[2] + 3.0 * s * c[3]), c[2] + 3.0 * s * c[3], c[3]};
}

double TimeCurve::smallest() const {
  double least = pieces_.empty() ? 0.0 : pieces_.front()[0];
  for (std::size_t k = 0; k + 1 < knots_.size(); ++k)
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0})
      least = std::min(least, value(knots_[k] + part * (knots_[k + 1] - knots_[k]), part == 1.0).value);
  return std::abs(least) <= permitted_ ? 0.0 : least;
}

void TimeCurve::check(ParameterCheck& check, const std::string& parameter) const {
  const Params& p = params_;
  if (bool(p.function) == p.formula.has_value())
    check.fail(parameter, p.function ? "both" : "nothing", "",
               "exactly one of function and formula must be given");
  check.finite(parameter + ".from", p.from, "s");
  check.finite(parameter + ".to", p.to, "s");
  if (p.to <= p.from)
    check.fail(parameter + ".to", to_text(p.to), "s", "must be behind from, " + to_text(p.from) + " s");
  std::vector<double> ends{p.from};
  ends.insert(ends.end(), p.breakpoints.begin(), p.breakpoints.end());
  ends.push_back(p.to);
  if (p.to > p.from && !p.breakpoints.empty()) check.increasing(parameter + ".breakpoints", ends, "s");
  check.within(parameter + ".accuracy", p.accuracy, 1e-14, 1e-2, "");
  if (!reached_)
    check.fail(
        parameter, to_text(p.accuracy), "",
        "is an accuracy that stretches of a 2^24th of the span do not reach: the formula jumps, kinks or is "
        "not finite at an instant that is none of the breakpoints");
}

}  // namespace drev
