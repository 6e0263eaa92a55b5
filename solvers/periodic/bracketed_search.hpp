#pragma once
/// Searches of a function of one variable: tops_of() brackets its local maxima between points at which it is known, MaximumSearch
/// and bracketed_maximum() find its largest value between two bounds, followed_top() that in a bracket, IllinoisBracket its root.
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace drev {

/// A point that its neighbours do not exceed. The function may rise above it between `low` and `high`: the neighbours, or the
/// point itself on a side where there is none or where its value is not a number.
struct TopBracket {
  std::size_t point = 0;
  double low = 0.0, high = 0.0;
  bool at_end = false;  ///< true: it has one neighbour, or none
  /// Where to look first: the point; at an end a place just inside. If the function is not larger there, the end is the top.
  double start = 0.0;
};

/// All of them, by ascending place. Of neighbours with the same value the last one is taken; infinite ones are tops each.
inline std::vector<TopBracket> tops_of(const std::vector<double>& places, const std::vector<double>& values) {
  constexpr double kInside = 1e-3;  // distance of `start` from an end relative to the bracket [-]
  std::vector<TopBracket> tops;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool first = i == 0 || std::isnan(values[i - 1]),
               last = i + 1 == values.size() || std::isnan(values[i + 1]);
    if (std::isnan(values[i]) || (!first && values[i - 1] > values[i]) ||
        (!last && std::isfinite(values[i]) && values[i + 1] >= values[i]))
      continue;
    const double low = places[first ? i : i - 1], high = places[last ? i : i + 1];
    const double start = first  ? low + kInside * (high - low)
                         : last ? high - kInside * (high - low)
                                : places[i];
    tops.push_back({i, low, high, first || last, start});
  }
  return tops;
}

struct BracketedMaximum {
  double at = 0.0, value = 0.0;
};

/// The largest value between two bounds: parabolic interpolation through three points, with golden section steps where it does not
/// converge. If there are several local maxima, one is found.
///
///   MaximumSearch search(low, start, high, width);
///   while (!search.found()) search.take(f(search.next()));
///
/// start: first point, best one whose value is above both ends; if it is at or outside the bounds, golden section chooses it.
/// width: absolute tolerance of the place; the place is never located more closely than rounding allows. A value that is not a
/// number counts as low.
/// Source: R. P. Brent, Algorithms for Minimization without Derivatives, Prentice-Hall, 1973, chapter 5 (procedure localmin).
class MaximumSearch {
 public:
  MaximumSearch(double low, double start, double high, double width) : a_(low), b_(high), width_(width) {
    x_ = w_ = v_ = u_ = start > low && start < high ? start : a_ + golden() * (b_ - a_);
  }
  bool found() const { return found_; }
  /// Where the function is to be evaluated, within the bounds.
  double next() const { return u_; }
  /// The function's value there.
  void take(double f_u) {
    if (looks_ == 0) {
      f_x_ = f_w_ = f_v_ = f_u;
    } else if (f_u >= f_x_) {
      (u_ < x_ ? b_ : a_) = x_;
      v_ = w_, f_v_ = f_w_, w_ = x_, f_w_ = f_x_, x_ = u_, f_x_ = f_u;
    } else {
      (u_ < x_ ? a_ : b_) = u_;
      if (f_u >= f_w_ || w_ == x_)
        v_ = w_, f_v_ = f_w_, w_ = u_, f_w_ = f_u;
      else if (f_u >= f_v_ || v_ == x_ || v_ == w_)
        v_ = u_, f_v_ = f_u;
    }
    plan();
  }
  BracketedMaximum best() const { return {x_, f_x_}; }

 private:
  static double golden() { return 0.5 * (3.0 - std::sqrt(5.0)); }
  void plan() {
    constexpr int kMostLooks = 100;
    const double rounding = std::sqrt(std::numeric_limits<double>::epsilon());
    const double middle = 0.5 * (a_ + b_), near = 1e-2 * rounding * std::abs(x_) + 0.25 * width_;
    found_ = looks_++ == kMostLooks || std::abs(x_ - middle) <= 2.0 * near - 0.5 * (b_ - a_);
    if (found_) return;
    bool parabola = false;
    if (std::abs(before_) > near) {
      const double r = (x_ - w_) * (f_x_ - f_v_), q_0 = (x_ - v_) * (f_x_ - f_w_);
      double p = (x_ - v_) * q_0 - (x_ - w_) * r, q = 2.0 * (q_0 - r);
      q > 0.0 ? p = -p : q = -q;
      const double last = before_;
      before_ = step_;
      if (std::abs(p) < std::abs(0.5 * q * last) && p > q * (a_ - x_) && p < q * (b_ - x_)) {
        step_ = p / q;
        const double u = x_ + step_;
        if (u - a_ < 2.0 * near || b_ - u < 2.0 * near) step_ = x_ < middle ? near : -near;
        parabola = true;
      }
    }
    if (!parabola) {
      before_ = x_ < middle ? b_ - x_ : a_ - x_;
      step_ = golden() * before_;
    }
    u_ = x_ + (std::abs(step_) >= near ? step_ : step_ > 0.0 ? near : -near);
  }

  double a_, b_, width_, x_, w_, v_, u_;
  double f_x_ = 0.0, f_w_ = 0.0, f_v_ = 0.0, step_ = 0.0, before_ = 0.0;
  int looks_ = 0;
  bool found_ = false;
};

/// The largest value of look(t), as MaximumSearch finds it.
template <class Look>
BracketedMaximum bracketed_maximum(double low, double start, double high, double width, const Look& look) {
  MaximumSearch search(low, start, high, width);
  while (!search.found()) search.take(look(search.next()));
  return search.best();
}

/// The top in a bracket: the largest value of look(t) that is found, or that of the point itself, `known` at `place`, if none is
/// larger. At an end, one look just inside tells first whether the function rises from there.
template <class Look>
BracketedMaximum followed_top(const TopBracket& top, double place, double known, double width,
                              const Look& look) {
  const bool is_top = !(top.high > top.low) || (top.at_end && !(look(top.start) > known));
  if (is_top) return {place, known};
  const BracketedMaximum found = bracketed_maximum(top.low, top.start, top.high, width, look);
  return found.value >= known ? found : BracketedMaximum{place, known};
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
