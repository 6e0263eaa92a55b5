#pragma once
/// Peaks and critical speeds of a linear sweep between the speeds of its grid. Internal to sweep_linear().
///
/// A resonance of order o in the mode lambda is near w = Im lambda / o and about |Re lambda| / o wide, which
/// may be far less than the distance of two speeds. The speeds w and w -+ |Re lambda| / o are added to those
/// of the grid, so that every resonance has a point in its middle. Local maxima of each section at all these
/// speeds are then refined between their neighbours (solvers/periodic/bracketed_search.hpp), as is the largest heat of each
/// section. An order that meets an undamped mode is an infinite peak of every section that the mode moves.
///
/// A critical is in the section in which the mode's own part |r| / |Re lambda| of the order's amplitude is largest, with the
/// residue r of the amplitude at i o w = lambda from the shape of the damped mode (DampedPairs::residue()) with the damping at the
/// speed at which they meet.
#include <drev/solvers/periodic/linear_sweep.hpp>

#include "solvers/modes/damped_pairs.hpp"

namespace drev {

class LinearResponse;
class TrigonometricSum;

/// The modes of a sweep with their shapes, for each of the modes' speeds.
struct DampedPoles {
  DampedPairs pairs;
  std::function<ModeMatrices(double speed, double omega)> matrices;
  std::vector<double> jumps = {};  ///< speeds on both sides of those at which a load's slope or size jumps
  std::vector<Eigen::VectorXcd> lambda = {};  ///< of modes that coincide all; 0: not known
  std::vector<Eigen::MatrixXcd> shapes = {};  ///< over the unknowns
  /// A mode at a speed with the matrices there, from the nearest of the modes' speeds, at which it oscillates. Where no mode is found
  /// from there, or another one, the mode is that between the modes' speeds, with the damping and the shape of the nearest.
  DampedPole at(const SweepModes& modes, Eigen::Index mode, double speed);
};

/// Finds sweep.modes and growth, and what residues at these modes take; sweep.modes_note where modes are missing. Up to 400
/// unknowns all modes that swing, dense, at one speed or more. A mode that swings at some of the speeds only, and is overdamped
/// at the others, is 0 at these.
void find_sweep_modes(const System& system, LinearResponse& response, const std::function<void()>& pause,
                      LinearSweep& sweep, DampedPoles& poles);

/// Fills these, peaks and criticals. pause: as LinearSweepOptions::pause.
void find_sweep_peaks(const System& system, LinearResponse& response, TrigonometricSum& sum,
                      const std::function<void()>& pause, LinearSweep& sweep);

}  // namespace drev
