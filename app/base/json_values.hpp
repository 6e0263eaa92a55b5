#pragma once
/// Values as JSON. A number that is not finite is null: JSON has no NaN.
#include <drev/models/parameters.hpp>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace drev::app {

using Json = nlohmann::ordered_json;

inline Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

inline Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

inline Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

/// Numbers as numbers, everything else as text.
inline Json parameter_value(const Parameter& parameter, const std::string& text) {
  double value = 0.0;
  if (parameter.kind == Parameter::Kind::number && read_number(text, value)) return number(value);
  if (parameter.kind == Parameter::Kind::integer && read_number(text, value)) return static_cast<long>(value);
  return text;
}

/// {name: value, ...}
inline Json parameters_object(const Parameters& parameters) {
  Json object = Json::object();
  for (std::size_t i = 0; i < parameters.known().size(); ++i)
    object[parameters.known()[i].name] = parameter_value(parameters.known()[i], parameters.values()[i]);
  return object;
}

/// One object, ready to be printed or written.
inline std::string json_text(const Json& object) {
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace drev::app
