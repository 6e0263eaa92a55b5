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
};

/// Tracks the chief orders of the channels over the run. A window holds four turns, two cycles of a four-stroke
/// engine; where the run would have more than kMostWindows of them, a multiple.
inline constexpr double kMostWindows = 400;
class RunUpWatch {
 public:
  /// full: the model; modes: of it, null: not found, and there are no criticals. system: what is run of it.
  /// inside: points inside steps may be asked for.
  RunUpWatch(const System& full, const ModeSet* modes, const System& system, double duration,
             const std::vector<std::string>& channels, bool inside);
  Observer* observer() { return tracking_.get(); }
  SpeedsPassed result() const;

 private:
  SpeedsPassed found_;
  std::unique_ptr<OrderTracking> tracking_;
};

}  // namespace drev::app
