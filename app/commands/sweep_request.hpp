#pragma once
/// What the command line asks of `drev sweep` and `drev campbell`.
#include <drev/solvers/nonlinear_sweep.hpp>

#include <string>
#include <vector>

#include "app/cli/command_line.hpp"
#include "app/results/sweep_result.hpp"

namespace drev::app {

/// written: files in the directory of --out, each with a leading '/'. --report, too, is checked. Throws
/// ModelError with everything wrong.
SweepRequest request_sweep(const CommandLine& line, const std::vector<std::string>& written);

/// Of a model with laws that are no straight lines: --cycle, --tolerance and --jobs besides. Shows how far it is, and
/// ends at Ctrl-C.
NonlinearSweepOptions nonlinear_options(const CommandLine& line, const SweepRequest& request);

/// "drev sweep engine.toml --speeds 300:10:1800": the words of the line without --out, --report and --set.
std::string words_of(const CommandLine& line);

}  // namespace drev::app
