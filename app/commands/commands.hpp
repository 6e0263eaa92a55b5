#pragma once
/// The commands of drev, as a table.
#include <vector>

#include "app/cli/command_entry.hpp"

namespace drev::app {

const std::vector<CommandEntry>& commands();

int run_command(const CommandLine& line);
int modes_command(const CommandLine& line);
int sweep_command(const CommandLine& line);
int campbell_command(const CommandLine& line);
int class_command(const CommandLine& line);
int shaft_command(const CommandLine& line);
int import_command(const CommandLine& line);
int gear_command(const CommandLine& line);
int list_command(const CommandLine& line);
int chart_command(const CommandLine& line);
int study_command(const CommandLine& line);
int advise_command(const CommandLine& line);
int optimise_command(const CommandLine& line);
int check_command(const CommandLine& line);
int export_command(const CommandLine& line);
int report_command(const CommandLine& line);

}  // namespace drev::app
