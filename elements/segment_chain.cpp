#include "elements/segment_chain.hpp"

#include <drev/core/element.hpp>

namespace drev {

std::vector<int> chain_nodes(int segment, int segments) {
  const auto local = [segments](int position) {
    return position == 0 ? 0 : position == segments ? 1 : position + 1;
  };
  return {local(segment), local(segment + 1)};
}

void describe_segment(int segment, double stiffness, double inertia, SegmentMass mass, Terms& terms) {
  const double coupled = mass == SegmentMass::lumped       ? 0.0
                         : mass == SegmentMass::consistent ? inertia / 6.0
                                                           : inertia / 12.0;
  const LocalRow b = relative_motion(2);
  terms.mass.diagonal().setConstant(0.5 * inertia - coupled);
  terms.mass(0, 1) = terms.mass(1, 0) = coupled;
  terms.stiffness = stiffness * b * b.transpose();
  terms.outputs.push_back(
      {.suffix = std::to_string(segment + 1), .stiffness = stiffness * b, .damping = LocalRow::Zero(2)});
  terms.speed_ratio_constraints.push_back({.b = b});
  terms.rayleigh = true;
}

void describe_chain(const Element& element, int nodes, Terms& terms) {
  for (int segment = 0; segment < element.part_count(); ++segment) {
    const std::vector<int> own = element.part_nodes(segment);
    const auto spread = [&](const LocalRow& row) {
      LocalRow wide = LocalRow::Zero(nodes);
      wide(own) = row;
      return wide;
    };
    Terms part(2);
    element.describe_part(segment, part);
    terms.mass(own, own) += part.mass;
    terms.stiffness(own, own) += part.stiffness;
    for (OutputSpec& o : part.outputs)
      terms.outputs.push_back({std::move(o.suffix), spread(o.stiffness), spread(o.damping)});
    for (const SpeedRatioConstraint& c : part.speed_ratio_constraints)
      terms.speed_ratio_constraints.push_back({.b = spread(c.b)});
  }
  terms.rayleigh = true;
}

}  // namespace drev
