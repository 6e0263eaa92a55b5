#pragma once
/// Searches of a function of one variable between two bounds: bracketed_maximum(), its largest value, and IllinoisBracket, its root.
#include <cmath>
#include <limits>

namespace drev {

struct BracketedMaximum {
  double at = 0.0, value = 0.0;
};

/// The largest value: parabolic interpolation through three points, with golden section steps where it does not converge. If there
/// are several local maxima, one is found.
///
/// look(t): the function, evaluated for t in [low, high]. start: first point, best one whose value is above
/// both ends; if it is at or outside the bounds, golden section chooses it. width: absolute tolerance of the
/// place, in the unit of t; the place is never located more closely than rounding allows.
/// Source: R. P. Brent, Algorithms for Minimization without Derivatives, Prentice-Hall, 1973, chapter 5 (procedure localmin).
template <class Look>
BracketedMaximum bracketed_maximum(double low, double start, double high, double width, const Look& look) {
  const double golden = 0.5 * (3.0 - std::sqrt(5.0));
  const double rounding = std::sqrt(std::numeric_limits<double>::epsilon());
  constexpr int kMostLooks = 100;
  double a = low, b = high;
  double x = start > low && start < high ? start : a + golden * (b - a);
  double f_x = look(x), w = x, v = x, f_w = f_x, f_v = f_x, step = 0.0, before = 0.0;
  for (int i = 0; i < kMostLooks; ++i) {
    const double middle = 0.5 * (a + b), near = 1e-2 * rounding * std::abs(x) + 0.25 * width;
    if (std::abs(x - middle) <= 2.0 * near - 0.5 * (b - a)) break;
    bool parabola = false;
    if (std::abs(before) > near) {
      const double r = (x - w) * (f_x - f_v), q_0 = (x - v) * (f_x - f_w);
      double p = (x - v) * q_0 - (x - w) * r, q = 2.0 * (q_0 - r);
      q > 0.0 ? p = -p : q = -q;
      const double last = before;
      before = step;
      if (std::abs(p) < std::abs(0.5 * q * last) && p > q * (a - x) && p < q * (b - x)) {
        step = p / q;
        const double u = x + step;
        if (u - a < 2.0 * near || b - u < 2.0 * near) step = x < middle ? near : -near;
        parabola = true;
      }
    }
    if (!parabola) {
      before = x < middle ? b - x : a - x;
      step = golden * before;
    }
    const double u = x + (std::abs(step) >= near ? step : step > 0.0 ? near : -near), f_u = look(u);
    if (f_u >= f_x) {
      (u < x ? b : a) = x;
      v = w, f_v = f_w, w = x, f_w = f_x, x = u, f_x = f_u;
    } else {
      (u < x ? a : b) = u;
      if (f_u >= f_w || w == x)
        v = w, f_v = f_w, w = u, f_w = f_u;
      else if (f_u >= f_v || v == x || v == w)
        v = u, f_v = f_u;
    }
  }
  return {x, f_x};
}

/// A root of f between two places at which f has different signs.
///
///   x = (low f_high - high f_low) / (f_high - f_low)
///
/// takes the place of the end with its sign; the f of an end that stays twice in a row is halved, so that both ends close in.
/// Source: M. Dowell, P. Jarratt, A modified regula falsi method for computing the root of an equation, BIT 11, 1971.
struct IllinoisBracket {
  double low = 0.0, f_low = 0.0;  ///< f_low is not 0
  double high = 0.0, f_high = 0.0;
  int stayed = 0;  ///< 1: low has stayed, -1: high has, 0: neither yet

  double next() const { return (low * f_high - high * f_low) / (f_high - f_low); }
  void take(double x, double f) {
    const int stays = (f > 0.0) == (f_low > 0.0) ? -1 : 1;
    (stays < 0 ? low : high) = x;
    (stays < 0 ? f_low : f_high) = f;
    if (stays == stayed) (stays < 0 ? f_high : f_low) *= 0.5;
    stayed = stays;
  }
};

}  // namespace drev
