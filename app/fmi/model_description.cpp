#include "app/fmi/model_description.hpp"

#include <drev/app/model_file/units.hpp>
#include <drev/core/version.hpp>

#include <map>
#include <string_view>
#include <utility>

namespace drev::app {

namespace {

/// Exponents of SI base units in the units of channels.
const std::map<std::string, std::string>& base_units() {
  static const std::map<std::string, std::string> all{{"s", "s=\"1\""},
                                                      {"rad", "rad=\"1\""},
                                                      {"rad/s", "rad=\"1\" s=\"-1\""},
                                                      {"rad/s^2", "rad=\"1\" s=\"-2\""},
                                                      {"m", "m=\"1\""},
                                                      {"m/s", "m=\"1\" s=\"-1\""},
                                                      {"m/s^2", "m=\"1\" s=\"-2\""},
                                                      {"N", "kg=\"1\" m=\"1\" s=\"-2\""},
                                                      {"N m", "kg=\"1\" m=\"2\" s=\"-2\""},
                                                      {"kg", "kg=\"1\""},
                                                      {"kg m^2", "kg=\"1\" m=\"2\""},
                                                      {"Hz", "s=\"-1\""}};
  return all;
}

/// The same of a parameter's unit, as keys of a model file spell it ("Nm_per_rad"), with its factor into SI; empty: it is none.
std::string base_of_key(const std::string& unit) {
  const auto radians = [](Dimension d) {
    if (d == Dimension::angle || d == Dimension::angular_speed) return 1;
    return d == Dimension::torsional_stiffness || d == Dimension::torsional_damping ? -1 : 0;
  };
  for (const NamedDimension& d : dimensions())
    for (const Unit& known : units_of(d.dimension)) {
      if (unit != known.suffix) continue;
      const UnitParts parts = unit_parts(unit);
      std::string text;
      const auto add = [&](const char* name, double value, double left_out) {
        if (value != left_out)
          text += (text.empty() ? "" : " ") + std::string(name) + "=\"" + to_text(value) + "\"";
      };
      add("kg", parts.kg, 0.0), add("m", parts.m, 0.0), add("s", parts.s, 0.0);
      add("rad", radians(d.dimension), 0.0), add("factor", parts.factor, 1.0);
      return text;
    }
  return {};
}

/// A parameter's unit as channels spell it: "Nm_per_rad" is N m/rad, "kg_m2" kg m^2.
std::string as_of_channel(std::string unit) {
  constexpr std::pair<const char*, const char*> kSpelled[] = {
      {"Nms", "N m s"}, {"Nm", "N m"}, {"Ns", "N s"}, {"kgm2", "kg m2"}, {"_per_", "/"},
      {"per_", "1/"},   {"_", " "},    {"m2", "m^2"}, {"m3", "m^3"}};
  for (const auto& [key, spelled] : kSpelled)
    if (const std::size_t at = unit.find(key); at != unit.npos)
      unit.replace(at, std::string_view(key).size(), spelled);
  return unit;
}

std::string escaped(const std::string& text) {
  std::string all;
  for (const char c : text) switch (c) {
      case '&':
        all += "&amp;";
        break;
      case '<':
        all += "&lt;";
        break;
      case '>':
        all += "&gt;";
        break;
      case '"':
        all += "&quot;";
        break;
      case '\n':
      case '\t':
      case '\r':
        all += ' ';
        break;
      default:
        all += c;
    }
  return all;
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + escaped(value) + "\"";
}

class Description {
 public:
  Description(FmuInstance& instance, int fmi, const std::string& identifier)
      : instance_(instance), fmi_(fmi), identifier_(identifier) {}

  std::string text() {
    text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    const ModelCase& model_case = instance_.model_case();
    line("<fmiModelDescription" + attribute("fmiVersion", fmi_ == 3 ? "3.0" : "2.0") +
         attribute("modelName", model_case.model.name()) +
         attribute(fmi_ == 3 ? "instantiationToken" : "guid", instance_.interface().token) +
         (model_case.note.empty() ? "" : attribute("description", model_case.note)) +
         attribute("generationTool", "drev " DREV_VERSION) + attribute("variableNamingConvention", "flat") +
         ">");
    add_capabilities();
    add_units();
    line("  <LogCategories>");
    for (const char* category : {"logStatusWarning", "logStatusError"})
      line("    <Category" + attribute("name", category) + "/>");
    line("  </LogCategories>");
    line("  <DefaultExperiment startTime=\"0\"" + attribute("stopTime", to_text(model_case.duration)) +
         attribute("stepSize", to_text(model_case.duration / 1000.0)) + "/>");
    line("  <ModelVariables>");
    for (std::size_t i = 0; i < instance_.variables().size(); ++i) add_variable(static_cast<unsigned>(i));
    line("  </ModelVariables>");
    add_structure();
    line("</fmiModelDescription>");
    return std::move(text_);
  }

 private:
  void line(const std::string& text) { text_ += text + "\n"; }

  void add_capabilities() {
    const std::string name = attribute("modelIdentifier", identifier_);
    line("  <CoSimulation" + name + " canHandleVariableCommunicationStepSize=\"true\"" +
         (fmi_ == 3 ? " canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" hasEventMode=\"true\" "
                      "providesDirectionalDerivatives=\"true\" providesIntermediateUpdate=\"true\""
                    : " canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" "
                      "canInterpolateInputs=\"true\" providesDirectionalDerivative=\"true\"") +
         "/>");
  }

  void add_units() {
    std::map<std::string, std::string> bases;
    for (const FmuVariable& v : instance_.variables()) {
      if (v.type != FmuVariable::Type::real || v.unit.empty()) continue;
      const auto known = base_units().find(name_of_unit(v));
      bases[name_of_unit(v)] = known == base_units().end() ? base_of_key(v.unit) : known->second;
    }
    line("  <UnitDefinitions>");
    for (const auto& [unit, base] : bases)
      line("    <Unit" + attribute("name", unit) +
           (base.empty() ? "/>" : "><BaseUnit " + base + "/></Unit>"));
    line("  </UnitDefinitions>");
  }

  static std::string name_of_unit(const FmuVariable& v) {
    return base_of_key(v.unit).empty() ? v.unit : as_of_channel(v.unit);
  }

  void add_variable(unsigned reference) {
    const FmuVariable& v = instance_.variables()[reference];
    using enum FmuVariable::Role;
    std::string common = attribute("name", v.name) + attribute("valueReference", std::to_string(reference)) +
                         (v.meaning.empty() ? "" : attribute("description", v.meaning));
    const char* causality = v.role == time        ? "independent"
                            : v.role == parameter ? "parameter"
                            : v.role == output    ? "output"
                                                  : "input";
    common += attribute("causality", causality) + attribute("variability", v.role != parameter ? "continuous"
                                                                           : v.tunable         ? "tunable"
                                                                                               : "fixed");
    if (fmi_ == 2 && v.role == parameter) common += attribute("initial", "exact");
    if (fmi_ == 2 && v.role == output) common += attribute("initial", "calculated");
    if (fmi_ == 3 && v.role == output) common += attribute("intermediateUpdate", "true");
    std::string of_type = range_of(v);
    if (!v.unit.empty() && v.type == FmuVariable::Type::real) of_type += attribute("unit", name_of_unit(v));
    std::string start;
    if (v.role != time && v.role != output) start = start_of(reference, v);
    const bool text = v.type == FmuVariable::Type::text;
    if (!start.empty() && !(fmi_ == 3 && text)) of_type += start;
    if (fmi_ == 2) {
      const char* types[] = {"Real", "Integer", "String"};
      line("    <ScalarVariable" + common + "><" + types[static_cast<int>(v.type)] + of_type +
           "/></ScalarVariable>");
      return;
    }
    const char* types[] = {"Float64", "Int32", "String"};
    const std::string type = types[static_cast<int>(v.type)];
    line("    <" + type + common + of_type +
         (text ? "><Start" + attribute("value", instance_.text(reference)) + "/></String>" : "/>"));
  }

  std::string start_of(unsigned reference, const FmuVariable& v) {
    switch (v.type) {
      case FmuVariable::Type::real:
        return attribute("start", to_text(instance_.real(reference)));
      case FmuVariable::Type::integer:
        return attribute("start", std::to_string(instance_.integer(reference)));
      default:
        return attribute("start", instance_.text(reference));
    }
  }

  std::string range_of(const FmuVariable& v) const {
    if (v.role != FmuVariable::Role::parameter || v.type == FmuVariable::Type::text) return {};
    const Parameter& p = instance_.parameters()[v.place];
    const auto as_text = [&](double value) {
      return v.type == FmuVariable::Type::integer ? std::to_string(static_cast<int>(value)) : to_text(value);
    };
    const double limit = v.type == FmuVariable::Type::integer ? 2147483647.0 : kNoLimit;
    std::string all;
    if (p.low > -limit) all += attribute("min", as_text(p.low));
    if (p.high < limit) all += attribute("max", as_text(p.high));
    return all;
  }

  void add_structure() {
    std::string outputs, initial;
    for (std::size_t i = 0; i < instance_.variables().size(); ++i) {
      if (instance_.variables()[i].role != FmuVariable::Role::output) continue;
      const std::string at = fmi_ == 3 ? attribute("valueReference", std::to_string(i))
                                       : attribute("index", std::to_string(i + 1));
      outputs += (fmi_ == 3 ? "    <Output" : "      <Unknown") + at + "/>\n";
      initial += (fmi_ == 3 ? "    <InitialUnknown" : "      <Unknown") + at + "/>\n";
    }
    line("  <ModelStructure>");
    if (fmi_ == 3)
      text_ += outputs + initial;
    else if (!outputs.empty())
      text_ += "    <Outputs>\n" + outputs + "    </Outputs>\n    <InitialUnknowns>\n" + initial +
               "    </InitialUnknowns>\n";
    line("  </ModelStructure>");
  }

  FmuInstance& instance_;
  int fmi_;
  std::string identifier_, text_;
};

}  // namespace

std::string model_description(FmuInstance& instance, int fmi, const std::string& identifier) {
  return Description(instance, fmi, identifier).text();
}

}  // namespace drev::app
