#pragma once
/// The report of `drev run --out`: one self-contained HTML page with the table of the run and a chart of the
/// recorded channels, one chart per quantity. It needs no network, and follows the reader's light or dark
/// theme.
#include <string>

#include "app/run_result.hpp"

namespace drev::app {

/// history: path of the complete history.csv. Throws OutputError if it cannot be read.
std::string run_report(const RunRequest& request, const RunResult& result,
                       const std::string& history);

}  // namespace drev::app
