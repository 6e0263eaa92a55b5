#pragma once
/// What a run whose nominal speed changes passes: the criticals of its speeds, and the orders over them.
#include <drev/solvers/periodic/order_tracking.hpp>

#include <memory>
#include <string>
#include <vector>

#include "app/run/excitation.hpp"

namespace drev::app {

struct SpeedsPassed {
  SpeedRange range;
  /// Resonances of orders of the loads with modes (contacts closed) between the slowest and the fastest speed,
  /// the most excited first.
  std::vector<Crossing> criticals;
  std::vector<double> frequency_Hz;  ///< of the modes
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
  RunUpWatch(const System& full, const ModeSet* modes, const System& system, double duration,
             const std::vector<std::string>& channels, bool inside, bool waterfall);
  std::vector<Observer*> observers();
  SpeedsPassed result() const;

 private:
  SpeedsPassed found_;
  std::unique_ptr<OrderTracking> tracking_, waterfall_;  // the second: null where it is not wanted
};

}  // namespace drev::app
