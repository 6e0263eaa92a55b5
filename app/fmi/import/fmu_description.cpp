#include "app/fmi/import/fmu_description.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <expat.h>
#include <map>
#include <memory>
#include <stdexcept>

namespace drev::app {

namespace {

using Type = ImportedVariable::Type;
using Attributes = std::map<std::string, std::string>;

std::string value_of(const Attributes& attributes, const char* name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? std::string() : found->second;
}

bool is_true(const Attributes& attributes, const char* name) {
  const std::string text = value_of(attributes, name);
  return text == "true" || text == "1";
}

/// FMI 2 names the type in a child of ScalarVariable, FMI 3 by the element itself.
Type type_of(const std::string& name) {
  static const std::map<std::string, Type> types{{"Real", Type::real},       {"Float64", Type::real},
                                                 {"Integer", Type::integer}, {"Int32", Type::integer},
                                                 {"Boolean", Type::boolean}, {"String", Type::text}};
  const auto found = types.find(name);
  return found == types.end() ? Type::other : found->second;
}

class Reader {
 public:
  FmuDescription read(const std::string& xml) {
    const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate(nullptr),
                                                                         XML_ParserFree);
    if (!parser) throw std::runtime_error("there is not enough memory");
    XML_SetUserData(parser.get(), this);
    XML_SetElementHandler(parser.get(), begin, end);
    if (XML_Parse(parser.get(), xml.data(), static_cast<int>(xml.size()), 1) == XML_STATUS_ERROR)
      throw std::runtime_error("line " + std::to_string(XML_GetCurrentLineNumber(parser.get())) + ": " +
                               XML_ErrorString(XML_GetErrorCode(parser.get())));
    if (version_.empty()) throw std::runtime_error("it has no fmiModelDescription");
    if (found_.fmi == 0)
      throw std::runtime_error("it is of FMI " + version_ + "; drev takes FMUs of FMI 2.0 and 3.0");
    if (found_.identifier.empty())
      throw std::runtime_error("it has no co-simulation; drev takes no FMU of model exchange alone");
    return std::move(found_);
  }

 private:
  static void begin(void* self, const char* name, const char** pairs) {
    Attributes attributes;
    for (; *pairs != nullptr; pairs += 2) attributes[pairs[0]] = pairs[1];
    static_cast<Reader*>(self)->open(name, attributes);
  }
  static void end(void* self, const char* /*name*/) { static_cast<Reader*>(self)->path_.pop_back(); }

  void open(const std::string& name, const Attributes& attributes) {
    const std::string parent = path_.empty() ? "" : path_.back();
    path_.push_back(name);
    if (path_.size() == 1 && name == "fmiModelDescription") {
      version_ = value_of(attributes, "fmiVersion");
      found_.fmi = version_.starts_with("3.") ? 3 : version_.starts_with("2.") ? 2 : 0;
      found_.model_name = value_of(attributes, "modelName");
      found_.token = value_of(attributes, found_.fmi == 3 ? "instantiationToken" : "guid");
    } else if (path_.size() == 2 && name == "CoSimulation") {
      found_.identifier = value_of(attributes, "modelIdentifier");
      found_.interpolates_inputs = is_true(attributes, "canInterpolateInputs");
    } else if (path_.size() == 3 && parent == "ModelVariables") {
      add_variable(name, attributes);
    } else if (path_.size() == 4 && parent == "ScalarVariable") {
      found_.variables.back().type = type_of(name);
      found_.variables.back().type_name = name;
      add_range(attributes);
    } else if (path_.size() == 4 && name == "Dimension" && !found_.variables.empty()) {
      found_.variables.back().array = true;
    }
  }

  void add_variable(const std::string& element, const Attributes& attributes) {
    const std::string causality = value_of(attributes, "causality");
    found_.variables.push_back({.name = value_of(attributes, "name"),
                                .reference = static_cast<unsigned>(std::strtoul(
                                    value_of(attributes, "valueReference").c_str(), nullptr, 10)),
                                .type = found_.fmi == 3 ? type_of(element) : Type::other,
                                .type_name = element,
                                .causality = causality.empty() ? "local" : causality,
                                .variability = value_of(attributes, "variability")});
    add_range(attributes);
  }
  /// FMI 2 has min and max beside the type, FMI 3 in the variable itself.
  void add_range(const Attributes& attributes) {
    const auto read = [&](const char* name, double& bound) {
      const std::string text = value_of(attributes, name);
      std::from_chars(text.data(), text.data() + text.size(), bound);
    };
    read("min", found_.variables.back().low);
    read("max", found_.variables.back().high);
  }

  FmuDescription found_;
  std::string version_;
  std::vector<std::string> path_;
};

}  // namespace

const ImportedVariable* FmuDescription::find(const std::string& name) const {
  const auto found =
      std::find_if(variables.begin(), variables.end(), [&](const auto& v) { return v.name == name; });
  return found == variables.end() ? nullptr : &*found;
}

std::vector<std::string> FmuDescription::names(std::string_view causality) const {
  std::vector<std::string> all;
  for (const ImportedVariable& v : variables)
    if (v.causality == causality) all.push_back(v.name);
  return all;
}

FmuDescription read_description(const std::string& xml) {
  try {
    return Reader().read(xml);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string("modelDescription.xml: ") + error.what());
  }
}

}  // namespace drev::app
