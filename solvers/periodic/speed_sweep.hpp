#pragma once
/// Periodic response over speeds: amplitude curves of channels, and where each is largest.
#include <drev/solvers/periodic/periodic_response.hpp>

#include <functional>

namespace drev {

struct SpeedSweep {
  struct Point {
    double speed = 0.0;  ///< in the caller's unit
    PeriodicResponse response;
  };
  std::vector<Point> curve;  ///< at the speeds given
  /// Of each channel: where its amplitude is largest, sought between the neighbours of the largest point
  /// of the curve (solvers/periodic/bracketed_maximum.hpp), to 1e-4 of their distance. A resonance narrower than the grid can be missed.
  struct Worst {
    double speed = 0.0, amplitude = 0.0;
  };
  std::vector<Worst> worst;
};

/// build: the model at a speed. options: period 0, since it changes with the speed. A speed without response
/// is a point of the curve that says why, and has no part in the search. Throws ModelError for no channels,
/// for speeds that do not rise, for a given period.
SpeedSweep sweep_speeds(const std::function<System(double speed)>& build, const std::vector<double>& speeds,
                        const PeriodicOptions& options);

}  // namespace drev
