#pragma once
/// A model as it is to be run for one figure: what is simplified, and by which method.
#include <drev/solvers/reduction/reduction.hpp>

#include <optional>

#include "advice/figure_estimate.hpp"

namespace drev {

/// The system in the figure's start, by a run's rules. Throws SolverError where there is none, or a periodic one is no
/// steady state.
System started(System system, const FigureOptions& figure);

struct Recipe {
  Model model;
  FigureOptions figure;  ///< its channels have this model's names
  Method method = {};
  std::optional<ReductionOptions> reduction = {};
  /// Turns of the reference shaft after which the loads repeat themselves: the periodic response in place of
  /// a run.
  std::optional<double> turns = {};

  /// The system, in the figure's start; for turns in the model's initial conditions.
  System build() const;
  /// The figure, from the description on. Throws SolverError where it cannot be found.
  double run() const;
  /// The figure with its error, and the method that keeps it.
  FigureEstimate estimate();
};

}  // namespace drev
