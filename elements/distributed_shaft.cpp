#include <drev/core/units.hpp>
#include <drev/elements/distributed_shaft.hpp>

#include <cmath>

namespace drev {

namespace {

double polar_area_moment(const DistributedShaft::Params& p) {
  return kPi / 32.0 * (std::pow(p.outer_diameter, 4) - std::pow(p.inner_diameter, 4));
}

}  // namespace

// Asked for when the element enters the model, before check(): an absurd count must not create
// nodes.
std::vector<NodeKind> DistributedShaft::internal_nodes() const {
  const bool sound = params_.segments >= 1 && params_.segments <= kMaxSegments;
  return std::vector(sound ? static_cast<std::size_t>(params_.segments - 1) : 0, NodeKind::rotational);
}

void DistributedShaft::check(ParameterCheck& check) const {
  check.positive("shear_modulus", params_.shear_modulus, "Pa");
  check.non_negative("density", params_.density, "kg/m^3");
  check.positive("outer_diameter", params_.outer_diameter, "m");
  check.non_negative("inner_diameter", params_.inner_diameter, "m");
  if (params_.inner_diameter >= params_.outer_diameter)
    check.fail("inner_diameter", to_text(params_.inner_diameter), "m",
               "must be less than outer_diameter, " + to_text(params_.outer_diameter));
  check.positive("length", params_.length, "m");
  if (params_.segments < 1 || params_.segments > kMaxSegments)
    check.fail("segments", std::to_string(params_.segments), "",
               "must be between 1 and " + std::to_string(kMaxSegments));
  if (params_.density == 0.0 && params_.segments > 1)
    check.fail("segments", std::to_string(params_.segments), "",
               "must be 1 where density is 0: internal nodes would have no inertia");
}

double DistributedShaft::segment_stiffness() const {
  return params_.shear_modulus * polar_area_moment(params_) * params_.segments / params_.length;
}

double DistributedShaft::segment_inertia() const {
  return params_.density * polar_area_moment(params_) * params_.length / params_.segments;
}

// Positions along the shaft 0..n in the element's node order: a, b, internal.
std::vector<int> DistributedShaft::part_nodes(int part) const {
  const auto local = [n = params_.segments](int position) {
    return position == 0 ? 0 : position == n ? 1 : position + 1;
  };
  return {local(part), local(part + 1)};
}

void DistributedShaft::describe_part(int part, Terms& terms) const {
  const double k = segment_stiffness(), j = segment_inertia();
  const double coupled = params_.mass == SegmentMass::lumped       ? 0.0
                         : params_.mass == SegmentMass::consistent ? j / 6.0
                                                                   : j / 12.0;
  const LocalRow b = relative_motion(2);
  terms.mass.diagonal().setConstant(0.5 * j - coupled);
  terms.mass(0, 1) = terms.mass(1, 0) = coupled;
  terms.stiffness = k * b * b.transpose();
  terms.outputs.push_back(
      {.suffix = std::to_string(part + 1), .stiffness = k * b, .damping = LocalRow::Zero(2)});
  terms.speed_ratio_constraints.push_back({.b = b});
  terms.rayleigh = true;
}

void DistributedShaft::describe(int nodes, Terms& terms) const {
  for (int part = 0; part < params_.segments; ++part) {
    const std::vector<int> own = part_nodes(part);
    const auto spread = [&](const LocalRow& row) {
      LocalRow wide = LocalRow::Zero(nodes);
      wide(own) = row;
      return wide;
    };
    Terms segment(2);
    describe_part(part, segment);
    terms.mass(own, own) += segment.mass;
    terms.stiffness(own, own) += segment.stiffness;
    for (OutputSpec& o : segment.outputs)
      terms.outputs.push_back({std::move(o.suffix), spread(o.stiffness), spread(o.damping)});
    for (const SpeedRatioConstraint& c : segment.speed_ratio_constraints)
      terms.speed_ratio_constraints.push_back({.b = spread(c.b)});
  }
  terms.rayleigh = true;
}

}  // namespace drev
