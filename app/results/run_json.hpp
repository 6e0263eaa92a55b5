#pragma once
/// The result of `drev run` as one JSON object, as docs/results.schema.json describes it.
#include <string>

#include "app/base/json_values.hpp"
#include "app/run/run_result.hpp"

namespace drev::app {

/// With what all results have; kind: what the object is, of those that docs/results.schema.json lists.
Json result_object(const char* kind);
Json run_object(const RunRequest& request, const RunResult& result);
std::string run_as_json(const RunRequest& request, const RunResult& result);
/// What is known before the run has begun: status "running", and no figures.
std::string running_as_json(const RunRequest& request);

}  // namespace drev::app
