#include <drev/core/units.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/sweep_request.hpp"
#include "app/report/report_file.hpp"
#include "app/report/report_page.hpp"
#include "app/report/sweep_report.hpp"
#include "app/results/campbell_result.hpp"

namespace drev::app {

int campbell_command(const CommandLine& line) {
  SweepRequest request = request_sweep(line, {"/modes.csv", "/criticals.csv", "/summary.json"});
  request.options.needs_cycle = false;  // modes and criticals are each order's own
  if (!request.options.close_contacts && !request.model.system.scalars().empty())
    throw ModelError({{kCommandLine, "--contact", "", "",
                       "must be closed: modes over speed are of a linear train, and " +
                           request.model.entry->name + " has laws that are no straight lines"}});
  std::optional<ReportFile> report;
  if (const auto file = line.option("--report")) report.emplace(*file);
  watch_signals();
  const LinearSweep sweep = sweep_linear(request.model.system, request.options);
  if (sweep.modes.lambda.size() == 0 && !sweep.modes_note.empty())
    throw SolverError("campbell of " + request.model.entry->name + ": " + sweep.modes_note);
  if (const auto out = line.option("--out")) {
    create_directory(*out);
    write_file(*out, "modes", "csv", campbell_modes_as_csv(sweep));
    write_file(*out, "criticals", "csv", criticals_as_csv(sweep));
    write_file(*out, "summary", "json", json_text(campbell_object(request, sweep)));
  }
  if (report)
    report->commit(report_page(
        {block_text(sweep_report_data(request, sweep, "Campbell diagram and criticals", words_of(line)))},
        ReportPage::sweep));
  print(line.json ? json_text(campbell_object(request, sweep)) : campbell_as_text(request, sweep));
  return kSuccess;
}

}  // namespace drev::app
