#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/base/json_values.hpp"
#include "app/cli/command_line.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/report/report_file.hpp"
#include "app/report/report_page.hpp"

namespace drev::app {

namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A sentence on a run in the directory that did not come to its end; empty: there is none.
std::string partial_run(const std::string& directory) {
  const std::string path = directory + "/summary.partial.json";
  if (!std::filesystem::exists(path)) return {};
  const Json summary = Json::parse(text_of(path), nullptr, false);
  const std::string status = summary.is_object() ? summary.value("status", "unknown") : "unreadable";
  return "the last run there did not come to its end (" + status + ": " + path + ")";
}

/// The data block of one run; empty, and a finding, if there is none.
std::string block_of(std::string run, std::vector<Finding>& findings) {
  std::string partial;
  if (std::filesystem::is_directory(run)) {
    partial = partial_run(run);
    run += "/report.html";
  }
  const bool readable = std::filesystem::is_regular_file(run) && std::ifstream(run).good();
  const std::vector<std::string> blocks = readable ? blocks_of(text_of(run)) : std::vector<std::string>{};
  if (blocks.size() == 1) {
    if (!partial.empty())
      std::fprintf(stderr, "drev: %s is of an older run; %s\n", run.c_str(), partial.c_str());
    return blocks.front();
  }
  findings.push_back({kCommandLine, "RUN", run, "",
                      !readable && !partial.empty() ? "does not exist: " + partial
                      : !readable                   ? "is no file that can be read"
                      : blocks.size() > 1           ? "compares two runs already; give each run's own report"
                                                    : "is no report of drev run"});
  return {};
}

}  // namespace

int report_command(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  const std::vector<std::string> runs = line.list("RUN").value_or(std::vector<std::string>{});
  if (runs.empty() || runs.size() > 2)
    findings.push_back({kCommandLine, "RUN", runs.empty() ? "" : runs.back(), "",
                        "must be one run, or two to compare: directories of drev run --out, or reports"});
  std::vector<std::string> blocks;
  for (const std::string& run : runs) blocks.push_back(block_of(run, findings));
  const std::string out = line.option("--out").value_or("");
  if (const auto why = why_no_report(out)) findings.push_back({kCommandLine, "--out", out, "", *why});
  if (!findings.empty()) throw ModelError(std::move(findings));

  ReportFile file(out);
  file.commit(report_page(blocks));
  print(line.json ? json_text({{"report", file.path()}}) : "Report " + file.path() + "\n");
  return kSuccess;
}

}  // namespace drev::app
