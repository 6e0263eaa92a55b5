#include "app/import/imported.hpp"

#include <algorithm>

#include "app/base/text_layout.hpp"
#include "app/model_file/writing/field_writer.hpp"

namespace drev::app {

void ImportedModel::add_node(const std::string& name) { nodes_.push_back(name); }

bool ImportedModel::has_node(const std::string& name) const {
  return std::find(nodes_.begin(), nodes_.end(), name) != nodes_.end();
}

void ImportedModel::add_element(const std::string& name, const std::string& body) {
  std::string free = name;
  for (int i = 2; std::find(element_names_.begin(), element_names_.end(), free) != element_names_.end(); ++i)
    free = name + "_" + std::to_string(i);
  element_names_.push_back(free);
  elements_.push_back(toml_key(free) + " = { " + body + " }");
}

void ImportedModel::add_section(const std::string& element, const std::string& body) {
  sections_.push_back(toml_key(element) + " = { " + body + " }");
}

std::string ImportedModel::toml(const std::string& source) const {
  std::string text = "# Read from " + source + " by drev import.\n";
  for (const std::string& sentence : not_taken_) text += "# Not taken over: " + sentence + "\n";
  text += "format = 1\nname = " + toml_text(name_) + "\nnote = " + toml_text("read from " + source) +
          "\n\n[nodes]\n";
  for (const std::string& node : nodes_) text += toml_key(node) + " = {}\n";
  text += "\n[elements]\n";
  for (const std::string& element : elements_) text += element + "\n";
  if (!sections_.empty()) text += "\n[class.sections]\n";
  for (const std::string& section : sections_) text += section + "\n";
  return text;
}

}  // namespace drev::app
