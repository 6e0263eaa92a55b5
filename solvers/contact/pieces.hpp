#pragma once
/// The pieces of a law, or what stands for them.
#include <drev/core/scalar_force.hpp>
#include <drev/core/system.hpp>

#include <vector>

namespace drev {

/// The bounds of a law's pieces; where it has none, the stretches of x between its kinks: pieces without forces
/// of their own.
std::vector<LawPiece> bounds_alone(const ScalarForce& force);
/// The stretches of x between a law's kinks, as pieces without forces of their own.
std::vector<LawPiece> stretches_between_kinks(const ScalarForce& force);
/// The pieces of a term's law; where it has none, or follows the phase of a node, the stretches between its
/// kinks.
std::vector<LawPiece> pieces_or_stretches(const ScalarTerm& term);

}  // namespace drev
