#include <drev/core/element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/distributed_shaft.hpp>

#include <cmath>

#include "elements/segment_chain.hpp"

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

std::vector<int> DistributedShaft::part_nodes(int part) const { return chain_nodes(part, params_.segments); }

void DistributedShaft::describe_part(int part, Terms& terms) const {
  describe_segment(part, segment_stiffness(), segment_inertia(), params_.mass, terms);
}

void DistributedShaft::describe(int nodes, Terms& terms) const { describe_chain(*this, nodes, terms); }

}  // namespace drev
