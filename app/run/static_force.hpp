#pragma once
/// The static torque (force) that a run's largest one is compared with: the largest |value| over the channels in
/// static equilibrium, inertia and damping left out, while the reference shaft stands at kStaticAngles + 1
/// even angles of the turn.
///
/// It means something where turning slowly would give it. It is not stated, with the reason, where
///   - there is no turn, or no equilibrium (a part floats),
///   - a load or a known motion follows the time itself: at rest it would be that of one instant,
///   - the equilibrium takes a loaded shaft further than kFarFromNominal of the turn from its nominal angle:
///     then something soft holds the drive, most often a spring to ground, and what it would carry at rest is
///     no measure of what the turning drive carries.
#include <drev/core/channel.hpp>
#include <drev/core/system.hpp>
#include <drev/solvers/run/peak.hpp>

#include <optional>
#include <string>
#include <vector>

#include "app/run/run_result.hpp"

namespace drev::app {

inline constexpr int kStaticAngles = 1440;
inline constexpr double kFarFromNominal = 0.01;

struct StaticForce {
  std::optional<Largest> largest;
  std::string reason;  ///< why there is none; a sentence without full stop
};

/// turn: rad, of the reference shaft; 0: none. duration: s, over which loads are asked whether they follow time.
StaticForce find_static_force(const System& system, const std::vector<Channel>& channels, double turn,
                              double duration);

/// Of channels with these peaks; nullopt without channels, or where one is not finite.
std::optional<Largest> largest_of(const std::vector<Channel>& channels, const std::vector<Peak>& peaks);

}  // namespace drev::app
