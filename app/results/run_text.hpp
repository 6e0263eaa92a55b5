#pragma once
/// The result of `drev run` as a short table.
#include <string>
#include <vector>

#include "app/run/run_result.hpp"

namespace drev::app {

std::string run_as_text(const RunRequest& request, const RunResult& result);
/// What is said loudly, on stderr and before the table, when a run did not succeed; empty if it did.
std::string warning_of(const RunResult& result);
/// What is to be known before the figures are read, of a run that succeeded, too: sentences without full stop.
std::vector<std::string> notes_of(const RunResult& result);

}  // namespace drev::app
