#include "app/model_file/part.hpp"

#include <drev/elements/not_given.hpp>

#include <algorithm>

namespace drev::app {

bool LeftOut::may_have(const std::string& name) const {
  const std::string stem = name.substr(0, name.find('*'));
  const bool pattern = stem.size() < name.size();
  return std::any_of(elements.begin(), elements.end(), [&](const std::string& element) {
    return stem == element || stem.starts_with(element + "_") || stem.starts_with(element + ".") ||
           (pattern && (element.starts_with(stem) || stem.starts_with(element)));
  });
}

Finding placed(Finding finding, const Part& part, const std::string& place) {
  // Parameters of the catalogue that go by another name, or by several, in a file.
  static const std::multimap<std::string, std::string> renamed{{"angle_table", "table"},
                                                               {"x", "points"},
                                                               {"x", "dead_band"},
                                                               {"x", "with_stops"},
                                                               {"y", "points"},
                                                               {"y", "dead_band"},
                                                               {"y", "with_stops"},
                                                               {"omega", "constant_speed"},
                                                               {"inertia", "mass"},
                                                               {"torque", "force"},
                                                               {"initial deviation", "initial_angle"},
                                                               {"initial deviation", "initial_position"},
                                                               {"initial rate", "initial_speed"},
                                                               {"initial rate", "initial_velocity"},
                                                               {"omega_0", "run_up"},
                                                               {"omega_1", "run_up"}};
  const std::string stem = finding.parameter.substr(0, finding.parameter.find_first_of(".["));
  FieldPlace best{part.at};
  const auto try_name = [&](const std::string& name) {
    for (const auto& [field, at] : part.fields)
      if (field.starts_with(name) && field.find('.') == std::string::npos) best = at;
  };
  const auto [first, last] = renamed.equal_range(stem);
  for (auto other = first; other != last; ++other) try_name(other->second);
  try_name(stem.starts_with("node") ? "node" : stem + "_");
  const auto exact = part.fields.find(stem);
  if (exact != part.fields.end()) best = exact->second;
  // A field of a table inside the part's, whose parameter goes by its own name or by that of the inner table, too; else
  // the row that it is of.
  const std::string whole = finding.parameter.ends_with("]")
                                ? finding.parameter.substr(0, finding.parameter.rfind('['))
                                : finding.parameter;
  const bool found = exact != part.fields.end() && whole == stem;
  for (const std::string& name : {finding.parameter.substr(0, finding.parameter.find(']') + 1), whole})
    for (const auto& [field, at] : part.fields)
      if (!found && !name.empty() && (field == name || field.ends_with("." + name))) best = at;
  // A file cannot say NaN: what has this value, and stands nowhere, was not given.
  if (finding.value == to_text(kNotGiven) && best.at.text() == part.at.text()) {
    finding.value.clear();
    finding.range = "is missing: " + finding.range;
  }
  if (!best.given.empty() && !finding.value.empty()) finding.range += " (given as " + best.given + ")";
  finding.place = best.at.text() + ": " + place;
  return finding;
}

std::vector<Finding> placed(const ModelError& error, const std::string& model, const Position& file,
                            const std::map<std::string, Part>& nodes,
                            const std::map<std::string, Part>& elements) {
  std::vector<Finding> all;
  for (const Finding& finding : error.findings()) {
    const std::string prefix = model + "/";
    const std::string name =
        finding.place.starts_with(prefix) ? finding.place.substr(prefix.size()) : finding.value;
    const auto node = nodes.find(name), element = elements.find(name);
    // A node and an element may have one name.
    const bool of_node = node != nodes.end() &&
                         (element == elements.end() || finding.parameter == "mass" ||
                          finding.parameter == "omega" || finding.parameter == "prescribed motion" ||
                          finding.parameter == "node name" || finding.parameter.starts_with("initial") ||
                          finding.range.find("not prescribed") != std::string::npos);
    const Part& part = of_node ? node->second : element != elements.end() ? element->second : Part{file};
    all.push_back(placed(finding, part, finding.place));
  }
  return all;
}

void remove_repeated(std::vector<Finding>& findings) {
  std::set<std::string> seen;
  std::erase_if(findings, [&](const Finding& f) {
    const std::size_t of_model = f.place.find(": ");
    const std::string parameter = of_model == std::string::npos ? "" : f.parameter;
    return !seen.insert(f.place.substr(0, of_model) + "\n" + parameter + "\n" + f.range).second;
  });
}

void limit_findings(std::vector<Finding>& findings, const Position& file) {
  remove_repeated(findings);
  if (findings.size() <= kMostFaults) return;
  const std::size_t more = findings.size() - kMostFaults;
  findings.resize(kMostFaults);
  findings.push_back(fault_at(file, "the file", "has " + std::to_string(more) + " more faults at least"));
}

}  // namespace drev::app
