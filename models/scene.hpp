#pragma once
/// A scene: an assembled model together with what is worth knowing to run it and to read its results.
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/model.hpp"
#include "models/settings.hpp"

namespace drev {

struct Scene {
  Model model;
  double duration = 1.0;       ///< s
  double default_step = 1e-4;  ///< s; the model's header says why
  std::string note = {};       ///< e.g. that the data are a reconstruction; shown with every result
  /// Channels whose largest |value| is reported as the deflection (may be empty) and as the torques.
  std::string deflection = {};
  std::vector<std::string> torques = {};
  /// Turn of the reference shaft over which the static torque is sought [rad]; 0: not meaningful.
  double static_turn = 0.0;
  /// Channels recorded unless others are asked for.
  std::vector<std::string> channels = {};
};

struct SceneEntry {
  std::string name;
  std::string summary;
  std::vector<Setting> settings;
  /// Throws ModelError for settings that cannot be.
  std::function<Scene(Settings)> build;
};

/// Every ready-made model, in the order in which a newcomer should read them.
const std::vector<SceneEntry>& scenes();
/// By name; throws ModelError with the nearest name.
const SceneEntry& find_scene(const std::string& name);

using SettingList = std::vector<std::pair<std::string, std::string>>;
/// The defaults of a model with these settings in their place.
Settings values_of(const SceneEntry& entry, const SettingList& settings);
/// A ready-made model with settings; throws ModelError for a name or settings that cannot be.
Scene build_scene(const std::string& model, const SettingList& settings);

}  // namespace drev
