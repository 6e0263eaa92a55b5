#pragma once
/// The report of a nonlinear sweep: one page with the half range of every section over speed, curve by curve,
/// stable and unstable motions drawn differently, with folds and other changes and with limits.
#include <string>
#include <vector>

#include "app/report/sweep_report.hpp"
#include "app/results/branches_result.hpp"

namespace drev::app {

/// The page's data for report_page(..., ReportPage::branches). words: the command that reproduces it, without
/// the model's parameters; limits: values at sweep.speeds.
Json branches_report_data(const ModelRequest& model, const NonlinearSweepOptions& options,
                          const NonlinearSweep& sweep, const std::string& words,
                          const std::vector<DrawnLimit>& limits);

}  // namespace drev::app
