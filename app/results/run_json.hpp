#pragma once
/// The result of `drev run` as one JSON object, as docs/results.schema.json describes it.
#include <string>

#include "app/base/json_values.hpp"
#include "app/run/run_result.hpp"

namespace drev::app {

/// A JSON object with the members that all results share. kind: one of the kinds listed in
/// docs/results.schema.json.
Json result_object(const char* kind);
Json run_object(const RunRequest& request, const RunResult& result);
std::string run_as_json(const RunRequest& request, const RunResult& result);
/// The result before the run has begun: status "running", and no figures.
std::string running_as_json(const RunRequest& request);

}  // namespace drev::app
