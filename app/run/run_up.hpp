#pragma once
/// What a run whose speed changes passes: the criticals of its speeds, and the orders over them.
///
/// Speeds are the nominal ones, where the nominal speed changes. Where nothing turns nominally (a start from rest, whose
/// speed its torques make), or the nominal speed changes and the reference shaft floats freely under torques of its
/// actual angle, orders are of the actual angle of a node, and speeds the actual mean speed of each window.
#include <drev/core/model.hpp>
#include <drev/solvers/periodic/order_tracking.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/run/excitation.hpp"

namespace drev::app {

/// Whose actual angle the orders of a run are of.
struct OrderShaft {
  std::string node;              ///< empty: of none, its nominal speed changes or does not
  std::optional<System> turned;  ///< the model that turns nominally with it, for ratios and orders
};
/// Whether orders of such a run are of an actual angle.
bool turns_actually(const System& system, double duration);
/// The model with this node as its reference shaft, or as it is where it has one; nullopt: the node is tied to ground.
std::optional<System> turned_with(const Model& model, const System& system, const std::string& node);
/// Where turns_actually(): the node named, or, that empty, the first of driven_nodes() that can turn (the orders of its
/// torque are counted by its own turns).
OrderShaft order_shaft(const Model& model, const System& system, const std::string& named, double duration);

struct SpeedsPassed {
  SpeedRange range;  ///< of an actual angle: of the start and the windows
  /// Resonances of orders of the loads with modes (contacts closed) between the slowest and the fastest speed,
  /// the most excited first.
  std::vector<Crossing> criticals;
  std::vector<double> frequency_Hz;  ///< of the modes
  std::vector<std::string>
      unknown;  ///< elements with a torque whose orders are not known (Excitation::unknown)
  OrderTracks orders;
  double turns = 0.0;  ///< of the reference shaft in a window of the tracking
  /// Amplitudes of evenly spaced orders, in the same windows: the waterfall. None where it was not wanted.
  OrderTracks waterfall;
};

/// Tracks the chief orders of the channels over the run. A window holds four turns, two cycles of a four-stroke
/// engine; where the run would have more than kMostWindows of them, a multiple. The waterfall's orders are half of what
/// is told apart from each other, up to 12 or a quarter beyond the highest chief order, at most kMostLines.
inline constexpr double kMostWindows = 400;
inline constexpr int kMostLines = 96;
class RunUpWatch {
 public:
  /// full: the model; modes: of it, null: not found, and there are no criticals. system: what is run of it.
  /// inside: points inside steps may be asked for. waterfall: whether it is wanted.
  /// shaft: of order_shaft().
  RunUpWatch(const System& full, const ModeSet* modes, const System& system, double duration,
             const std::vector<std::string>& channels, bool inside, bool waterfall,
             const OrderShaft& shaft = {});
  std::vector<Observer*> observers();
  /// None: an actual angle that did not turn through two windows.
  std::optional<SpeedsPassed> result() const;

 private:
  std::vector<Crossing> crossings_;
  SpeedsPassed found_;
  std::unique_ptr<OrderTracking> tracking_, waterfall_;  // the second: null where it is not wanted
};

}  // namespace drev::app
