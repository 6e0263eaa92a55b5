#pragma once
/// The commands of drev. Each returns its exit code; what is printed goes to stdout in one piece. Throw
/// ModelError for bad input, SolverError for a computation that failed, OutputError.
#include "app/command_line.hpp"

namespace drev::app {

int run_command(const CommandLine& line);
int modes_command(const CommandLine& line);
int list_command(const CommandLine& line);
int chart_command(const CommandLine& line);

/// Writes to stdout; throws OutputError if that fails (a full disk behind a redirection).
void print(const std::string& text);

}  // namespace drev::app
