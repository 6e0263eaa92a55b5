#pragma once
/// The teeth of a pair in mesh, to draw: gear 1's centre at the origin, gear 2's at (0, a), a ring's at (0, -a), contact at
/// the pitch point (0, r_w1).
#include <drev/models/gears/gear_geometry.hpp>

#include <array>
#include <vector>

namespace drev {

using Outline = std::vector<std::array<double, 2>>;  ///< points, m

/// `teeth` (odd) consecutive teeth of a gear, 0 or 1, as one line.
Outline meshed_teeth(const GearPair& pair, int gear, int teeth);
/// The line of action from A to E.
Outline path_of_contact(const GearPair& pair);

}  // namespace drev
