#pragma once
/// Two inertias on one shaft: the smallest drivetrain, and the one to read first.
///
///   motor J_1 --- shaft k, c --- load J_2        free-free: one rigid mode and
///   f = sqrt(k (J_1 + J_2) / (J_1 J_2)) / (2 pi)
#include "models/scene.hpp"

namespace drev {

Scene build_two_inertia(Settings settings);
const SceneEntry& two_inertia_entry();

}  // namespace drev
