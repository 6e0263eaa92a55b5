#pragma once
/// A scene as a model file: every number in SI with the digits that read back to the same double.
#include <string>

#include "models/scene.hpp"

namespace drev::app {

/// Throws ModelError for what a file cannot hold: functions of one's own, elements of one's own.
std::string export_scene(const SceneEntry& entry, const Settings& settings, const Scene& scene);

}  // namespace drev::app
