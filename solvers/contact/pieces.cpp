#include "solvers/contact/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drev {

std::vector<LawPiece> stretches_between_kinks(const ScalarForce& force) {
  const std::span<const double> kinks = force.kinks();
  std::vector<LawPiece> pieces(kinks.size() + 1);
  for (std::size_t i = 0; i < kinks.size(); ++i) {
    const int below = static_cast<int>(i);
    pieces[i].bounds.push_back({kinks[i], -1.0, 0.0, below + 1});
    pieces[i + 1].bounds.push_back({-kinks[i], 1.0, 0.0, below});
  }
  return pieces;
}

std::vector<LawPiece> pieces_or_stretches(const ScalarTerm& term, std::span<const LawPiece> own) {
  if (own.empty() || term.phase_node >= 0) return stretches_between_kinks(*term.force);
  return {own.begin(), own.end()};
}

int piece_at(std::span<const LawPiece> pieces, const ScalarInput& in) {
  const auto value = [&](const LawBound& b) { return b.a + b.b_x * in.x + b.b_v * in.x_dot; };
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (std::ranges::all_of(pieces[i].bounds, [&](const LawBound& b) { return value(b) > 0.0; }))
      return static_cast<int>(i);
  // On a bound, or off all pieces by rounding: where the least, by its terms' size, is largest.
  double best = -std::numeric_limits<double>::infinity();
  int piece = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (const LawBound& b : pieces[i].bounds) {
      const double size = std::abs(b.a) + std::abs(b.b_x * in.x) + std::abs(b.b_v * in.x_dot);
      least = std::min(least, size > 0.0 ? value(b) / size : 0.0);
    }
    if (least > best) best = least, piece = static_cast<int>(i);
  }
  return piece;
}

}  // namespace drev
