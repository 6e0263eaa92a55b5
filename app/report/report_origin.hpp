#pragma once
/// What the data blocks of all reports say of where they come from.
#include "app/base/json_values.hpp"

namespace drev::app {

/// Adds "version" and "made", the time in UTC.
void add_origin(Json& data);

/// [{name, value, default, unit, range, meaning}]
Json inputs_array(const Parameters& parameters);

/// " --set NAME=VALUE" of each parameter that is not at its default, and " --plugin FILE" of each loaded.
std::string model_options(const Parameters& parameters);

}  // namespace drev::app
