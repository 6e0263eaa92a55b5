#include <drev/core/units.hpp>

#include "app/base/output_file.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/sweep_request.hpp"
#include "app/report/report_file.hpp"
#include "app/report/report_model.hpp"
#include "app/report/report_page.hpp"
#include "app/report/sweep_report.hpp"
#include "app/results/class_result.hpp"

namespace drev::app {

namespace {

ClassCase judged_case(const std::string& name, SweepRequest request) {
  ClassCase found{name, std::move(request), {}, {}};
  found.sweep = sweep_linear(found.request.model.system, found.request.options);
  found.judgement = judge_sweep(found.sweep, *found.request.model.model_case.strength);
  return found;
}

std::vector<std::string> names_of(const LinearSweep& sweep) {
  std::vector<std::string> names;
  for (const SweepSection& section : sweep.sections) names.push_back(section.name);
  return names;
}

Json report_data(const CommandLine& line, const std::vector<ClassCase>& cases, const Json& judged) {
  std::vector<SweepBeside> beside;
  for (std::size_t i = 1; i < cases.size(); ++i) beside.push_back({cases[i].name, &cases[i].sweep});
  Json data = sweep_report_data(cases.front().request, cases.front().sweep, "torsional vibration calculation",
                                words_of(line),
                                limits_of(*cases.front().request.model.model_case.strength,
                                          names_of(cases.front().sweep), cases.front().sweep.speeds),
                                beside);
  data["class"] = judged;
  return data;
}

}  // namespace

int class_command(const CommandLine& line) {
  std::vector<ClassCase> cases;
  SweepRequest request = request_sweep(line, {"/class.json"});
  const std::shared_ptr<const Strength> strength = request.model.model_case.strength;
  if (!strength || strength->sections.empty())
    throw ModelError({{request.model.entry->name, "[class]", "", "",
                       "is missing: say in the model file what sections may carry, [class.sections.NAME]; "
                       "docs/class_report.md"}});
  CommandLine with_misfire = line;
  for (const auto& [name, value] : strength->misfire)
    with_misfire.parameters.emplace_back(name, to_text(value));
  std::optional<ReportFile> report;
  if (const auto file = line.option("--report")) report.emplace(*file);
  const bool misfire = !strength->misfire.empty();
  cases.push_back(judged_case("normal", std::move(request)));
  if (misfire) cases.push_back(judged_case("misfire", request_sweep(with_misfire, {})));
  const ModelRequest& model = cases.front().request.model;
  const Json judged = class_object(cases, model_object(model.model_case.model, model.system));
  if (const auto out = line.option("--out")) {
    create_directory(*out);
    write_file(*out, "class", "json", json_text(judged));
  }
  if (report) report->commit(report_page({block_text(report_data(line, cases, judged))}, ReportPage::judged));
  print(line.json ? json_text(judged) : class_as_text(cases));
  return kSuccess;
}

}  // namespace drev::app
