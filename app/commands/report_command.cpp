#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/base/json_values.hpp"
#include "app/cli/command_line.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/report/report_file.hpp"
#include "app/report/report_page.hpp"

namespace drev::app {

namespace {

/// Empty where it cannot be read.
std::string text_of(const std::string& path) try {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
} catch (const std::ios_base::failure&) {
  return {};
}

/// A sentence on a run in the directory that did not come to its end; empty: there is none.
std::string partial_run(const std::string& directory) {
  const std::string path = directory + "/summary.partial.json";
  if (!std::filesystem::exists(path)) return {};
  const Json summary = Json::parse(text_of(path), nullptr, false);
  const std::string status = summary.is_object() ? summary.value("status", "unknown") : "unreadable";
  return "the last run there did not come to its end (" + status + ": " + path + ")";
}

/// The report that a RUN means.
std::string run_page(const std::string& run) {
  return std::filesystem::is_directory(run) ? run + "/report.html" : run;
}

bool is_sweep(const std::string& block) {
  const Json data = Json::parse(block, nullptr, false);
  return data.is_object() && data.value("kind", "") == "sweep";
}

/// The data block of one run, written again; empty, and a finding, if there is none.
std::string block_of(const std::string& named, std::vector<Finding>& findings) {
  const std::string run = run_page(named), partial = run != named ? partial_run(named) : "";
  const bool readable = std::filesystem::is_regular_file(run) && std::ifstream(run).good();
  const std::vector<std::string> blocks = readable ? blocks_of(text_of(run)) : std::vector<std::string>{};
  const Json data = blocks.size() == 1 ? read_block(blocks.front()) : Json();
  if (data.is_object()) {
    if (!partial.empty())
      std::fprintf(stderr, "drev: %s is of an older run; %s\n", run.c_str(), partial.c_str());
    return block_text(data);
  }
  findings.push_back({kCommandLine, "RUN", run, "",
                      !readable && !partial.empty() ? "does not exist: " + partial
                      : !readable                   ? "is no file that can be read"
                      : blocks.size() > 1           ? "compares two runs already; give each run's own report"
                      : blocks.size() == 1 && is_sweep(blocks.front())
                          ? "is the report of a sweep; print it from the browser, or write it to a .pdf"
                      : blocks.size() == 1 ? "is damaged: the data of its run are cut off or changed; write "
                                             "the report again with drev run"
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
  for (const std::string& run : runs) check_output("--out", out, {run_page(run)}, findings);
  if (const auto why = why_no_report(out)) findings.push_back({kCommandLine, "--out", out, "", *why});
  if (!findings.empty()) throw ModelError(std::move(findings));

  ReportFile file(out);
  file.commit(report_page(blocks));
  print(line.json ? json_text({{"report", file.path()}}) : "Report " + file.path() + "\n");
  return kSuccess;
}

}  // namespace drev::app
