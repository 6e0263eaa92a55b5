#pragma once
/// The periodic steady state under loads of one period, without the transient before it: harmonic balance
/// (harmonic_balance.hpp), with contacts, twist feedback and laws that are not linear as they are.
///
///   y(t) = Re sum_n a_n exp(i n w t), n = 0..H, w = 2 pi/T, 0 <= t < T
///
/// A periodic motion that satisfies the equations, and nothing more: whether it is stable, or the one that a
/// run from rest settles on where there are several (a gap that opens), harmonic balance does not tell; a
/// transient from near it does.
#include <drev/core/system.hpp>
#include <drev/solvers/run/peak.hpp>

#include <complex>
#include <functional>
#include <string>
#include <vector>

namespace drev {

struct PeriodicOptions {
  double period = 0.0;  ///< T [s]; 0: `turns` of the reference shaft
  int harmonics =
      0;  ///< H; 0: doubled until the error is within the tolerance, up to 4096; there 1e-2 is found, too
  double tolerance = 1e-6;  ///< relative, of the channels (of the motion, without any); >= 1e-10
  std::vector<std::string> channels = {};
  double turns = 1.0;  ///< of the reference shaft in a period; half orders need 2
};

struct PeriodicResponse {
  bool found = false;
  std::string reason;       ///< why not, in one sentence without full stop
  double period = 0.0;      ///< T [s]
  double order_step = 0.0;  ///< order of harmonic 1: periods a turn of the reference shaft; 0: it stands
  std::vector<Peak> peaks;  ///< of each channel over the period, times from its start
  /// a_n of each channel, [channel][n]: harmonic n has the order n order_step; a_0 is the mean.
  std::vector<std::vector<std::complex<double>>> amplitudes;
  int harmonics = 0;   ///< H
  int iterations = 0;  ///< of Newton's method, in all
  /// Estimated, relative to a channel's largest value: 10 times the sum of its largest difference from that with
  /// half the harmonics, of the step that is left to Newton's method and of what its series leaves out.
  double error = 0.0;
  bool contact_closed = true;  ///< where found: no law with a gap leaves its flank
  Vector z, v;                 ///< where found: unknowns and rates at t = 0, to start a run from
};

/// Not found, with the reason: parts that float, loads or known motions that do not have the period, an
/// undamped resonance, elements with a history, no convergence. Throws ModelError for bad options.
PeriodicResponse solve_periodic(const System& system, const PeriodicOptions& options);

/// Periodic response over speeds: amplitude curves of channels, and where each is largest.
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
