#pragma once
/// Random drivetrains in the ranges of real ones.
#include <string>
#include <vector>

#include "tests/stability/coverage/spec.hpp"

namespace coverage {

/// 20 in 100 are linear, 50 have backlash that opens, the others tables, transmission errors, varying
/// stiffness, run-ups and twist feedback without it; `family` says which.
Spec random_spec(unsigned seed);

/// With one period, damped, its first node moving as given, so that the motion settles.
Spec random_periodic_spec(unsigned seed);

/// A dead band that a harmonic torque crosses over and over for 400 periods; most are chaotic.
Spec random_chaotic_spec(unsigned seed);

}  // namespace coverage
