#pragma once
/// The result of `drev run` as one JSON object.
#include <string>

#include "app/json_values.hpp"
#include "app/run_result.hpp"

namespace drev::app {

Json run_object(const RunRequest& request, const RunResult& result);
std::string run_as_json(const RunRequest& request, const RunResult& result);

}  // namespace drev::app
