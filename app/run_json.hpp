#pragma once
/// The result of `drev run` as one JSON object.
#include <string>

#include "app/run_result.hpp"

namespace drev::app {

std::string run_as_json(const RunRequest& request, const RunResult& result);

}  // namespace drev::app
