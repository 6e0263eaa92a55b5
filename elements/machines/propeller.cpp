#include <drev/core/element.hpp>
#include <drev/elements/machines/propeller.hpp>

#include <array>

#include "core/law/ranged.hpp"

namespace drev {

void Propeller::check(ParameterCheck& check) const {
  check.positive("rated_torque", params_.rated_torque, "N m");
  check.positive("rated_speed", params_.rated_speed, "rad/s");
  check.non_negative("damping_factor", params_.damping_factor, "");
  check_harmonics(check, "harmonics", params_.harmonics, "", false);
}

void Propeller::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

std::optional<LoadSlopes> Propeller::steepest(const LoadRanges& over) const {
  const std::array<Ranged, 3> x = variables_of(over);
  Ranged harmonics;
  for (const Harmonic& h : params_.harmonics)
    harmonics = harmonics + h.amplitude * cos(h.order * x[0] + h.phase);
  return slopes_of(torque(x[1], harmonics, size_of(over.nominal_speed)));
}

}  // namespace drev
