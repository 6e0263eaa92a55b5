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

/// Of a model with laws that are no straight lines: --cycle, --tolerance and --jobs besides; what is wrong goes to findings. Shows
/// how far it is, and ends at Ctrl-C.
NonlinearSweepOptions nonlinear_options(const CommandLine& line, const SweepRequest& request,
                                        std::vector<Finding>& findings);
/// Throws ModelError where they are given for a linear model.
void refuse_nonlinear_options(const CommandLine& line);

/// "drev sweep engine.toml --speeds 300:10:1800": the words of the line without --out, --report and --set.
std::string words_of(const CommandLine& line);

}  // namespace drev::app
