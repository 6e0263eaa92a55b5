#pragma once
/// Two inertias on one shaft: the smallest drivetrain, and the one to read first.
///
///   motor J_1 --- shaft k, c --- load J_2        free-free: one rigid mode and
///   f = sqrt(k (J_1 + J_2) / (J_1 J_2)) / (2 pi)
#include <drev/models/model_case.hpp>

namespace drev {

ModelCase build_two_inertia(Parameters parameters);
const ModelEntry& two_inertia_entry();

}  // namespace drev
