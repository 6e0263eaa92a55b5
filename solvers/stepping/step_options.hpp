#pragma once
/// StepOptions: how the equation of a step is solved (step_equation.hpp).
#include <drev/solvers/contact/newton_options.hpp>

namespace drev {

struct StepOptions {
  ContactNewtonOptions contact;
  /// Change of the loads between two passes, relative to the largest force so far [-].
  double load_tolerance = 1e-10;
  int max_load_passes = 30;
  /// More laws than this are solved with the sparse tangent; measured in docs/performance.md.
  int max_dense_contacts = 32;
  /// Steps vary in length: generalized-alpha's accelerations are carried over to the next step's length.
  bool varying_steps = false;
  bool time_phases = false;  ///< keep where the time goes (slows the run a little)
};

}  // namespace drev
