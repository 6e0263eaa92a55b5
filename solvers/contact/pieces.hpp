#pragma once
/// The pieces of a law, and which of them holds.
#include <drev/core/scalar_force.hpp>
#include <drev/core/system.hpp>

#include <span>
#include <vector>

namespace drev {

/// The stretches of x between a law's kinks, as pieces without forces of their own.
std::vector<LawPiece> stretches_between_kinks(const ScalarForce& force);
/// The `own` pieces of a term's law; where it has none, or where its stiffness follows the phase of a node, the
/// stretches between its kinks.
std::vector<LawPiece> pieces_or_stretches(const ScalarTerm& term, std::span<const LawPiece> own);
/// The piece that holds at the input: the first whose bounds are all positive. On a bound, or off all pieces
/// by rounding, the one whose least bound, relative to the size of its terms, is largest; of equals the first.
int piece_at(std::span<const LawPiece> pieces, const ScalarInput& in);

}  // namespace drev
