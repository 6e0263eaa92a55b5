#include <drev/core/units.hpp>

#include <memory>

#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/base/progress.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/option_values.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/sweep_request.hpp"
#include "app/report/branches_report.hpp"
#include "app/report/report_file.hpp"
#include "app/report/report_page.hpp"
#include "app/report/sweep_report.hpp"
#include "app/results/branches_result.hpp"
#include "app/results/history_hdf5.hpp"
#include "solvers/periodic/section_rows.hpp"

namespace drev::app {

namespace {

bool is_hdf5(const std::string& out) { return out.ends_with(".h5"); }

/// DIR/NAME.csv of each table and DIR/summary.json, or one HDF5 file.
void write_tables(const std::string& out, const std::vector<TableText>& tables, const std::string& summary) {
  if (is_hdf5(out)) return write_tables_hdf5(out, tables, summary);
  create_directory(out);
  for (const TableText& table : tables) write_file(out, table.name, "csv", table.csv);
  write_file(out, "summary", "json", summary);
}

/// Limits of the model's sections, where it says any.
std::vector<DrawnLimit> model_limits(const ModelRequest& model, const std::vector<std::string>& sections,
                                     const std::vector<double>& speeds) {
  const auto& strength = model.model_case.strength;
  return strength ? limits_of(*strength, sections, speeds) : std::vector<DrawnLimit>{};
}

template <class Sections>
std::vector<std::string> names_of(const Sections& sections) {
  std::vector<std::string> names;
  for (const auto& section : sections) names.push_back(section.name);
  return names;
}

}  // namespace

namespace {

/// Names that the sweep would look up in the model, with all other faults of the command line.
void check_names(const System& system, const LinearSweepOptions& options, std::vector<Finding>& findings) {
  if (!options.sections.empty()) find_section_rows(system, options.sections, findings);
  if (!options.balance.empty()) try {
      system.node(options.balance);
    } catch (const ModelError& error) {
      findings.insert(findings.end(), error.findings().begin(), error.findings().end());
    }
}

/// In quotes where a shell would take it for something else.
std::string in_shell(const std::string& value) {
  const bool plain =
      value.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.,:=/+-%@") ==
      value.npos;
  return plain ? value : "'" + join(split(value, '\''), "'\\''") + "'";
}

void read_nonlinear(const CommandLine& line, NonlinearSweepOptions& options, std::vector<Finding>& findings) {
  if (const auto turns = line.option("--cycle"))
    options.turns = read_plain("--cycle", *turns, {1e-6, 1000.0}, findings);
  if (const auto tolerance = line.option("--tolerance"))
    options.tolerance = read_plain("--tolerance", *tolerance, {1e-12, 0.1}, findings);
  if (const auto jobs = line.option("--jobs"))
    options.threads = read_count("--jobs", *jobs, kMostThreads, "", findings);
}

/// They have a meaning for a train with laws that are no straight lines alone.
void check_nonlinear(const CommandLine& line, const System& system, bool closed,
                     std::vector<Finding>& findings) {
  const bool straight = system.scalars().empty();
  NonlinearSweepOptions unused;
  if (!straight && !closed) {
    if (line.options.contains("--absolute-sum"))
      findings.push_back(
          {kCommandLine, "--absolute-sum", "", "", "is for linear models (or --contact closed)"});
    return read_nonlinear(line, unused, findings);
  }
  for (const char* option : {"--cycle", "--tolerance", "--jobs"})
    if (const auto value = line.option(option))
      findings.push_back({kCommandLine, option, *value, "",
                          straight
                              ? "is for models that are not linear"
                              : "is for models that are not linear, which --contact closed makes this one"});
}

}  // namespace

SweepRequest request_sweep(const CommandLine& line, const std::vector<std::string>& written) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  LinearSweepOptions options{.pause = end_if_interrupted};
  std::vector<double> speeds_rpm;
  if (const auto speeds = line.option("--speeds"))
    speeds_rpm = read_rising("--speeds", *speeds, "rpm", findings);
  else if (!blamed(findings, "--speeds"))
    findings.push_back({kCommandLine, "--speeds", "", "rpm",
                        "is missing: the speeds of the reference shaft, such as 300:10:1800"});
  for (const double speed : speeds_rpm) options.speeds.push_back(rpm(speed));
  if (const auto orders = line.option("--orders"))
    options.orders = read_rising("--orders", *orders, "", findings);
  options.sections = line.list("--record").value_or(std::vector<std::string>{});
  options.close_contacts = line.option("--contact") == "closed";
  options.balance = line.option("--balance").value_or("");
  if (const auto out = line.option("--out"); out && model)
    for (const std::string& name : written)
      check_output("--out", is_hdf5(*out) ? *out : *out + name, model->model_case.files, findings);
  if (const auto report = line.option("--report")) {
    if (const auto why = why_no_report(*report))
      findings.push_back({kCommandLine, "--report", *report, "", *why});
    if (model) check_output("--report", *report, model->model_case.files, findings);
  }
  if (model) check_names(model->system, options, findings);
  if (model) check_nonlinear(line, model->system, options.close_contacts, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  return {std::move(*model), std::move(options), std::move(speeds_rpm),
          line.options.contains("--absolute-sum")};
}

std::string words_of(const CommandLine& line) {
  std::string words = std::string("drev ") + line.command->name + " " + line.model;
  for (const OptionEntry& entry : line.command->options) {
    const std::string option = entry.name;
    const auto values = line.options.find(option);
    if (values == line.options.end() || option == "--out" || option == "--report" || option == "--plugin")
      continue;
    if (entry.values == OptionEntry::Values::again)
      for (const std::string& value : values->second) words += " " + option + " " + in_shell(value);
    else if (entry.values == OptionEntry::Values::none)
      words += " " + option;
    else
      words += " " + option + " " + in_shell(join(values->second, ","));
  }
  return words;
}

NonlinearSweepOptions nonlinear_options(const CommandLine& line, const SweepRequest& request) {
  NonlinearSweepOptions options;
  options.speeds = request.options.speeds;
  options.orders = request.options.orders;
  options.sections = request.options.sections;
  options.balance = request.options.balance;
  std::vector<Finding> none;  // request_sweep() has found them
  read_nonlinear(line, options, none);
  const auto shown = std::make_shared<Progress>();
  options.progress = [shown](double part) {
    shown->update(part);
    return !interrupted();
  };
  return options;
}

namespace {

/// A model with laws that are no straight lines, as it is.
int sweep_branches(const CommandLine& line, const SweepRequest& request) {
  const NonlinearSweepOptions options = nonlinear_options(line, request);
  const auto out = line.option("--out");
  std::optional<ReportFile> report;
  if (const auto file = line.option("--report")) report.emplace(*file);
  watch_signals();
  const NonlinearSweep sweep = sweep_nonlinear(request.model.system, options);
  end_if_interrupted();
  const Json object = line.json || out ? branches_object(request.model, options, sweep) : Json();
  if (out)
    write_tables(*out,
                 {{"branches", motions_as_csv(sweep)},
                  {"orders", motion_orders_as_csv(sweep)},
                  {"changes", changes_as_csv(sweep)}},
                 json_text(object));
  if (report) {
    const Json data =
        branches_report_data(request.model, options, sweep, words_of(line),
                             model_limits(request.model, names_of(sweep.sections), sweep.speeds));
    report->commit(report_page({block_text(data)}, ReportPage::branches));
  }
  print(line.json ? json_text(object) : branches_as_text(request.model, options, sweep));
  return kSuccess;
}

}  // namespace

int sweep_command(const CommandLine& line) {
  const SweepRequest request = request_sweep(line, {"/sweep.csv", "/branches.csv", "/orders.csv",
                                                    "/criticals.csv", "/changes.csv", "/summary.json"});
  if (!request.options.close_contacts && !request.model.system.scalars().empty())
    return sweep_branches(line, request);
  watch_signals();
  std::optional<ReportFile> report;
  if (const auto file = line.option("--report")) report.emplace(*file);
  const LinearSweep sweep = sweep_linear(request.model.system, request.options);
  if (const auto out = line.option("--out"))
    write_tables(*out,
                 {{"sweep", sweep_as_csv(request, sweep)},
                  {"orders", orders_as_csv(request, sweep)},
                  {"criticals", criticals_as_csv(sweep)}},
                 json_text(sweep_object(request, sweep)));
  if (report) {
    const Json data = sweep_report_data(request, sweep, "vibration by orders over speed", words_of(line),
                                        model_limits(request.model, names_of(sweep.sections), sweep.speeds));
    report->commit(report_page({block_text(data)}, ReportPage::sweep));
  }
  print(line.json ? json_text(sweep_object(request, sweep)) : sweep_as_text(request, sweep));
  return kSuccess;
}

}  // namespace drev::app
