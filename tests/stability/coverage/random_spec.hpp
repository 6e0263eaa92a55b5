#pragma once
/// Random drivetrains in the ranges of real ones.
#include <string>
#include <vector>

#include "tests/stability/coverage/spec.hpp"

namespace coverage {

/// 20 in 100 are linear, 50 have backlash that opens, the others tables, transmission errors, varying
/// stiffness, run-ups and twist feedback without it; `family` says which.
Spec random_spec(unsigned seed);

/// The same with the nominal speed or the loads' frequency constant, damped, and with one period.
Spec random_periodic_spec(unsigned seed);

}  // namespace coverage
