#include <drev/core/law/law_piece.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drev {

namespace {

void cut(Interval& range, double at, double direction) {
  if (direction > 0.0)
    range.low = std::max(range.low, at);
  else
    range.high = std::min(range.high, at);
}

}  // namespace

Interval LawPiece::x_range() const {
  Interval range;
  for (const LawBound& b : bounds)
    if (b.in_x_alone()) cut(range, b.kink(), b.b_x);
  return range;
}

Interval LawPiece::rate_range(double x) const {
  Interval range;
  for (const LawBound& b : bounds)
    if (b.b_v != 0.0) cut(range, -(b.a + b.b_x * x) / b.b_v, b.b_v);
  return range;
}

int piece_at(std::span<const LawPiece> pieces, double x, double x_dot) {
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (pieces[i].holds(x, x_dot)) return static_cast<int>(i);
  double best = -std::numeric_limits<double>::infinity();
  int piece = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (const LawBound& b : pieces[i].bounds) {
      const double size = std::abs(b.a) + std::abs(b.b_x * x) + std::abs(b.b_v * x_dot);
      least = std::min(least, size > 0.0 ? b.value(x, x_dot) / size : 0.0);
    }
    if (least > best) best = least, piece = static_cast<int>(i);
  }
  return piece;
}

}  // namespace drev
