#pragma once
/// Indices that cannot be swapped by accident: a node is not an element. And what a node is.
#include <cstddef>

namespace drev {

enum class NodeId : int {};     ///< position of a node in its Model, from 0
enum class ElementId : int {};  ///< position of an element in its Model, from 0

/// What a node's one degree of freedom is.
enum class NodeKind : unsigned char {
  rotational,    ///< angle [rad], torque [N m], inertia [kg m^2]
  translational  ///< position [m], force [N], mass [kg]
};

constexpr int index(NodeId id) { return static_cast<int>(id); }
constexpr int index(ElementId id) { return static_cast<int>(id); }
/// Signed index into a std container (avoids sign conversions at every call).
constexpr std::size_t idx(int i) { return static_cast<std::size_t>(i); }

}  // namespace drev
