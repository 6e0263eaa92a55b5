#include "models/gears/meshed_teeth.hpp"

#include <drev/core/units.hpp>

#include <cmath>

namespace drev {

Outline meshed_teeth(const GearPair& pair, int gear, int teeth) {
  constexpr int kPoints = 12;
  const ToothContour& c = pair.contour(gear);
  const double t = gear == 0 ? pair.pitch_point() : pair.second_length(pair.pitch_point());
  // The right flank at t (of a ring the left one) is turned to the line of centres; teeth follow clockwise.
  const bool ring = pair.is_ring(gear);
  const double first = (ring ? -1.0 : 1.0) * c.flank(t).angle, pitch = kTwoPi / pair.gear(gear).teeth;
  const Outline right = c.points(kPoints);
  Outline line;
  const auto add = [&](double x, double y, double turned) {  // turned against the clock
    const double s = std::sin(turned), k = std::cos(turned), px = x * k - y * s, py = x * s + y * k;
    if (gear == 0 || ring)
      line.push_back({px, ring ? py - pair.centre_distance() : py});
    else
      line.push_back({-px, pair.centre_distance() - py});
  };
  for (int i = teeth / 2; i >= -(teeth / 2); --i) {
    const double turned = first + i * pitch;
    for (auto p = right.rbegin(); p != right.rend(); ++p) add(-(*p)[0], (*p)[1], turned);
    for (std::size_t k = 1; k < right.size(); ++k) add(right[k][0], right[k][1], turned);
  }
  return line;
}

Outline path_of_contact(const GearPair& pair) {
  // Base circle 1 is touched at alpha_w against the clock; the line runs to the right and up.
  const double angle = pair.operating_angle(), base = pair.contour(0).base_radius();
  Outline line;
  for (const double t : {pair.start_of_contact(), pair.end_of_contact()})
    line.push_back(
        {-base * std::sin(angle) + t * std::cos(angle), base * std::cos(angle) + t * std::sin(angle)});
  return line;
}

}  // namespace drev
