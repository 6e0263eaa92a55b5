#include <drev/core/units.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>

#include <algorithm>

#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/sweep_request.hpp"
#include "app/report/report_file.hpp"
#include "app/report/report_model.hpp"
#include "app/report/report_page.hpp"
#include "app/report/sweep_report.hpp"
#include "app/results/branches_result.hpp"
#include "app/results/class_result.hpp"
#include "app/results/coupling_notes.hpp"
#include "app/results/sweep_result.hpp"

namespace drev::app {

namespace {

bool follows_contacts(const SweepRequest& request) {
  return !request.options.close_contacts && !request.model.system.scalars().empty();
}

std::string speeds_text(const std::vector<double>& speeds) {
  std::vector<std::string> list;
  for (const double speed : speeds) list.push_back(short_digits(to_rpm(speed), 6));
  return join(list) + " rpm";
}

/// Contacts as they are: at each speed the worst that the train may do, in all cases at the speeds that have an answer
/// in each of them.
void sweep_contacts(const CommandLine& line, std::vector<ClassCase>& cases) {
  std::vector<NonlinearSweep> sweeps;
  std::vector<double> missing;
  for (ClassCase& c : cases) {
    const NonlinearSweepOptions options = nonlinear_options(line, c.request);
    sweeps.push_back(sweep_nonlinear(c.request.model.system, options));
    end_if_interrupted();
    c.notes = excitation_notes(options, sweeps.back());
    for (std::string& note : coupling_notes(c.request.model.system, sweeps.back()))
      c.notes.push_back(std::move(note));
    for (const double speed : worst_motions(sweeps.back()).missing) missing.push_back(speed);
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  const auto has_answer = [&](double speed) {
    return !std::binary_search(missing.begin(), missing.end(), speed);
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    ClassCase& c = cases[i];
    std::vector<double> speeds, speeds_rpm;
    for (std::size_t s = 0; s < c.request.speeds_rpm.size(); ++s) {
      if (!has_answer(c.request.options.speeds[s])) continue;
      speeds.push_back(c.request.options.speeds[s]);
      speeds_rpm.push_back(c.request.speeds_rpm[s]);
    }
    if (speeds.empty())
      throw ModelError({{c.request.model.entry->name + "/class", "speeds", "", "rpm",
                         "have no periodic motion and no run that ended, at any of them; " +
                             std::string("--contact closed judges as if contacts never opened")}});
    sweeps[i].speeds = c.request.options.speeds = speeds;
    c.request.speeds_rpm = speeds_rpm;
    WorstMotions worst = worst_motions(sweeps[i]);
    c.notes.emplace_back(
        "Contacts as they are: at each speed, section by section, the stable motion with the largest half "
        "range.");
    if (!worst.by_runs.empty())
      c.notes.push_back(
          "No periodic motion that was found is stable at " + speeds_text(worst.by_runs) +
          ": half ranges there are between the lowest and the highest value of a run in time; orders and "
          "heat are not known.");
    if (!missing.empty()) c.notes.push_back("No motion was found at " + speeds_text(missing) + ": left out.");
    c.sweep = std::move(worst.sweep);
    c.judgement.without_motion = missing;
  }
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
  data["notes"] = Json::array();  // of the first case alone
  for (const ClassCase& c : cases)
    for (const std::string& note : c.notes)
      data["notes"].push_back(cases.size() > 1 ? c.name + ": " + note : note);
  return data;
}

}  // namespace

int class_command(const CommandLine& line) {
  std::vector<ClassCase> cases;
  SweepRequest request = request_sweep(line, {"/class.json"});
  const std::shared_ptr<const Strength> strength = request.model.model_case.strength;
  if (!strength || strength->sections.empty())
    throw ModelError({{request.model.entry->name, "[class]", "", "",
                       std::string(strength ? "names no section" : "is missing") +
                           ": say in the model file what sections may carry, [class.sections.NAME]; "
                           "docs/class_report.md"}});
  CommandLine with_misfire = line;
  for (const auto& [name, value] : strength->misfire)
    with_misfire.parameters.emplace_back(name, to_text(value));
  std::optional<ReportFile> report;
  if (const auto file = line.option("--report")) report.emplace(*file);
  const bool misfire = !strength->misfire.empty();
  cases.push_back({"normal", std::move(request), {}, {}});
  if (misfire) cases.push_back({"misfire", request_sweep(with_misfire, {}), {}, {}});
  watch_signals();
  if (follows_contacts(cases.front().request)) {
    sweep_contacts(line, cases);
    for (ClassCase& c : cases) {
      std::vector<double> without = std::move(c.judgement.without_motion);
      c.judgement = judge_sweep(c.sweep, *strength);
      c.judgement.without_motion = std::move(without);
    }
  } else {
    for (ClassCase& c : cases) {
      const System& system = c.request.model.system;
      c.sweep = sweep_linear(system, c.request.options);
      c.notes = sweep_notes(c.request, c.sweep);
      if (!c.sweep.modes_note.empty()) c.notes.push_back("Criticals: " + c.sweep.modes_note + ".");
      c.judgement = judge_sweep(c.sweep, *strength, sweep_between(system, c.request.options));
    }
  }
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
