#pragma once
/// A shaft's segments in a row, each with stiffness k and inertia J; what DistributedShaft and contour shafts share:
///
///   K = k [1 -1; -1 1];   M = J/2 [1 0; 0 1] lumped, J/6 [2 1; 1 2] consistent, J/12 [5 1; 1 5] averaged
///
/// Nodes: a, b, then the internal ones from a to b.
#include <drev/core/element_interface.hpp>
#include <drev/elements/segment_count.hpp>

namespace drev {

/// Local nodes of a segment, 0 to segments - 1.
std::vector<int> chain_nodes(int segment, int segments);

/// Terms over a segment's two nodes, with an output of its number from 1 on. k [N m/rad], J [kg m^2].
void describe_segment(int segment, double stiffness, double inertia, SegmentMass mass, Terms& terms);

/// All segments in one, as Element::describe() gives them.
void describe_chain(const Element& element, int nodes, Terms& terms);

}  // namespace drev
