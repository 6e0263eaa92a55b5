#pragma once
/// The result of `drev run` as a short table.
#include <string>
#include <vector>

#include "app/run/run_result.hpp"

namespace drev::app {

std::string run_as_text(const RunRequest& request, const RunResult& result);
/// The warning on stderr and before the table when a run did not succeed; empty if it did.
std::string warning_of(const RunResult& result);
/// Notes to be read before the figures, also for a run that succeeded: sentences without full stop.
std::vector<std::string> notes_of(const RunResult& result);

}  // namespace drev::app
