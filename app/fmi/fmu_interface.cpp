#include "app/fmi/fmu_interface.hpp"

#include <algorithm>

#include "app/model_file/tree.hpp"
#include "app/model_file/writing/field_writer.hpp"

namespace drev::app {

std::string interface_text(const FmuInterface& interface) {
  std::string text = "# What this FMU offers; read by its library.\n";
  const auto add = [&](const char* key, const std::string& value) {
    text += std::string(key) + " = " + value + "\n";
  };
  add("model", toml_text(interface.model));
  add("run", toml_text(interface.run));
  add("token", toml_text(interface.token));
  add("torques", toml_texts(interface.torques));
  add("speeds", toml_texts(interface.speeds));
  add("outputs", toml_texts(interface.outputs));
  add("tunable", toml_texts(interface.tunable));
  text += "\n[parameters]\n";
  for (const auto& [name, value] : interface.parameters) add(toml_key(name).c_str(), toml_text(value));
  return text;
}

namespace {

class InterfaceReader {
 public:
  explicit InterfaceReader(const std::string& path) : root_(parse_toml(read_text(path, nullptr), path)) {}

  std::string text(const char* key) {
    const Entry* entry = root_.find(key);
    if (entry != nullptr && entry->value.is(Value::Kind::text)) return entry->value.text;
    refuse(key, "must be a text");
    return {};
  }
  std::vector<std::string> texts(const char* key) {
    const Entry* entry = root_.find(key);
    std::vector<std::string> all;
    if (entry == nullptr || !entry->value.is(Value::Kind::array)) {
      refuse(key, "must be a list of texts");
      return all;
    }
    for (const Value& item : entry->value.items) {
      if (!item.is(Value::Kind::text)) refuse(key, "must be a list of texts");
      all.push_back(item.text);
    }
    return all;
  }
  ParameterValues parameters() {
    ParameterValues all;
    const Entry* entry = root_.find("parameters");
    if (entry == nullptr || !entry->value.is(Value::Kind::table)) {
      refuse("parameters", "must be a table");
      return all;
    }
    for (const Entry& parameter : entry->value.entries) {
      if (!parameter.value.is(Value::Kind::text)) refuse(parameter.key.c_str(), "must be a text");
      all.emplace_back(parameter.key, parameter.value.text);
    }
    return all;
  }
  void finish() {
    if (!findings_.empty()) throw ModelError(std::move(findings_));
  }

 private:
  void refuse(const char* key, const char* why) { findings_.push_back(fault_at(root_.at, key, why)); }

  Value root_;
  std::vector<Finding> findings_;
};

FmuVariable::Type type_of(const Parameter& parameter) {
  switch (parameter.kind) {
    case Parameter::Kind::number:
      return FmuVariable::Type::real;
    case Parameter::Kind::integer:
      return FmuVariable::Type::integer;
    default:
      return FmuVariable::Type::text;
  }
}

}  // namespace

FmuInterface read_interface(const std::string& path) {
  InterfaceReader reader(path);
  FmuInterface interface {
    reader.text("model"), reader.text("run"), reader.text("token"), reader.texts("torques"),
        reader.texts("speeds"), reader.texts("outputs"), reader.parameters(), reader.texts("tunable")
  };
  reader.finish();
  return interface;
}

std::vector<FmuVariable> fmu_variables(const FmuInterface& interface,
                                       const std::vector<Parameter>& parameters,
                                       const std::vector<NodeKind>& kinds,
                                       const std::vector<std::string>& output_units) {
  using enum FmuVariable::Role;
  constexpr auto kReal = FmuVariable::Type::real;
  std::vector<FmuVariable> all{{"time", kReal, time, 0, "s", "simulation time"}};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    const bool tunable =
        std::find(interface.tunable.begin(), interface.tunable.end(), p.name) != interface.tunable.end();
    all.push_back({p.name, type_of(p), parameter, i, p.unit, p.meaning, tunable});
  }
  auto kind = kinds.begin();
  for (std::size_t i = 0; i < interface.torques.size(); ++i) {
    const bool turns = *kind++ == NodeKind::rotational;
    all.push_back({interface.torques[i] + (turns ? ".input_torque_Nm" : ".input_force_N"), kReal, torque, i,
                   turns ? "N m" : "N", "acts on the node; positive drives it forward"});
  }
  for (std::size_t i = 0; i < interface.speeds.size(); ++i) {
    const bool turns = *kind++ == NodeKind::rotational;
    all.push_back({interface.speeds[i] + (turns ? ".input_speed_rad_per_s" : ".input_velocity_m_per_s"),
                   kReal, speed, i, turns ? "rad/s" : "m/s",
                   "actual speed of the node, whose motion is prescribed"});
  }
  for (std::size_t i = 0; i < interface.outputs.size(); ++i)
    all.push_back({interface.outputs[i], kReal, output, i, output_units[i], ""});
  return all;
}

}  // namespace drev::app
