#pragma once
/// The commands of drev, as a table: what `drev --help` shows, what the command line is split by, and what is
/// then done.
#include <string>
#include <vector>

namespace drev::app {

struct CommandLine;

/// An option with a value.
struct OptionEntry {
  enum class Values {
    one,     ///< a single one
    commas,  ///< NAME,NAME,... and as often as needed
    words,   ///< NAME NAME ...
    again    ///< one each time that it is given, as often as needed
  };
  const char* name;  ///< "--step"
  const char* type;  ///< of its value, as --help shows it
  const char* meaning;
  Values values = Values::one;
};

struct CommandEntry {
  const char* name;
  const char* summary;
  bool takes_model = true;    ///< MODEL, and --set for its parameters
  bool takes_models = false;  ///< more than one, too: line.list("MODEL")
  std::vector<OptionEntry> options = {};
  std::string footer = {};
  /// Does it and returns the exit code; what is printed goes to stdout in one piece. Throws ModelError for
  /// bad input, SolverError for a computation that failed, OutputError.
  int (*execute)(const CommandLine& line) = nullptr;
};

const std::vector<CommandEntry>& commands();

int run_command(const CommandLine& line);
int modes_command(const CommandLine& line);
int list_command(const CommandLine& line);
int chart_command(const CommandLine& line);
int study_command(const CommandLine& line);
int advise_command(const CommandLine& line);
int check_command(const CommandLine& line);
int export_command(const CommandLine& line);
int report_command(const CommandLine& line);

/// Writes to stdout, unless set_quiet(true) came first (--quiet); throws OutputError if that fails (a full
/// disk behind a redirection).
void print(const std::string& text);
void set_quiet(bool value);

}  // namespace drev::app
