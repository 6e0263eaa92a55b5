#include <drev/core/element.hpp>
#include <drev/elements/couplings/dead_band_coupling.hpp>

namespace drev {

void DeadBandCoupling::check(ParameterCheck& check) const {
  check.positive("stiffness", params_.stiffness, "N m/rad");
  check.non_negative("gap", params_.gap, "rad");
  check.non_negative("damping", params_.damping, "N m s/rad");
  if (!std::isnan(params_.reference_penetration))
    check.positive("reference_penetration", params_.reference_penetration, "rad");
}

void DeadBandCoupling::describe(int nodes, Terms& terms) const {
  terms.scalars.push_back({.b = relative_motion(nodes), .force = this});
  terms.speed_ratio_constraints.push_back(
      {.b = relative_motion(nodes), .only_in_contact = params_.gap > 0.0});
}

}  // namespace drev
