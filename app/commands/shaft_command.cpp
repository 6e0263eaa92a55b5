#include "app/base/output_file.hpp"
#include "app/base/parameter_text.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/sweep_request.hpp"
#include "app/report/report_file.hpp"
#include "app/report/report_origin.hpp"
#include "app/report/report_page.hpp"
#include "app/results/shaft_result.hpp"

namespace drev::app {

int shaft_command(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  std::vector<PlacedShaft> shafts;
  if (model) shafts = contour_shafts(model->model_case.model);
  if (model && shafts.empty())
    findings.push_back({model->entry->name, "contour_shaft", "", "",
                        "is missing: no element of the model is a shaft by its contour; docs/shafts.md"});
  const auto out = line.option("--out");
  if (out && model) check_output("--out", *out + "/shaft.json", model->model_case.files, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  std::optional<ReportFile> report;
  if (const auto file = line.option("--report")) report.emplace(*file);
  const Json object = shafts_object(*model, shafts);
  if (out) {
    create_directory(*out);
    write_file(*out, "shaft", "json", json_text(object));
  }
  if (report) {
    Json data = object;
    data["kind"] = "shaft";
    add_origin(data);
    data["command"] = words_of(line) + model_options(model->parameters);
    data["about"] = model->entry->summary.empty() ? model->model_case.note : model->entry->summary;
    data["inputs"] = inputs_array(model->parameters);
    report->commit(report_page({block_text(data)}, ReportPage::shaft));
  }
  print(line.json ? json_text(object) : shafts_as_text(*model, shafts));
  return kSuccess;
}

}  // namespace drev::app
