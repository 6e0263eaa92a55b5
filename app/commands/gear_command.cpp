#include <optional>

#include "app/base/output_file.hpp"
#include "app/cli/command_line.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/gear_page.hpp"
#include "app/model_file/gears/gear_file.hpp"
#include "app/report/report_file.hpp"
#include "app/results/gear_result.hpp"

namespace drev::app {

namespace {

/// Those of the file, each computed; all that cannot be is listed at once.
std::vector<GearCase> computed(const std::vector<NamedDrawing>& drawings) {
  std::vector<GearCase> cases;
  std::vector<Finding> findings;
  for (const NamedDrawing& one : drawings) {
    try {
      cases.push_back({one.name, one.drawing, gear_mesh_data(one.drawing, one.name)});
    } catch (const ModelError& error) {
      for (const Finding& finding : error.findings())
        findings.push_back(placed(finding, one.part, one.where));
    }
  }
  if (!findings.empty()) throw ModelError(std::move(findings));
  return cases;
}

}  // namespace

int gear_command(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::vector<std::string> files = line.list("FILE").value_or(std::vector<std::string>{});
  if (!line.model.empty()) files.push_back(line.model);  // --set a=1 FILE
  if (files.size() != 1)
    findings.push_back({kCommandLine, "FILE", files.empty() ? "" : files[1], "", "must be one file"});
  const std::optional<std::string> report = line.option("--report");
  if (report) {
    if (const auto why = why_no_report(*report))
      findings.push_back({kCommandLine, "--report", *report, "", *why});
    check_output("--report", *report, files, findings);
  }
  if (!findings.empty()) throw ModelError(std::move(findings));
  const std::vector<GearCase> cases = computed(read_gear_drawings(files.front(), line.parameters));
  if (report) ReportFile(*report).commit(gear_page(files.front(), cases));
  print(line.json ? json_text(gear_object(files.front(), cases)) : gear_as_text(cases));
  return kSuccess;
}

}  // namespace drev::app
