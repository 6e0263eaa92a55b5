#pragma once
/// The report of a nonlinear sweep: one page with the half range of every section over speed, curve by curve, stable
/// and unstable motions told apart, folds and other changes, limits.
#include <string>
#include <vector>

#include "app/report/sweep_report.hpp"
#include "app/results/branches_result.hpp"

namespace drev::app {

/// The page's data, for report_page(..., ReportPage::branches). words: the command that gives it again, without the
/// model's parameters; limits: over sweep.speeds.
Json branches_report_data(const ModelRequest& model, const NonlinearSweepOptions& options,
                          const NonlinearSweep& sweep, const std::string& words,
                          const std::vector<DrawnLimit>& limits);

}  // namespace drev::app
