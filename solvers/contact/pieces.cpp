#include "solvers/contact/pieces.hpp"

#include <span>

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

std::vector<LawPiece> bounds_alone(const ScalarForce& force) {
  const std::span<const LawPiece> own = force.pieces();
  if (own.empty()) return stretches_between_kinks(force);
  std::vector<LawPiece> pieces(own.size());
  for (std::size_t i = 0; i < own.size(); ++i) pieces[i].bounds = own[i].bounds;
  return pieces;
}

std::vector<LawPiece> pieces_or_stretches(const ScalarTerm& term) {
  const std::span<const LawPiece> own = term.force->pieces();
  if (own.empty() || term.phase_node >= 0) return stretches_between_kinks(*term.force);
  return {own.begin(), own.end()};
}

}  // namespace drev
