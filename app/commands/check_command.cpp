#include <drev/app/model_file/model_file.hpp>

#include <set>

#include "app/base/json_values.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/run_request.hpp"

namespace drev::app {

namespace {

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

Json faults_array(const std::vector<Finding>& findings) {
  Json faults = Json::array();
  for (const Finding& f : findings)
    faults.push_back({{"place", f.place},
                      {"parameter", f.parameter},
                      {"value", f.value},
                      {"unit", f.unit},
                      {"range", f.range}});
  return faults;
}

/// The runs that a file names; none where it cannot be read, which is said elsewhere.
std::vector<std::string> run_names(const CommandLine& line) {
  try {
    const std::shared_ptr<const ModelFile> file = open_model_file(line, "");
    return file ? file->run_names() : std::vector<std::string>();
  } catch (const ModelError&) {
    return {};
  }
}

}  // namespace

int check_command(const CommandLine& line) {
  std::vector<CommandLine> runs{line};
  std::vector<std::string> names;
  const auto asked = line.option("--run");
  names = run_names(line);
  for (const std::string& name : asked ? std::vector<std::string>{} : names) {
    runs.push_back(line);
    runs.back().options["--run"] = {name};
  }
  std::size_t nodes = 0, elements = 0;
  std::vector<Finding> findings;
  std::set<std::string> said;
  for (CommandLine& run : runs) try {
      run.keeps_history = true;  // as a run with --out: what it refuses is wrong with the file
      const RunRequest request = request_run(run);
      if (&run != &runs.front()) continue;
      nodes = request.model.model_case.model.node_names().size();
      elements = request.model.model_case.model.element_instances().size();
    } catch (const ModelError& error) {
      for (const Finding& finding : error.findings())
        if (said.insert(finding.text()).second) findings.push_back(finding);
    }
  if (!findings.empty()) {
    if (line.json) print(json_text({{"model", line.model}, {"faults", faults_array(findings)}}));
    throw ModelError(std::move(findings));
  }
  if (line.json)
    print(json_text({{"model", line.model},
                     {"faults", Json::array()},
                     {"nodes", nodes},
                     {"elements", elements},
                     {"runs", names}}));
  else
    print(line.model + ": sound; " + counted(nodes, "node") + ", " + counted(elements, "element") +
          (names.empty() ? "" : "; runs: " + join(names)) + "\n");
  return kSuccess;
}

}  // namespace drev::app
