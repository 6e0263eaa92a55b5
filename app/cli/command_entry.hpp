#pragma once
/// A command of drev as a row of a table (app/commands/commands.cpp): what `drev --help` shows, what the
/// command line is split by, and what is then done.
#include <string>
#include <vector>

namespace drev::app {

struct CommandLine;

/// An option, most of them with a value.
struct OptionEntry {
  enum class Values {
    one,     ///< a single one
    commas,  ///< NAME,NAME,... and as often as needed
    words,   ///< NAME NAME ...
    again,   ///< one each time that it is given, as often as needed
    none     ///< a flag
  };
  const char* name;  ///< "--step"
  const char* type;  ///< of its value, as --help shows it
  const char* meaning;
  Values values = Values::one;
  std::vector<std::string> choices = {};  ///< the values there are; none: any
};

struct CommandEntry {
  const char* name;
  const char* summary;
  bool takes_model = true;    ///< MODEL, and --set for its parameters
  bool takes_models = false;  ///< more than one, too: line.list("MODEL")
  bool takes_sets = false;    ///< --set although it takes no MODEL
  bool has_json = true;       ///< --json: its result is an object, too
  std::vector<OptionEntry> options = {};
  std::string footer = {};
  /// Does it and returns the exit code; what is printed goes to stdout in one piece. Throws ModelError for
  /// bad input, SolverError for a computation that failed, OutputError.
  int (*execute)(const CommandLine& line) = nullptr;
};

}  // namespace drev::app
