#pragma once
/// What was put in and what dissipated in a step, integrated by Gauss's rule over the step's polynomial:
/// for methods whose order the monitor's mean of both ends would hide.
///
///   input = int p v dt + known motions' work + what varying laws gained at constant deflection
///
/// The last as E_1 - E_0 - int (y x' - dissipated) dt, from the law's own force.
#include <utility>

#include "solvers/stepping/step_equation.hpp"

namespace drev {

class StepEnergy {
 public:
  /// Input and dissipation [J] from `from` to `to`, h [s] apart; moves the assembler's time.
  std::pair<double, double> over(StepEquation& equation, const EvaluatedState& from, const EvaluatedState& to,
                                 double h);

 private:
  EvaluatedState inside_;
};

}  // namespace drev
