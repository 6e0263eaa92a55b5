#include "app/model_file/key_finder.hpp"

#include "app/model_file/node_fields.hpp"

namespace drev::app {

std::string list_of(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

KeyFinder::KeyFinder(const Value& table, const std::string& where, const std::set<std::string>& others,
                     const FieldKeys& keys, ReadContext& context)
    : table_(table), where_(where), context_(context) {
  for (const Entry& entry : table.entries)
    if (!others.contains(entry.key)) recognise(entry, others, keys);
}

const KeyFinder::Found* KeyFinder::find(const std::string& name) const {
  const auto found = found_.find(name);
  return found == found_.end() ? nullptr : &found->second;
}

void KeyFinder::missing(const std::string& name, const std::string& spelled) {
  if (!refused_.contains(name)) context_.findings.push_back(fault_at(table_.at, where_, "lacks " + spelled));
}

void KeyFinder::recognise(const Entry& entry, const std::set<std::string>& others, const FieldKeys& keys) {
  for (const FieldKeys::Key& key : keys.keys()) {
    if (!entry.key.starts_with(key.name)) continue;
    if (key.dimension == Dimension::none) {
      if (entry.key == key.name) return take(key.name, {&entry, ""});
      continue;
    }
    for (const Unit& unit : units_of(key.dimension))
      if (entry.key == key.name + "_" + unit.suffix)
        return take(key.name, {&entry, unit.suffix, unit.factor});
  }
  std::vector<std::string> known(others.begin(), others.end());
  for (const FieldKeys::Key& key : keys.keys()) {
    if (key.dimension == Dimension::none) known.push_back(key.name);
    for (const Unit& unit : units_of(key.dimension)) known.push_back(key.name + "_" + unit.suffix);
  }
  const auto refuse = [&](const std::string& sentence) {
    context_.findings.push_back(fault_at(entry.at, where_ + "." + entry.key, sentence));
  };
  const FieldKeys::Key* stem = nullptr;  // the longest name that the key begins with
  for (const FieldKeys::Key& key : keys.keys()) {
    if (key.dimension != Dimension::none &&
        (entry.key == key.name || entry.key.starts_with(key.name + "_")) &&
        (stem == nullptr || key.name.size() > stem->name.size()))
      stem = &key;
    for (const Unit& unit : units_of(key.other_dimension))
      if (entry.key == key.other_name + "_" + unit.suffix) {
        refused_.insert(key.name);
        const auto kind = static_cast<std::size_t>(keys.kind);
        return refuse("belongs to " + node_kind_names()[1 - kind] + " nodes; on a " +
                      node_kind_names()[kind] + " one it is " + spellings(key.name, key.dimension));
      }
  }
  if (stem != nullptr) {
    refused_.insert(stem->name);
    const std::string right = spellings(stem->name, stem->dimension);
    if (entry.key == stem->name) return refuse("needs a unit: " + right);
    return refuse("has no unit that fits; it must be " + right + did_you_mean(entry.key, known));
  }
  const std::string hint = did_you_mean(entry.key, known);
  std::vector<std::string> si(others.begin(), others.end());
  for (const FieldKeys::Key& key : keys.keys()) si.push_back(si_key(key.name, key.dimension));
  // It may have been meant to be the one that is missing.
  const std::string meant = nearest_name(entry.key, known);
  for (const FieldKeys::Key& key : keys.keys())
    if (meant == key.name || (key.dimension != Dimension::none && meant.starts_with(key.name + "_")))
      refused_.insert(key.name);
  refuse("is unknown here" + (hint.empty() ? "; there are " + list_of(si) : hint));
}

void KeyFinder::take(const std::string& name, Found found) {
  const auto [place, fresh] = found_.emplace(name, found);
  if (!fresh)
    context_.findings.push_back(fault_at(found.entry->at, where_ + "." + found.entry->key,
                                         "is there already, as " + place->second.entry->key));
}

}  // namespace drev::app
