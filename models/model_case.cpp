#include <drev/models/model_case.hpp>
#include <drev/models/ready_made.hpp>

#include "models/two_inertia/build_two_inertia.hpp"

namespace drev {

const std::vector<ModelEntry>& ready_made_models() {
  static const std::vector<ModelEntry> all{two_inertia_entry(), two_mass_backlash_entry(), gear_drive_entry(),
                                           camshaft_entry()};
  return all;
}

const ModelEntry& find_model(const std::string& name) {
  std::vector<std::string> names;
  for (const ModelEntry& entry : ready_made_models()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw ModelError({{"drev", "model", name, "", "is no model" + did_you_mean(name, names)}});
}

Parameters values_of(const ModelEntry& entry, const ParameterValues& parameters) {
  Parameters values(entry.name, entry.parameters);
  for (const auto& [name, value] : parameters) values.set(name, value);
  return values;
}

ModelCase build_case(const std::string& model, const ParameterValues& parameters) {
  const ModelEntry& entry = find_model(model);
  return entry.build(values_of(entry, parameters));
}

}  // namespace drev
