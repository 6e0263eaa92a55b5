#pragma once
/// The periodic steady state under loads of one period, without the transient before it, by harmonic balance
/// (harmonic_balance.hpp). Contacts, twist feedback and nonlinear laws are included without simplification.
///
///   y(t) = Re sum_n a_n exp(i n w t), n = 0..H, w = 2 pi/T, 0 <= t < T
///
/// The result is a periodic motion that satisfies the equations. Harmonic balance does not tell whether it is
/// stable, nor, where there are several motions (a gap that opens), which of them a run from rest settles on;
/// a transient that starts near it does.
#include <drev/core/system.hpp>
#include <drev/solvers/run/peak.hpp>

#include <complex>
#include <functional>
#include <string>
#include <vector>

namespace drev {

struct PeriodicOptions {
  double period = 0.0;  ///< T [s]; 0: the time of `turns` turns of the reference shaft
  /// H; 0: doubled until the error is within the tolerance, up to 4096, where an error of up to 1e-2 is
  /// accepted.
  int harmonics = 0;
  double tolerance = 1e-6;  ///< relative tolerance of channels, or of the motion [-]; >= 1e-10
  std::vector<std::string> channels = {};
  double turns = 1.0;  ///< turns of the reference shaft in a period; half orders need 2
};

struct PeriodicResponse {
  bool found = false;
  std::string reason;       ///< why no response was found, in one sentence without full stop
  double period = 0.0;      ///< T [s]
  double order_step = 0.0;  ///< order of harmonic 1: periods per turn of the reference shaft; 0: at rest
  std::vector<Peak> peaks;  ///< peaks of each channel over the period, with times from its start
  /// a_n of each channel: [channel][n]. Harmonic n has the order n order_step; a_0 is the mean.
  std::vector<std::vector<std::complex<double>>> amplitudes;
  int harmonics = 0;   ///< H
  int iterations = 0;  ///< total iterations of Newton's method
  /// Estimated error relative to a channel's largest value [-]: 10 times the sum of its largest difference
  /// from the solution with half the harmonics, of the next Newton step and of the truncation error of its
  /// series.
  double error = 0.0;
  bool contact_closed = true;  ///< if found: true where no law with a gap leaves its flank
  Vector z, v;                 ///< if found: unknowns and rates at t = 0, from which a run can start
};

/// Gives found = false and the reason for: floating parts, loads or prescribed motions that do not have the
/// period, an undamped resonance, elements with a history, no convergence. Throws ModelError for invalid
/// options.
PeriodicResponse solve_periodic(const System& system, const PeriodicOptions& options);

/// Periodic response over speeds: amplitude curves of channels, and the speed at which each is largest.
struct SpeedSweep {
  struct Point {
    double speed = 0.0;  ///< speed in the caller's unit
    PeriodicResponse response;
  };
  std::vector<Point> curve;  ///< points at the speeds given
  /// For each channel the speed at which its amplitude is largest. It is searched between the neighbours of
  /// the largest point of the curve (solvers/periodic/bracketed_search.hpp), to 1e-4 of their distance. A
  /// resonance narrower than the distance of speeds can be missed.
  struct Worst {
    double speed = 0.0, amplitude = 0.0;
  };
  std::vector<Worst> worst;
};

/// build: makes the model at a speed. options: the period must be 0, since it changes with the speed. A speed
/// without a response is a point of the curve with the reason and is left out of the search. Throws
/// ModelError without channels, for speeds that do not ascend and for a given period.
SpeedSweep sweep_speeds(const std::function<System(double speed)>& build, const std::vector<double>& speeds,
                        const PeriodicOptions& options);

}  // namespace drev
