#pragma once
/// What the command line asks of `drev sweep` and `drev campbell`.
#include <string>
#include <vector>

#include "app/cli/command_line.hpp"
#include "app/results/sweep_result.hpp"

namespace drev::app {

/// written: files in the directory of --out, each with a leading '/'. Throws ModelError with everything wrong.
SweepRequest request_sweep(const CommandLine& line, const std::vector<std::string>& written);

}  // namespace drev::app
