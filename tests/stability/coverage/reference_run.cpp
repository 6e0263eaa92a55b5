#include "tests/stability/coverage/reference_run.hpp"

#include <algorithm>
#include <stdexcept>

namespace coverage {

namespace {

constexpr int kSamples = 24;     // a step is about half a swing of the fastest mode
constexpr int kHalvings = 80;    // of a sample's interval
constexpr int kMostEvents = 60;  // at one time

/// A zero of f between a and b, where f changes sign.
template <class F>
Real bisect(const F& f, Real a, Real b) {
  const bool falls = f(a) > 0;
  for (int i = 0; i < kHalvings; ++i) {
    const Real middle = a + (b - a) / 2;
    if (middle == a || middle == b) break;
    ((f(middle) > 0) == falls ? a : b) = middle;
  }
  return b;
}

/// Largest size of a series' value, rate and second rate so far.
using Scale = std::array<Real, 3>;

/// Shortens h until the last two terms of a series and its rates are below the tolerance.
void shorten(const Series& z, int top, int rates, Real tolerance, const Scale& scale, Real& h) {
  for (int tries = 0; tries < 60; ++tries) {
    Scale size = scale, tail{};
    Real power = 1;
    for (int k = 0; k <= top; ++k, power *= h) {
      const Real term = std::abs(z[k]) * power;
      const Scale terms{term, term * k / h, term * k * (k - 1) / (h * h)};
      for (std::size_t d = 0; d < 3; ++d) {
        size[d] = std::max(size[d], terms[d]);
        if (k >= top - 1) tail[d] += terms[d];
      }
    }
    Real worst = 0;
    for (std::size_t d = 0; d <= static_cast<std::size_t>(rates); ++d)
      if (size[d] > 0) worst = std::max(worst, tail[d] / size[d]);
    if (worst <= tolerance) return;
    h *= std::min(static_cast<Real>(0.95L), std::pow(tolerance / worst, static_cast<Real>(1) / top));
  }
}

void note(const Series& z, Scale& scale) {
  for (int d = 0; d < 3; ++d) {
    Real& s = scale[static_cast<std::size_t>(d)];
    s = std::max(s, std::abs(z[d]) * (d == 2 ? 2 : 1));
  }
}

/// The longest step, up to `most`, on which every series is exact to the tolerance.
Real step_length(const ReferenceModel& m, Real most, Real tolerance, std::vector<Scale>& scales) {
  const std::vector<const Series*> known = m.known_series();
  scales.resize(static_cast<std::size_t>(m.unknowns()) + known.size());
  Real h = most;
  std::size_t i = 0;
  for (int u = 0; u < m.unknowns(); ++u, ++i) {
    shorten(m.motion(u), m.degree() + 2, 2, tolerance, scales[i], h);
    note(m.motion(u), scales[i]);
  }
  for (const Series* s : known) {
    shorten(*s, m.degree(), 1, tolerance, scales[i], h);
    note(*s, scales[i++]);
  }
  return h;
}

}  // namespace

Real upper_bound(const Poly& y, Real h) {
  Real sum = y.a[0], power = h;
  for (int k = 1; k <= y.degree; ++k, power *= h) sum += std::max(y.a[k] * power, static_cast<Real>(0));
  return sum;
}

Real lower_bound(const Poly& y, Real h) {
  Real sum = y.a[0], power = h;
  for (int k = 1; k <= y.degree; ++k, power *= h) sum += std::min(y.a[k] * power, static_cast<Real>(0));
  return sum;
}

Real first_fall(const Poly& given, Real h, bool fresh) {
  Poly g = given;
  Real size = 0, power = 1;
  for (int k = 0; k <= g.degree; ++k, power *= h) size += std::abs(g.a[k]) * power;
  if (fresh || g.a[0] <= 0) {
    if (g.a[0] < -1e-9L * size)
      throw std::runtime_error("a guard of the reference does not hold where it should");
    for (int k = 1; k <= g.degree; ++k) g.a[k - 1] = g.a[k];
    --g.degree;
    if (g.a[0] <= 0) return 0;
  }
  if (lower_bound(g, h) > 0) return -1;
  const auto value = [&](Real s) { return g.value(s); };
  const auto slope = [&](Real s) { return g.slope(s); };
  Real from = 0, slope_from = g.slope(0);
  for (int i = 1; i <= kSamples; ++i) {
    const Real to = h * i / kSamples, slope_to = g.slope(to);
    if (slope_from < 0 && slope_to > 0) {
      const Real lowest = bisect(slope, from, to);
      if (g.value(lowest) <= 0) return bisect(value, from, lowest);
    }
    if (g.value(to) <= 0) return bisect(value, from, to);
    from = to, slope_from = slope_to;
  }
  return -1;
}

std::vector<Real> extremes(const Poly& y, Real h) {
  std::vector<Real> found{0, h};
  const auto slope = [&](Real s) { return y.slope(s); };
  Real from = 0, slope_from = y.slope(0);
  for (int i = 1; i <= kSamples; ++i) {
    const Real to = h * i / kSamples, slope_to = y.slope(to);
    if ((slope_from > 0) != (slope_to > 0)) found.push_back(bisect(slope, from, to));
    from = to, slope_from = slope_to;
  }
  return found;
}

void run_reference(ReferenceModel& m, Real t_end, const ReferencePrecision& precision,
                   const std::vector<Watcher>& watchers) {
  std::vector<Scale> scales;
  int events_here = 0;
  while (m.t < t_end) {
    m.expand(precision.degree);
    const Real stop = std::min(m.next_breakpoint(), t_end);
    Real h = step_length(m, stop - m.t, precision.tolerance, scales);
    bool to_stop = h == stop - m.t;
    const std::vector<Guard> guards = m.guards();
    const Guard* first = nullptr;
    for (const Guard& g : guards) {
      const Real s = first_fall(g.g, h, g.fresh);
      if (s < 0) continue;
      h = s, first = &g, to_stop = false;
    }
    events_here = first && h < 1e-15L * t_end ? events_here + 1 : 0;
    if (events_here > kMostEvents) throw std::runtime_error("events without end in the reference");
    const ReferenceStep step{m, m.t, h, first};
    for (const Watcher& w : watchers) w(step);
    m.advance(h, to_stop ? &stop : nullptr);
    if (first) {
      const Guard passed = *first;
      m.pass(passed);
    } else if (to_stop) {
      m.settle();
    } else {
      m.clear_passed();
    }
  }
}

}  // namespace coverage
