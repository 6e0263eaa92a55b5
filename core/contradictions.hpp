#pragma once
/// What a law, a load or an element says of itself twice must agree: a law's pieces, kinks, gap, closed slopes, the formula
/// of its scale, and that its energy does not follow the time, with its call; a load's table, stretch, harmonics, knots with
/// their curves, curves scaled by the speed, and frequencies with its call; an element's parts with its description. Each
/// method takes what serves it best; a contradiction would give other results by another method.
#include <drev/core/load.hpp>
#include <drev/core/scalar_force.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drev {

class Element;
struct Terms;

struct Contradiction {
  std::string what;    ///< what does not agree with the call, e.g. "pieces"
  std::string detail;  ///< where, and both values
};

/// The first found by an evaluation or two for each piece, table or stretch: for every model that is built.
std::optional<Contradiction> first_contradiction(const ScalarForce& law);
std::optional<Contradiction> first_contradiction(const Load& load);

/// All found at many points: inside each piece, on both sides of each bound, and at the inputs given.
std::vector<Contradiction> contradictions(const ScalarForce& law, std::span<const ScalarInput> at);
std::vector<Contradiction> contradictions(const Load& load, std::span<const LoadInput> at);
/// Of the parts of an element, against what describe() says over all its nodes; none where it has no parts.
std::vector<Contradiction> contradictions(const Element& element, int nodes, const Terms& whole);

}  // namespace drev
