#include <cstdio>
#include <utility>

#include "app/base/interrupt.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/run_many.hpp"
#include "app/commands/run_request.hpp"
#include "app/commands/run_variants.hpp"
#include "app/report/run_files.hpp"

namespace drev::app {

namespace {

void say(const std::string& text) { std::fprintf(stderr, "drev: %s\n", text.c_str()); }

int exit_code(const RunOutcome& outcome) {
  if (outcome.status == "success") return outcome.written ? kSuccess : kNotWritten;
  if (outcome.status == "interrupted") return kInterrupted;
  if (outcome.status == "output_error") return kNotWritten;
  return kNotTrusted;
}

}  // namespace

int run_command(const CommandLine& line) {
  if (means_variants(line)) return run_variants(line);
  if (means_many(line)) return run_many(line);
  RunRequest request = request_run(line);
  watch_signals();
  const RunOutcome outcome = run_and_write(std::move(request));
  if (!outcome.warning.empty()) say(outcome.warning);
  for (const std::string& note : outcome.notes) say(note);
  print(line.json ? outcome.json : outcome.text);
  return exit_code(outcome);
}

}  // namespace drev::app
