#include <drev/core/element.hpp>
#include <drev/elements/dashpot.hpp>
#include <drev/elements/ground_spring.hpp>
#include <drev/elements/ideal_gear.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/modal_damping.hpp>
#include <drev/elements/shaft_spring.hpp>

namespace drev {

void Dashpot::check(ParameterCheck& check) const {
  check.non_negative("damping", params_.damping, "N m s/rad");
}

void Dashpot::describe(int nodes, Terms& terms) const {
  const LocalRow b = relative_motion(nodes);
  terms.damping = params_.damping * b * b.transpose();
  terms.outputs.push_back({.suffix = "", .stiffness = LocalRow::Zero(nodes), .damping = params_.damping * b});
}

void GroundSpring::check(ParameterCheck& check) const {
  check.positive("stiffness", params_.stiffness, "N m/rad");
  check.non_negative("damping", params_.damping, "N m s/rad");
}

void GroundSpring::describe(int nodes, Terms& terms) const {
  const LocalRow b = relative_motion(nodes);
  terms.stiffness(0, 0) = params_.stiffness;
  terms.damping(0, 0) = params_.damping;
  terms.speed_ratio_constraints.push_back({.b = b});
  terms.outputs.push_back({.suffix = "", .stiffness = params_.stiffness * b, .damping = params_.damping * b});
}

void IdealGear::check(ParameterCheck& check) const {
  check.finite("ratio", params_.ratio, "");
  if (params_.ratio == 0.0) check.fail("ratio", "0", "", "must not be 0");
}

void IdealGear::describe(int nodes, Terms& terms) const {
  LocalRow b(nodes);
  b << params_.ratio, -1.0;
  terms.constraints.push_back(b);
}

void Inertia::check(ParameterCheck& check) const { check.positive("inertia", params_.inertia, "kg m^2"); }

void Inertia::describe(int /*nodes*/, Terms& terms) const {
  terms.mass(0, 0) = params_.inertia;
  terms.rayleigh = true;
}

void ModalDamping::check(ParameterCheck& check) const {
  const Params& p = params_;
  if (std::isnan(p.ratio) == p.ratios.empty())
    check.fail("ratio", p.ratios.empty() ? "nothing" : "both", "",
               "exactly one of ratio and ratios (by_mode) must be given");
  if (!std::isnan(p.ratio)) check.within("ratio", p.ratio, 0.0, 1.0, "");
  for (const double xi : p.ratios) check.within("ratios", xi, 0.0, 1.0, "");
  if (damping_.size() == 0)
    check.fail("damping", "none", "", "follows from the whole train: use add_modal_damping()");
}

void ModalDamping::describe(int nodes, Terms& terms) const {
  if (damping_.rows() == nodes) terms.deviation_damping = damping_;
}

void ShaftSpring::check(ParameterCheck& check) const {
  check.positive("stiffness", params_.stiffness, "N m/rad");
  check.non_negative("damping", params_.damping, "N m s/rad");
}

void ShaftSpring::describe(int nodes, Terms& terms) const {
  const LocalRow b = relative_motion(nodes);
  terms.stiffness = params_.stiffness * b * b.transpose();
  terms.damping = params_.damping * b * b.transpose();
  terms.rayleigh = true;
  terms.speed_ratio_constraints.push_back({.b = b});
  terms.outputs.push_back({.suffix = "", .stiffness = params_.stiffness * b, .damping = params_.damping * b});
}

}  // namespace drev
