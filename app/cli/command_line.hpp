#pragma once
/// The command line as text, split into its parts; what the parts are worth is checked by each command, so
/// that everything wrong with one command line can be listed at once.
#include <drev/core/error.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/command_entry.hpp"

namespace drev::app {

inline constexpr const char* kCommandLine = "command line";  ///< the place that findings on it name

struct CommandLine {
  const CommandEntry* command = nullptr;
  std::string model = {};  ///< name or file, the first of several; empty: not given
  /// The model file itself, of a program that has made it; `model` is then its name. None: it is read.
  std::optional<std::string> text = {};
  std::vector<std::pair<std::string, std::string>> parameters = {};  ///< of --set name=value
  std::map<std::string, std::vector<std::string>> options = {};      ///< those given, with their values
  std::map<std::string, std::string> from_file = {};  ///< options that a model file gave: where it says so
  bool json = false;
  bool keeps_history = false;  ///< a program keeps the recorded channels: --record and --every need no file
  bool quiet = false;          ///< nothing to standard output; what is wrong still goes to standard error
  std::vector<Finding> findings = {};  ///< options that do not exist, --set without '=', ...

  /// The value of an option such as "--step"; nullopt if it was not given.
  std::optional<std::string> option(const std::string& name) const {
    const auto found = options.find(name);
    return found == options.end() ? std::nullopt : std::optional(found->second.front());
  }
  /// The values of an option that takes several.
  std::optional<std::vector<std::string>> list(const std::string& name) const {
    const auto found = options.find(name);
    return found == options.end() ? std::nullopt : std::optional(found->second);
  }
};

/// Whether one of the findings is of the option already.
bool blamed(const std::vector<Finding>& findings, const std::string& option);

/// Either a command to be done, or the exit code of a process that has done what was asked (help, version)
/// or could not make out what was (its errors are on stderr).
struct ParsedCommandLine {
  std::optional<CommandLine> command = {};
  int exit_code = 0;
};

/// commands: those that there are. The command line found refers to one of them.
ParsedCommandLine parse_command_line(int argc, char** argv, const std::vector<CommandEntry>& commands);

}  // namespace drev::app
