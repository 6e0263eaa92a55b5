#pragma once
/// The origin of a report, in the data blocks of all reports.
#include <map>
#include <string>

#include "app/base/json_values.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

/// Adds "version" and "made", the time in UTC.
void add_origin(Json& data);

/// Names of the parameters that are varied, each with the text of its values or its distribution.
using VariedTexts = std::map<std::string, std::string>;

/// [{name, value, varied, default, unit, range, meaning}]; value: of a varied one its text.
Json inputs_array(const Parameters& parameters, const VariedTexts& varied = {});

/// " --set NAME=VALUE" for each parameter that is neither varied nor at its default, and " --plugin FILE" for each
/// loaded plugin.
std::string model_options(const Parameters& parameters, const VariedTexts& varied = {});

/// The data at the beginning of the pages of sweeps and studies: origin, command (words and the model's
/// options), title, and the model with its inputs.
Json page_data(const std::string& kind, const std::string& title, const ModelRequest& model,
               const std::string& words, const VariedTexts& varied = {});

}  // namespace drev::app
