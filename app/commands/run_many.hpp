#pragma once
/// `drev run` of several models: each in a process of its own, as many at once as there are processors, so
/// that what becomes of one does not touch the others. Results are in DIR/NAME, what became of all in
/// DIR/runs.json.
#include "app/cli/command_line.hpp"

namespace drev::app {

/// Whether the models of the command line are several, or a directory.
bool means_many(const CommandLine& line);
/// As run_command. Returns 0 if all succeeded, kInterrupted, or the code of those that did not where they
/// share one, else kNotTrusted.
int run_many(const CommandLine& line);

}  // namespace drev::app
