#pragma once
/// The origin of a report, in the data blocks of all reports.
#include "app/base/json_values.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

/// Adds "version" and "made", the time in UTC.
void add_origin(Json& data);

/// [{name, value, default, unit, range, meaning}]
Json inputs_array(const Parameters& parameters);

/// " --set NAME=VALUE" for each parameter that is not at its default, and " --plugin FILE" for each loaded
/// plugin.
std::string model_options(const Parameters& parameters);

/// The data at the beginning of the pages of sweeps and studies: origin, command (words and the model's
/// options), title, and the model with its inputs.
Json page_data(const std::string& kind, const std::string& title, const ModelRequest& model,
               const std::string& words);

}  // namespace drev::app
