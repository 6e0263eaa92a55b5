#pragma once
/// MotionFigures: results of one periodic motion, in vectors over the sections of a sweep.
#include <drev/core/system.hpp>

#include <complex>

namespace drev {

struct MotionFigures {
  bool separates = false;                           ///< true: a contact opens in the cycle
  Vector maximum, minimum, mean;                    ///< maximum and minimum include the mean
  Vector twist_mean, twist_maximum, twist_minimum;  ///< twist of the element; of a law its deflection
  Vector heat;                                      ///< mean heat of each section [W]
  Eigen::MatrixXcd amplitude;                       ///< amplitudes of exp(i order phi), orders x sections
  Vector z, v;                                      ///< unknowns and rates at phi = 0: start of a run
  Vector left_over;  ///< unbalanced mean torque of each floating part [N m at the reference shaft]
};

}  // namespace drev
