#include "solvers/run/peak_search.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/run/cubic_peak.hpp"

namespace drev {

namespace {

constexpr double kRounding = 4e-16;   // rounding of a value over the largest one
constexpr double kSettled = 1e-13;    // gain of the last parabola over the range
constexpr double kCubicError = 0.25;  // error of a cubic over the rise that it shows,
constexpr double kCloser = 0.125;  // part of the way from an end to the middle, looked at where nothing shows
constexpr double kSwing = 0.5;     // rise of an extremum above both ends over their difference,
constexpr double kRangeSwing = 0.02;  // and over the range, at most

using Look = std::function<PeakSample(double t)>;

/// sign 1: the largest value, -1: the smallest.
double beyond(const Peak& peak, double y, double sign) { return sign > 0.0 ? y - peak.max : peak.min - y; }

void search_by_rates(PeakSample a, PeakSample b, const Look& look, double range, Peak& peak) {
  const double sign = *a.rate > 0.0 ? 1.0 : -1.0;
  for (int i = 0; i < kMostLooks; ++i) {
    const auto cubic = cubic_peak(a.y, *a.rate, b.y, *b.rate, b.t - a.t);
    if (!cubic) return;
    const double rise = sign * (cubic->value - (sign > 0.0 ? std::max(a.y, b.y) : std::min(a.y, b.y)));
    if (i == 0 && beyond(peak, cubic->value, sign) + kCubicError * rise + kRangeError * range < 0.0) return;
    const double t = a.t + cubic->s * (b.t - a.t);
    if (!(t > a.t && t < b.t)) return;
    const PeakSample m = look(t);
    peak.note(m.y, m.t);
    if (!m.rate || std::abs(m.y - cubic->value) <= kRounding * std::max(std::abs(m.y), range)) return;
    (*m.rate * sign > 0.0 ? a : b) = m;
    // From here a rate that falls evenly to the other end's gains so much more.
    const double other = *m.rate * sign > 0.0 ? *b.rate : *a.rate;
    const double gain = 0.5 * (b.t - a.t) * *m.rate * *m.rate / (std::abs(*m.rate) + std::abs(other));
    if (gain <= kLeastGain * range) return;
  }
}

void search_by_values(PeakSample a, PeakSample m, PeakSample b, double sign, const Look& look, double range,
                      Peak& peak) {
  double last = b.t - a.t;
  std::optional<double> slope;  // slope from the better end inwards, by the parabola before
  for (int i = 0; i < kMostLooks; ++i) {
    // The vertex of the parabola through the three.
    const double d_1 = m.t - a.t, d_2 = b.t - m.t;
    if (!(d_1 > 0.0 && d_2 > 0.0)) return;
    const double s_1 = (m.y - a.y) / d_1, s_2 = (b.y - m.y) / d_2;
    const double bend = (s_2 - s_1) / (d_1 + d_2);
    double t = 0.5 * (a.t + m.t) - 0.5 * s_1 / bend;
    const bool inside = sign * bend < 0.0 && t > a.t && t < b.t;
    // The parabola's rise above its three points may be off by a part of itself.
    const double vertex = m.y + (t - m.t) * (s_1 + bend * (t - a.t));
    const double best = sign > 0.0 ? std::max({a.y, m.y, b.y}) : std::min({a.y, m.y, b.y});
    if (i == 0 && beyond(peak, vertex, sign) + sign * (vertex - best) + kRangeError * range < 0.0) return;
    const bool middle_best = sign * m.y >= sign * a.y && sign * m.y >= sign * b.y;
    if (!inside && !middle_best) {
      // The extremum is at the better end, or so close to it that the parabola does not show it.
      const bool at_a = sign * a.y >= sign * b.y;
      const double inwards = sign * (at_a ? s_1 - bend * d_1 : -s_2 - bend * d_2);
      if (slope && -inwards > std::abs(inwards - *slope)) return;
      slope = inwards;
      const PeakSample& end = at_a ? a : b;
      const double closer = end.t + kCloser * (m.t - end.t);
      if (closer == end.t || closer == m.t) return;
      const PeakSample v = look(closer);
      peak.note(v.y, v.t);
      (at_a ? b : a) = m;
      m = v;
      last = b.t - a.t;
      continue;
    }
    const bool slow = b.t - a.t > 0.5 * last && i > 1;
    if (!inside || t == m.t || slow) t = d_1 > d_2 ? m.t - 0.5 * d_1 : m.t + 0.5 * d_2;
    last = b.t - a.t;
    if (!(t > a.t && t < b.t) || t == m.t) return;
    const PeakSample v = look(t);
    peak.note(v.y, v.t);
    const double gain = sign * (v.y - m.y);
    if (gain > 0.0) {
      (v.t < m.t ? b : a) = m;
      m = v;
    } else {
      (v.t < m.t ? a : b) = v;
    }
    if (!slow && inside && std::abs(gain) <= kSettled * range) return;
  }
}

}  // namespace

void search_peak(const PeakSample& a, const PeakSample& b, const Look& look, double range, Peak& peak) {
  if (a.rate && b.rate) {
    if (*a.rate * *b.rate < 0.0) return search_by_rates(a, b, look, range, peak);
    const auto dip = cubic_dip(a.y, *a.rate, b.y, *b.rate, b.t - a.t);
    if (!dip) return;
    const PeakSample m = look(a.t + *dip * (b.t - a.t));
    peak.note(m.y, m.t);
    if (!m.rate || !(*m.rate * *a.rate < 0.0)) return;
    search_by_rates(a, m, look, range, peak);
    search_by_rates(m, b, look, range, peak);
    return;
  }
  const double swing = std::max(kSwing * std::abs(b.y - a.y), kRangeSwing * range);
  std::optional<PeakSample> middle;
  for (const double sign : {1.0, -1.0}) {
    double best = sign > 0.0 ? std::max(a.y, b.y) : std::min(a.y, b.y);
    if (middle) best = sign > 0.0 ? std::max(best, middle->y) : std::min(best, middle->y);
    if (beyond(peak, best, sign) + swing < 0.0) continue;
    const double t = 0.5 * (a.t + b.t);
    if (!(t > a.t && t < b.t)) return;
    if (!middle) {
      middle = look(t);
      peak.note(middle->y, middle->t);
      const double same = kRounding * std::abs(middle->y);
      if (std::abs(middle->y - a.y) <= same && std::abs(middle->y - b.y) <= same) return;  // constant
    }
    search_by_values(a, *middle, b, sign, look, range, peak);
  }
}

}  // namespace drev
