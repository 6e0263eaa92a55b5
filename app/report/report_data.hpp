#pragma once
/// The data block of a report: one JSON object with all data of one run that a page shows, so that pages of
/// one and of two runs are made from blocks alone.
#include "app/base/json_values.hpp"
#include "app/report/report_history.hpp"
#include "app/run/run_result.hpp"

namespace drev::app {

/// Recording interval for a run by `method` [s], fine enough for the report's spectra; 0: every step.
double report_interval(const RunRequest& request, const Method& method);

Json report_data(const RunRequest& request, const RunResult& result, const ReportHistory& history);

}  // namespace drev::app
