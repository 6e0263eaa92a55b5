#include "models/scene.hpp"

#include "models/camshaft/build_camshaft.hpp"
#include "models/gear_drive/build_gear_drive.hpp"
#include "models/two_inertia/build_two_inertia.hpp"
#include "models/two_mass_backlash/build_two_mass_backlash.hpp"

namespace drev {

const std::vector<SceneEntry>& scenes() {
  static const std::vector<SceneEntry> all{two_inertia_entry(), two_mass_backlash_entry(), gear_drive_entry(),
                                           camshaft_entry()};
  return all;
}

const SceneEntry& find_scene(const std::string& name) {
  std::vector<std::string> names;
  for (const SceneEntry& entry : scenes()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw ModelError({{"drev", "model", name, "", "is no model" + did_you_mean(name, names)}});
}

Settings values_of(const SceneEntry& entry, const SettingList& settings) {
  Settings values(entry.name, entry.settings);
  for (const auto& [name, value] : settings) values.set(name, value);
  return values;
}

Scene build_scene(const std::string& model, const SettingList& settings) {
  const SceneEntry& entry = find_scene(model);
  return entry.build(values_of(entry, settings));
}

}  // namespace drev
