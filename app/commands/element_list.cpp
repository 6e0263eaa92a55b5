#include "app/commands/element_list.hpp"

#include <drev/app/model_file/element_table.hpp>

#include <algorithm>

#include "app/base/json_values.hpp"
#include "app/base/text_layout.hpp"

namespace drev::app {

namespace {

/// The keys of a type, and an element of their defaults.
struct ListedType {
  FieldKeys keys{NodeKind::rotational};
  std::shared_ptr<const Element> element;
};

ListedType listed(const ElementType& type) {
  ListedType found;
  found.element = type.make([&](const ListFields& list) { list(found.keys); });
  return found;
}

std::vector<FieldKeys::Key> keys_of(const ElementType& type) { return listed(type).keys.keys(); }

Json default_of(const FieldKeys::Key& key) {
  if (!key.default_text.empty()) return key.default_text;
  return key.need == Need::required ? Json() : number(key.default_number);
}

std::string key_of(const FieldKeys::Key& key) { return si_key(key.name, key.dimension); }
std::string translational_key_of(const FieldKeys::Key& key) {
  return si_key(key.other_name, key.other_dimension);
}

}  // namespace

std::string elements_as_text() {
  std::size_t width = 0;
  for (const ElementType& type : element_types()) width = std::max(width, type.name.size() + 2);
  std::string text;
  for (const ElementType& type : element_types()) {
    std::vector<std::string> words;
    for (const FieldKeys::Key& key : keys_of(type)) {
      std::string word = key_of(key) + (key.need == Need::required ? "*" : "");
      if (translational_key_of(key) != key_of(key)) word += " (" + translational_key_of(key) + ")";
      words.push_back(std::move(word));
    }
    if (!type.plugin.empty()) words.push_back("of " + type.plugin);
    text += pad_right(type.name, width) + wrap(join(words), width);
  }
  return text +
         "\nKeys with their SI unit; *: needed; (): on translational nodes. docs/model_file.md has the "
         "other\n"
         "units and says what each key means.\n";
}

std::string elements_as_json() {
  Json list = Json::array();
  for (const ElementType& type : element_types()) {
    Json keys = Json::array();
    const ListedType found = listed(type);
    for (const FieldKeys::Key& key : found.keys.keys())
      keys.push_back({{"name", key.name},
                      {"key", key_of(key)},
                      {"needed", key.need == Need::required},
                      {"default", default_of(key)},
                      {"translational_key", translational_key_of(key)}});
    list.push_back({{"type", type.name},
                    {"plugin", text_or_null(type.plugin)},
                    {"least_nodes", found.element->min_nodes()},
                    {"most_nodes", found.element->max_nodes()},
                    {"keys", std::move(keys)}});
  }
  return json_text({{"elements", std::move(list)}});
}

}  // namespace drev::app
