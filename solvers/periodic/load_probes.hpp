#pragma once
/// Angles at which a load is looked at to tell what it depends on, so that nothing of it stands unseen between them: a pulse
/// of two degrees, wherever it stands.
///
/// Of every load some angles that no division of a turn hits. Of one that states its table or its knots (KnottedLoad) besides
/// one in each piece. Of one that bounds its slopes (Load::steepest) besides those at which the part that may hide the largest
/// change is halved, until none may be far steeper than its ends show, or nothing of it counts. Others are looked at at the
/// first angles alone.
#include <drev/core/load.hpp>

#include <vector>

namespace drev {

struct LoadProbes {
  struct Probe {
    double angle = 0.0;
    double width =
        0.0;  ///< of the part in which it stands: rounding of the angle over it is that of the torque [rad]
    bool operator==(const Probe&) const = default;
  };
  static constexpr int kFirst = 24;  ///< number of those of every load, which come first
  std::vector<Probe> at;
  double finest =
      0.0;  ///< width of the narrowest part in which the torque was seen to change [rad]; 0: none was looked for
};

/// At a speed of the load's node [rad/s], over so many turns of it.
LoadProbes probes_of(const Load& load, double speed, int turns);

}  // namespace drev
