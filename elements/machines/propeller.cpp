#include <drev/core/element.hpp>
#include <drev/elements/machines/propeller.hpp>

namespace drev {

void Propeller::check(ParameterCheck& check) const {
  check.positive("rated_torque", params_.rated_torque, "N m");
  check.positive("rated_speed", params_.rated_speed, "rad/s");
  check.non_negative("damping_factor", params_.damping_factor, "");
  check_harmonics(check, "harmonics", params_.harmonics, "", false);
}

void Propeller::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

}  // namespace drev
