#pragma once
/// The command line as text, split into its parts; what the parts are worth is checked in requests.hpp, so
/// that everything wrong with one command line can be listed at once.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace drev::app {

struct CommandLine {
  enum class Command { run, modes, list, chart };
  Command command = Command::list;
  std::string model;                                               ///< empty: not given
  std::vector<std::pair<std::string, std::string>> settings = {};  ///< of --set name=value
  std::optional<std::string> method = {}, step = {}, tolerance = {}, out = {}, every = {}, count = {},
                             contact = {}, limit = {}, accuracy = {};
  std::optional<std::vector<std::string>> record = {}, methods = {};
  bool json = false;
  std::vector<Finding> findings = {};  ///< options that do not exist, --set without '=', ...
};

/// Either a command to be done, or the exit code of a process that has done what was asked (help, version)
/// or could not make out what was (its errors are on stderr).
struct ParsedCommandLine {
  std::optional<CommandLine> command = {};
  int exit_code = 0;
};

ParsedCommandLine parse_command_line(int argc, char** argv);

}  // namespace drev::app
