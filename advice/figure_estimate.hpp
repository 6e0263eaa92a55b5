#pragma once
/// One figure of a run, the largest |value| of channels, with its error.
///
/// The error: twice the difference of two runs, at one tolerance and at a tighter one, and the tolerance. A
/// model with contacts whose two runs end in different states cannot be compared with itself from some time
/// on: its figure is then a statistic over runs that start 1e-9 beside each other, their mean with the
/// interval that holds one run in 95 % of all cases.
///
/// The method is the cheapest that keeps the accuracy: exact propagation, or constant steps of sdirk4, halved
/// until two differences in a row are small, where those take less time.
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/estimate.hpp>
#include <drev/solvers/run/peak.hpp>
#include <drev/solvers/start.hpp>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace drev {

class System;

struct FigureOptions {
  std::vector<std::string> channels = {};
  double from = 0.0, t_end = 0.0;  ///< s, the part of the run that counts
  double step = 0.0;               ///< s, for models that need constant steps
  Start start = Start::rest;       ///< of the system that a recipe builds
  double accuracy = 1e-3;          ///< relative, aimed at
  /// Processor time of one run beyond which there is no estimate [s].
  double most_seconds = std::numeric_limits<double>::infinity();
  std::vector<std::string> watch = {};  ///< further channels, of which the range over the run is noted
  std::function<void()> pause = {};     ///< called now and then; what it throws ends the estimate
};

/// Of the channels' unit, of a run with `method`. Of kind interval: mean and 95 % interval of one run.
struct FigureEstimate : Estimate {
  Method method = {};  ///< the cheapest tried that keeps the error
  std::vector<Peak> watched = {};
  std::string failure = {};  ///< why there is no value; empty: there is one
};

FigureEstimate estimate_figure(const System& system, const FigureOptions& options);

/// The figure of one run from the model's initial conditions. Throws SolverError where the run fails.
double figure_of_run(const System& system, const Method& method, const FigureOptions& options);

}  // namespace drev
