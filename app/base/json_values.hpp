#pragma once
/// Values as JSON. A number that is not finite is null: JSON has no NaN.
#include <drev/models/parameters.hpp>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

// Compiled once, in json_values.cpp.
extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace drev::app {

using Json = nlohmann::ordered_json;

inline Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

inline Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

/// Of a list of numbers, each times `factor`.
template <class Numbers>
Json numbers(const Numbers& values, double factor = 1.0) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(factor * value));
  return list;
}

inline Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

/// Numbers as numbers, everything else as text.
Json parameter_value(const Parameter& parameter, const std::string& text);

/// {name: value, ...}: numbers as numbers, everything else as text.
Json values_object(const ParameterValues& values);

/// {name: value, ...}
Json parameters_object(const Parameters& parameters);

/// One object, ready to be printed or written.
std::string json_text(const Json& object);

}  // namespace drev::app
