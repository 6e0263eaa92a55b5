#include <drev/core/element.hpp>
#include <drev/elements/applied_torque.hpp>
#include <drev/elements/cam_torque.hpp>
#include <drev/elements/engine_order_torque.hpp>

namespace drev {

void AppliedTorque::check(ParameterCheck& check) const {
  const int given =
      int(bool(params_.torque)) + int(params_.table.has_value()) + int(!params_.harmonics.empty());
  if (given != 1)
    check.fail("torque", given == 0 ? "nothing" : "several", "",
               "exactly one of torque, table and harmonics must be given");
  check.all_finite("breakpoints", params_.breakpoints, "s");
  if (params_.table) params_.table->check(check, "table", "N m");
  check_harmonics(check, "harmonics", params_.harmonics, "N m", false, "frequency", "Hz");
}

void AppliedTorque::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

void CamTorque::check(ParameterCheck& check) const {
  curve_.check(check, "angle_table", "rad", "N m");
  check.finite("phase", params_.phase, "rad");
  check.finite("scale", params_.scale, "");
}

void CamTorque::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

void EngineOrderTorque::check(ParameterCheck& check) const {
  check.finite("mean", params_.mean, "N m");
  check_harmonics(check, "harmonics", params_.harmonics, "N m", false);
}

void EngineOrderTorque::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

}  // namespace drev
