#include "app/base/json_values.hpp"

template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace drev::app {

Json parameter_value(const Parameter& parameter, const std::string& text) {
  double value = 0.0;
  if (parameter.kind == Parameter::Kind::number && read_number(text, value)) return number(value);
  if (parameter.kind == Parameter::Kind::integer && read_number(text, value)) return static_cast<long>(value);
  return text;
}

Json values_object(const ParameterValues& values) {
  Json object = Json::object();
  for (const auto& [name, text] : values) {
    double value = 0.0;
    object[name] = read_number(text, value) ? number(value) : Json(text);
  }
  return object;
}

Json parameters_object(const Parameters& parameters) {
  Json object = Json::object();
  for (std::size_t i = 0; i < parameters.known().size(); ++i)
    object[parameters.known()[i].name] = parameter_value(parameters.known()[i], parameters.values()[i]);
  return object;
}

std::string json_text(const Json& object) {
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace drev::app
