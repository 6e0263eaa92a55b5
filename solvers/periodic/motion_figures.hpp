#pragma once
/// MotionFigures: what one periodic motion comes to, over the sections of a sweep.
#include <drev/core/system.hpp>

#include <complex>

namespace drev {

struct MotionFigures {
  bool separates = false;                           ///< a contact opens in the cycle
  Vector maximum, minimum, mean;                    ///< maximum and minimum with the mean
  Vector twist_mean, twist_maximum, twist_minimum;  ///< a law's: of its deflection
  Vector heat;                                      ///< W
  Eigen::MatrixXcd amplitude;                       ///< orders x sections, of exp(i order phi)
  Vector z, v;                                      ///< unknowns and rates where phi = 0, to start a run from
  Vector left_over;  ///< mean torque, of each part that floats [N m at the reference shaft]
};

}  // namespace drev
