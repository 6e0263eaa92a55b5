#include "app/run/static_force.hpp"

#include <drev/core/error.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/statics.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/base/text_layout.hpp"

namespace drev::app {

namespace {

constexpr int kTimes = 64;            // at which loads are asked whether they follow time
constexpr double kSameTorque = 1e-9;  // relative

const std::string& element_of(const System& system, ElementId element) {
  return system.element_instances()[idx(index(element))].name;
}

/// A load that is another one at another time, at the same angle and speed; empty: none.
std::string follows_time(const System& system, double duration) {
  for (const LoadTerm& term : system.loads()) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < kTimes; ++i) {
      const double torque = term.load->evaluate({.t = duration * (i + 0.5 * (i % 3)) / kTimes}).torque;
      low = std::min(low, torque), high = std::max(high, torque);
    }
    if (high - low > kSameTorque * std::max(std::abs(low), std::abs(high)))
      return element_of(system, term.element) + " follows the time, not the angle of the shaft";
  }
  for (int k = 0; k < system.prescribed_count(); ++k)
    if (system.prescribed()[static_cast<std::size_t>(k)].at)
      return system.node_names()[static_cast<std::size_t>(system.prescribed_node(k))] +
             " moves in time as given";
  return {};
}

/// Deviations of the turning nodes that loads act on.
std::vector<Channel> loaded_angles(const System& system) {
  std::set<int> nodes;
  for (const LoadTerm& term : system.loads())
    if (system.ratio(term.node) != 0.0) nodes.insert(term.node);
  std::vector<std::string> names;
  for (const int node : nodes)
    names.push_back(system.node_names()[static_cast<std::size_t>(node)] + ".angle_rad");
  return find_channels(system, names);
}

}  // namespace

std::optional<Largest> largest_of(const std::vector<Channel>& channels, const std::vector<Peak>& peaks) {
  std::optional<Largest> largest;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const double value = peaks[c].amplitude();
    if (!std::isfinite(value)) return {};
    if (!largest || value > largest->value)
      largest = Largest{value, channels[c].name(), channels[c].unit(), peaks[c].time()};
  }
  return largest;
}

StaticForce find_static_force(const System& system, const std::vector<Channel>& channels, double turn,
                              double duration) {
  if (turn == 0.0 || channels.empty()) return {{}, "this model has no turn over which it would be sought"};
  if (!system.floating_parts(Contact::closed).empty())
    return {{}, "the model is free to turn, so there is no equilibrium"};
  if (const std::string what = follows_time(system, duration); !what.empty())
    return {{}, what + ", so that an equilibrium would be that of one instant"};
  std::vector<Channel> all = channels;
  const std::vector<Channel> angles = loaded_angles(system);
  all.insert(all.end(), angles.begin(), angles.end());
  try {
    std::vector<Peak> peaks = static_sweep(system, all, 0.0, turn, kStaticAngles);
    const std::vector<Peak> of_angles(peaks.begin() + static_cast<std::ptrdiff_t>(channels.size()),
                                      peaks.end());
    peaks.resize(channels.size());
    const std::optional<Largest> far = largest_of(angles, of_angles), largest = largest_of(channels, peaks);
    if (!largest || (!angles.empty() && !far)) return {{}, "it is not finite"};
    if (far && far->value > kFarFromNominal * std::abs(turn))
      return {{},
              "at rest the loads would turn " + far->place() + " " + digits(to_deg(far->value), 3) +
                  " degrees from its nominal angle, against something soft such as a spring to ground: no "
                  "torque that the turning drive carries"};
    return {largest, {}};
  } catch (const SolverError& error) {
    return {{}, error.what()};
  }
}

}  // namespace drev::app
