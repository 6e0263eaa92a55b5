#include <drev/core/error.hpp>

#include <cmath>
#include <map>
#include <set>

#include "app/base/json_values.hpp"
#include "app/base/text_layout.hpp"
#include "app/import/imported.hpp"
#include "app/model_file/writing/field_writer.hpp"

namespace drev::app {

namespace {

constexpr double kShearModulus = 80e9, kDensity = 8000.0;  // of openTorsion, where none is given
constexpr int kMostConnected = 1000;                       // components in one chain
const std::map<std::string, const char*> kUnits{
    {"inertia", "kg m^2"}, {"stiffness", "N m/rad"}, {"damping", "N m s/rad"}, {"length", "mm"},
    {"diameter", "mm"},    {"outerDiameter", "mm"},  {"innerDiameter", "mm"},  {"density", "kg/m^3"}};

class OpenTorsionReader {
 public:
  OpenTorsionReader(const Json& json, std::string file)
      : json_(json), file_(std::move(file)), model_(stem_of(file_)) {}

  ImportedModel read() {
    if (!json_.is_object() || !json_.contains("components") || !json_["components"].is_array())
      throw ModelError({{file_, "components", "", "", "is missing: this is no JSON of openTorsion"}});
    for (const Json& component : json_["components"])
      if (component.is_object() && component.value("name", Json()).is_string())
        components_[component["name"].get<std::string>()] = &component;
      else
        fault(numbered("components", &component - &json_["components"].front()), "has no name");
    read_structure();
    for (const auto& [name, component] : components_)
      if (!ends_.contains(name)) starts_.push_back(name);
    if (starts_.size() != 1)
      fault("structure", "must connect all components into one train; " + std::to_string(starts_.size()) +
                             " of them begin one: " + join(starts_));
    if (findings_.empty()) add_component(starts_.front(), new_node(), 0);
    if (!findings_.empty()) throw ModelError(std::move(findings_));
    return std::move(model_);
  }

 private:
  static std::string stem_of(const std::string& file) {
    const std::size_t slash = file.rfind('/');
    const std::string name = slash == file.npos ? file : file.substr(slash + 1);
    return name.substr(0, name.rfind('.'));
  }
  void fault(const std::string& place, const std::string& what) {
    findings_.push_back({file_ + ": " + place, "", "", "", what});
  }
  static std::string numbered(const std::string& list, std::ptrdiff_t number) {
    return list + "[" + std::to_string(number) + "]";
  }

  /// [["component.element", "component.element"], ...]
  void read_structure() {
    if (!json_.contains("structure")) return;
    std::ptrdiff_t number = 0;
    for (const Json& pair : json_["structure"]) {
      const std::string place = numbered("structure", number++);
      if (!pair.is_array() || pair.size() != 2 || !pair[0].is_string() || !pair[1].is_string()) {
        fault(place, "must be a pair of names, [\"component.element\", \"component.element\"]");
        continue;
      }
      const std::string from = pair[0], to = pair[1];
      const std::string next = to.substr(0, to.find('.'));
      if (!components_.contains(next)) fault(place, "names " + to + ", which is none of the components");
      if (!components_.contains(from.substr(0, from.find('.'))))
        fault(place, "names " + from + ", which is none of the components");
      connections_[from].push_back(next);
      ends_.insert(next);
    }
  }

  std::string new_node() {
    std::string name = "node_" + std::to_string(model_.node_count());
    model_.add_node(name);
    return name;
  }

  double value(const Json& element, const char* key, const std::string& place, double low,
               double fallback = NAN) {
    const Json found = element.value(key, Json());
    if (found.is_null() && !std::isnan(fallback)) return fallback;
    if (!found.is_number() || !(found.get<double>() >= low)) {
      const auto unit = kUnits.find(key);
      findings_.push_back(
          {file_ + ": " + place, key, found.is_null() ? "" : found.dump(),
           unit == kUnits.end() ? "" : unit->second,
           (found.is_null() ? "is missing; it " : "") + std::string("must be a number >= ") + to_text(low)});
      return 1.0;
    }
    return found.get<double>();
  }

  void add_component(const std::string& name, std::string node, int depth) {
    if (depth > kMostConnected) return fault("structure", "connects components in a ring");
    const Json elements = components_[name]->value("elements", Json::array());
    for (const Json& element : elements) {
      if (!element.is_object() || !element.value("name", Json()).is_string() ||
          !element.value("type", Json()).is_string()) {
        fault(name, "has an element without a name or a type");
        continue;
      }
      const std::string own = element["name"], place = name + "." + own;
      add_element(element, place, name + "_" + own, node);
      nodes_[place] = node;
      if (element.contains("excitation"))
        model_.not_taken("the excitation of " + place +
                         "; write it as an engine_order_torque or applied_torque");
      if (const auto next = connections_.find(place); next != connections_.end())
        for (const std::string& connected : next->second) add_component(connected, node, depth + 1);
    }
  }

  /// Adds it at the node, and moves on to the node where it ends.
  void add_element(const Json& element, const std::string& place, const std::string& name,
                   std::string& node) {
    const std::string type = element["type"];
    std::set<std::string> known{"name", "type", "excitation"};
    const auto take = [&](const char* key, double low, double fallback = NAN) {
      known.insert(key);
      return value(element, key, place, low, fallback);
    };
    const std::string at = "node = " + toml_text(node);
    if (type == "Disk") {
      if (const double inertia = take("inertia", 0.0); inertia > 0.0)
        model_.add_element("J_" + name,
                           "type = \"inertia\", " + at + ", inertia_kg_m2 = " + toml_number(inertia));
      add_ground(name, at, take("damping", 0.0, 0.0));
    } else if (type == "ShaftDiscrete" || type == "ShaftContinuous") {
      const std::string next = new_node(), nodes = "nodes = " + toml_texts({node, next});
      if (type == "ShaftDiscrete") {
        model_.add_element(name, "type = \"shaft_spring\", " + nodes +
                                     ", stiffness_Nm_per_rad = " + toml_number(take("stiffness", 0.0)) +
                                     ", damping_Nms_per_rad = " + toml_number(take("damping", 0.0, 0.0)));
      } else {
        model_.add_element(name, "type = \"distributed_shaft\", " + nodes +
                                     ", shear_modulus_Pa = " + toml_number(kShearModulus) +
                                     ", density_kg_per_m3 = " + toml_number(take("density", 0.0, kDensity)) +
                                     ", outer_diameter_mm = " + toml_number(take("outerDiameter", 0.0)) +
                                     ", inner_diameter_mm = " + toml_number(take("innerDiameter", 0.0, 0.0)) +
                                     ", length_mm = " + toml_number(take("length", 0.0)));
      }
      node = next;
    } else if (type == "GearElement") {
      known.insert("parent");
      const char* size = element.contains("teeth") ? "teeth" : "diameter";
      const double radius = take(size, 0.0);
      const std::string parent = place.substr(0, place.find('.')) + "." + element.value("parent", "");
      if (const auto found = gears_.find(parent); found != gears_.end()) {
        const std::string driven = new_node();
        model_.add_element(name,
                           "type = \"ideal_gear\", nodes = " + toml_texts({found->second.first, driven}) +
                               ", ratio = " + toml_number(-found->second.second / radius));
        node = driven;
      } else if (element.contains("parent") && element["parent"].is_string() &&
                 !element["parent"].get<std::string>().empty()) {
        fault(place + ".parent", "names no gear before this one in its component");
      }
      gears_[place] = {node, radius};
      const std::string here = "node = " + toml_text(node);
      if (const double inertia = take("inertia", 0.0); inertia > 0.0)
        model_.add_element("J_" + name,
                           "type = \"inertia\", " + here + ", inertia_kg_m2 = " + toml_number(inertia));
      add_ground(name, here, take("damping", 0.0, 0.0));
    } else {
      model_.not_taken("the element " + place + " of type " + type);
      return;
    }
    for (const auto& item : element.items())
      if (!known.contains(item.key())) model_.not_taken("\"" + item.key() + "\" of " + place);
  }

  void add_ground(const std::string& name, const std::string& at, double damping) {
    if (damping > 0.0)
      model_.add_element("c_" + name,
                         "type = \"dashpot\", " + at + ", damping_Nms_per_rad = " + toml_number(damping));
  }

  const Json& json_;
  std::string file_;
  ImportedModel model_;
  std::map<std::string, const Json*> components_;
  std::map<std::string, std::vector<std::string>> connections_;
  std::map<std::string, std::string> nodes_;
  std::map<std::string, std::pair<std::string, double>> gears_;  ///< node, and teeth or diameter
  std::set<std::string> ends_;
  std::vector<std::string> starts_;
  std::vector<Finding> findings_;
};

}  // namespace

ImportedModel import_opentorsion(const std::string& text, const std::string& file) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw ModelError({{file, "", "", "", "is no JSON"}});
  return OpenTorsionReader(json, file).read();
}

}  // namespace drev::app
