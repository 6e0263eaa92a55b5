#pragma once
/// Peaks and criticals of a linear sweep between the speeds of its grid. Internal to sweep_linear().
///
/// A resonance of order o in the mode lambda stands near w = Im lambda / o and is about |Re lambda| / o wide, which
/// may be far less than the distance of two speeds. The speeds w, w -+ |Re lambda| / o join those of the grid, so
/// that every resonance has a point in its middle; local maxima of each section among all of them are then sought
/// between their neighbours (solvers/periodic/bracketed_maximum.hpp).
#include <drev/solvers/periodic/linear_sweep.hpp>

namespace drev {

class LinearResponse;
class TrigonometricSum;

/// Fills sweep.modes, peaks and criticals. pause: of LinearSweepOptions.
void find_sweep_peaks(const System& system, LinearResponse& response, TrigonometricSum& sum,
                      const std::function<void()>& pause, LinearSweep& sweep);

}  // namespace drev
