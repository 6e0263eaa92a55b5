#pragma once
/// From the command line of `drev run` to the run that it asks for.
#include "app/cli/command_line.hpp"
#include "app/run/run_request.hpp"

namespace drev::app {

/// Throws ModelError with everything wrong with the command line and, where the model is a file, with the
/// options that its [run] gives.
RunRequest request_run(const CommandLine& line);

}  // namespace drev::app
