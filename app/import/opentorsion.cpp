#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "app/base/json_values.hpp"
#include "app/base/text_layout.hpp"
#include "app/import/imported.hpp"
#include "app/model_file/writing/field_writer.hpp"

namespace drev::app {

namespace {

constexpr double kShearModulus = 80e9, kDensity = 8000.0;  // of openTorsion, where none is given
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
    read_components();
    read_structure();
    for (const auto& [name, component] : components_)
      if (!ends_.contains(name)) starts_.push_back(name);
    if (starts_.size() != 1)
      fault("structure", "must connect all components into one train; " + std::to_string(starts_.size()) +
                             " of them begin one: " + join(starts_));
    const bool structured = findings_.empty();  // else what is not reached follows from what is said
    if (starts_.size() == 1) add_component(starts_.front(), new_node());
    for (const auto& [name, component] : components_) {
      if (added_.contains(name)) continue;
      if (structured) fault("structure", "connects " + name + " with no part of the train");
      add_component(name, new_node());  // for what is wrong inside
    }
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

  void read_components() {
    std::ptrdiff_t number = 0;
    for (const Json& component : json_["components"]) {
      const std::string place = numbered("components", number++);
      if (!component.is_object() || !component.value("name", Json()).is_string()) {
        fault(place, "has no name");
        continue;
      }
      const std::string name = component["name"];
      if (!components_.emplace(name, &component).second)
        fault(place, "has the name " + name + ", which another component has already");
      else if (!component.value("elements", Json()).is_array())
        fault(name, "has no list of elements");
    }
  }

  /// Names of its elements, in their order.
  std::vector<std::string> elements_of(const std::string& component) const {
    std::vector<std::string> names;
    const Json elements = components_.at(component)->value("elements", Json::array());
    if (elements.is_array())
      for (const Json& element : elements)
        if (element.is_object() && element.value("name", Json()).is_string())
          names.push_back(element["name"]);
    return names;
  }

  /// Whether "component.element" is one of the file.
  bool check_end(const std::string& place, const std::string& end) {
    const std::size_t dot = end.find('.');
    const std::string component = end.substr(0, dot);
    if (!components_.contains(component)) {
      std::vector<std::string> names;
      for (const auto& [name, json] : components_) names.push_back(name);
      fault(place, "names " + end + ", which is none of the components; there are " + join(names) +
                       did_you_mean(component, names));
      return false;
    }
    std::vector<std::string> ends;
    for (const std::string& element : elements_of(component)) ends.push_back(component + "." + element);
    if (std::find(ends.begin(), ends.end(), end) != ends.end()) return true;
    if (dot == end.npos)
      fault(place, "names " + end + ", a component, in place of one of its elements, " + join(ends));
    else
      fault(place,
            "names " + end + ", which is none of the elements " + join(ends) + did_you_mean(end, ends));
    return false;
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
      const bool known = check_end(place, from);
      if (components_.contains(next) && !ends_.insert(next).second)
        fault(place, "connects " + next + " a second time; a component begins in one place");
      if (check_end(place, to)) {
        if (const std::string first = next + "." + elements_of(next).front(); to != first)
          fault(place, "names " + to + "; a component is connected by its first element, " + first);
        else if (known)
          connections_[from].push_back(next);
      }
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
           (found.is_null() ? "is missing; it " : "") + (low == std::numeric_limits<double>::min()
                                                             ? std::string("must be a number > 0")
                                                             : "must be a number >= " + to_text(low))});
      return 1.0;
    }
    return found.get<double>();
  }

  /// Each component once: a ring of them is begun by none.
  void add_component(const std::string& name, std::string node) {
    if (!added_.insert(name).second) return;
    const Json elements = components_[name]->value("elements", Json::array());
    if (!elements.is_array()) return;  // blamed
    for (const Json& element : elements) {
      if (!element.is_object() || !element.value("name", Json()).is_string() ||
          !element.value("type", Json()).is_string()) {
        fault(name, "has an element without a name or a type");
        continue;
      }
      const std::string own = element["name"], place = name + "." + own;
      add_element(element, place, name + "_" + own, node);
      if (element.contains("excitation"))
        model_.not_taken("the excitation of " + place +
                         "; write it as an engine_order_torque or applied_torque");
      if (const auto next = connections_.find(place); next != connections_.end())
        for (const std::string& connected : next->second) add_component(connected, node);
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
      Gear gear;
      for (const char* size : {"teeth", "diameter"})
        if (element.contains(size) && !element[size].is_null())
          gear.sizes[size] = take(size, std::numeric_limits<double>::min());
      if (gear.sizes.empty()) fault(place, "has neither teeth nor a diameter");
      const Json parent = element.value("parent", Json());
      if (!parent.is_null() && !parent.is_string()) {
        fault(place + ".parent", "must be the name of a gear in quotes");
      } else if (parent.is_string() && !parent.get<std::string>().empty()) {
        const auto found = gears_.find(place.substr(0, place.find('.')) + "." + parent.get<std::string>());
        if (found == gears_.end()) {
          fault(place + ".parent", "names no gear before this one in its component");
        } else {
          const std::string driven = new_node();
          model_.add_element(name,
                             "type = \"ideal_gear\", nodes = " + toml_texts({found->second.node, driven}) +
                                 ", ratio = " + toml_number(ratio(place, found->second, gear)));
          node = driven;
        }
      }
      gear.node = node;
      gears_[place] = gear;
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

  struct Gear {
    std::string node;
    std::map<std::string, double> sizes;  ///< teeth, diameter or both
  };
  /// Of the speeds, driven to driving: by teeth, else by diameters, whichever both gears state.
  double ratio(const std::string& place, const Gear& driving, const Gear& driven) {
    for (const char* size : {"teeth", "diameter"})
      if (driving.sizes.contains(size) && driven.sizes.contains(size))
        return -driving.sizes.at(size) / driven.sizes.at(size);
    if (!driving.sizes.empty() && !driven.sizes.empty())
      fault(place, "has " + driven.sizes.begin()->first + " and its parent " + driving.sizes.begin()->first +
                       ": a ratio takes teeth of both, or diameters of both");
    return -1.0;
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
  std::map<std::string, Gear> gears_;
  std::set<std::string> ends_, added_;
  std::vector<std::string> starts_;
  std::vector<Finding> findings_;
};

}  // namespace

ImportedModel import_opentorsion(const std::string& text, const std::string& file) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::size_t at = std::min(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    const std::string said = error.what();
    const std::size_t why = said.find("unexpected ");
    throw ModelError({{file + ":" + std::to_string(line), "", "", "",
                       "is no JSON" + (why == said.npos ? "" : ": " + said.substr(why))}});
  } catch (const Json::out_of_range&) {
    throw ModelError({{file, "", "", "", "has a number that is too large: at most 1.8e308 can be read"}});
  }
  return OpenTorsionReader(json, file).read();
}

}  // namespace drev::app
