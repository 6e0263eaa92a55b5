#include <drev/app/model_file/fields.hpp>
#include <drev/core/error.hpp>
#include <drev/elements/formula.hpp>

namespace drev::app {

void Fields::guarded(const std::function<void()>& make) {
  try {
    make();
  } catch (const ModelError& error) {
    refused(error);
  }
}

void FieldKeys::add(const Quantity& quantity, Need need, double default_number) {
  const NodeKind other = kind == NodeKind::rotational ? NodeKind::translational : NodeKind::rotational;
  keys_.push_back({.name = quantity.name(kind),
                   .dimension = quantity.dimension(kind),
                   .other_name = quantity.name(other),
                   .other_dimension = quantity.dimension(other),
                   .need = need,
                   .default_number = default_number});
}

void FieldKeys::plain(const std::string& name, Need need, std::string default_text) {
  keys_.push_back({.name = name, .other_name = name, .need = need, .default_text = std::move(default_text)});
}

const FieldKeys::Key* FieldKeys::find(const std::string& name) const {
  for (const Key& key : keys_)
    if (key.name == name) return &key;
  return nullptr;
}

void FieldKeys::number(const Quantity& quantity, double& value, Need need) { add(quantity, need, value); }
void FieldKeys::whole(const std::string& name, int& value, Need need) {
  plain(name, need, std::to_string(value));
}
void FieldKeys::flag(const std::string& name, bool& value) {
  plain(name, Need::optional, value ? "true" : "false");
}
void FieldKeys::text(const std::string& name, std::string& value) { plain(name, Need::optional, value); }
void FieldKeys::file(const std::string& name, std::string& /*path*/, Need need) { plain(name, need); }
void FieldKeys::texts(const std::string& name, std::vector<std::string>& /*values*/) { plain(name); }
void FieldKeys::choice(const std::string& name, const std::vector<std::string>& words, int& index) {
  plain(name, Need::optional, words[static_cast<std::size_t>(index)]);
}
void FieldKeys::formula(const std::string& name, const std::vector<FormulaVariable>& /*variables*/,
                        const std::string& /*unit*/, std::optional<Formula>& /*formula*/) {
  plain(name, Need::required);
}
bool FieldKeys::columns(const std::string& name, const std::vector<Column>& /*columns*/) {
  plain(name);
  return false;
}
bool FieldKeys::group(const std::string& name, const std::function<void(Fields&)>& /*list*/) {
  plain(name);
  return false;
}
bool FieldKeys::rows(const std::string& name, std::size_t /*count*/,
                     const std::function<void(std::size_t)>& /*resize*/,
                     const std::function<void(Fields&, std::size_t)>& /*list*/) {
  plain(name);
  return false;
}

}  // namespace drev::app
