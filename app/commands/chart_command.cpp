#include <drev/core/law/friction.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <cstdio>

#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/chart/chart_computation.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/method_option.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/option_values.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"

namespace drev::app {

namespace {

constexpr Range kLimit{1e-3, 1e4};  // s of processor time, of one run

/// What `drev chart` draws unless told otherwise.
std::vector<std::string> chart_methods(const System& system) {
  std::vector<std::string> methods{"average_acceleration",
                                   "generalized_alpha:0.8",
                                   "bathe",
                                   "sdirk4",
                                   "rk4",
                                   "generalized_alpha:0.8@tolerance",
                                   "sdirk4@tolerance",
                                   "dormand_prince@tolerance",
                                   "central_difference"};
  if (!why_not_exact(system)) methods.insert(methods.begin(), kExact);
  return methods;
}

ChartRequest request_chart(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  for (const std::string& name : line.list("--methods").value_or(std::vector<std::string>{})) {
    const std::size_t at = name.find("@tolerance");
    if (name == kExact && model)
      check_exact("--methods", model->system, findings);
    else if (name != kExact)
      check_step_scheme("--methods", at == name.npos ? name : name.substr(0, at), findings);
  }
  if (model && !model->system.frictions().empty())
    findings.push_back({model->system.name(), "chart", "", "",
                        *why_not_friction(model->system, "every other method that a chart would compare") +
                            ", in drev run, with --tolerance and --accuracy for its error"});
  double limit = 1.0;
  if (line.option("--limit")) limit = read_time("--limit", *line.option("--limit"), kLimit, "", findings);
  if (const auto out = line.option("--out"); out && model)
    check_output("--out", *out + "/chart.csv", model->model_case.files, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  std::vector<std::string> methods = line.list("--methods").value_or(chart_methods(model->system));
  return {std::move(*model), std::move(methods), limit, line.option("--out")};
}

}  // namespace

int chart_command(const CommandLine& line) {
  const ChartRequest request = request_chart(line);
  if (request.out) create_directory(*request.out);
  watch_signals();
  const ChartResult result = compute_chart(request);
  if (result.data.interrupted) {
    std::fprintf(stderr, "drev: interrupted; nothing is written, for a chart needs all of its runs\n");
    return kInterrupted;
  }
  if (request.out) {
    write_file(*request.out, "chart", "csv", chart_as_csv(result));
    write_file(*request.out, "error_over_time", "svg", chart_as_svg(request, result, ChartAxis::time));
    write_file(*request.out, "error_over_work", "svg", chart_as_svg(request, result, ChartAxis::work));
  }
  print(line.json ? chart_as_json(request, result) : chart_as_text(request, result));
  return kSuccess;
}

}  // namespace drev::app
