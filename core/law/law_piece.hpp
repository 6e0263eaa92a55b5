#pragma once
/// The pieces of a law: polynomials of x and x_dot, each between bounds.
#include <limits>
#include <span>
#include <vector>

namespace drev {

/// a + b_x x + b_v x_dot > 0 holds on a piece; where it ceases to hold, piece `next` takes over.
struct LawBound {
  double a = 0.0, b_x = 0.0, b_v = 0.0;
  int next = 0;

  double value(double x, double x_dot) const { return a + b_x * x + b_v * x_dot; }
  bool in_x_alone() const { return b_v == 0.0 && b_x != 0.0; }
  double kink() const { return -a / b_x; }  ///< where a bound in x alone stands
};

/// An open interval.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// One piece of a law, y = y_0 + k x + c x_dot + product x x_dot while all its bounds hold. The part
/// elastic_0 + elastic_k x of it is the slope of the stored energy; the rest dissipates. The pieces
/// of a law cover the plane (x, x_dot) without overlap.
struct LawPiece {
  double y_0 = 0.0, k = 0.0, c = 0.0;
  double elastic_0 = 0.0, elastic_k = 0.0;
  std::vector<LawBound> bounds = {};
  double product = 0.0;  ///< of x x_dot: a damper that grows with deflection

  double force(double x, double x_dot) const { return y_0 + k * x + (c + product * x) * x_dot; }
  bool holds(double x, double x_dot) const {
    for (const LawBound& b : bounds)
      if (!(b.value(x, x_dot) > 0.0)) return false;
    return true;
  }
  /// The values of x that the bounds in x alone leave.
  Interval x_range() const;
  /// The values of x_dot that the other bounds leave at x.
  Interval rate_range(double x) const;
};

/// True where no piece has a term x x_dot.
inline bool is_linear(std::span<const LawPiece> pieces) {
  for (const LawPiece& p : pieces)
    if (p.product != 0.0) return false;
  return true;
}

/// True where there are pieces and no force on any of them follows x_dot.
inline bool is_undamped(std::span<const LawPiece> pieces) {
  for (const LawPiece& p : pieces)
    if (p.c != 0.0 || p.product != 0.0) return false;
  return !pieces.empty();
}

/// The piece that holds at (x, x_dot), by the one rule that every method follows: the first whose bounds are
/// all positive. On a bound, or off all pieces by rounding, the one whose least bound, relative to the size
/// of its terms, is largest; of equals the first. 0 where the input is not finite.
int piece_at(std::span<const LawPiece> pieces, double x, double x_dot);

}  // namespace drev
