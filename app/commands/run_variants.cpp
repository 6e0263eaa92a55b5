#include "app/commands/run_variants.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <thread>

#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/base/progress.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/option_values.hpp"
#include "app/cli/print.hpp"
#include "app/commands/model_list.hpp"
#include "app/commands/sweep_request.hpp"
#include "app/commands/variants.hpp"
#include "app/report/report_file.hpp"
#include "app/report/report_page.hpp"
#include "app/report/variants_report.hpp"
#include "app/results/hdf5_file.hpp"
#include "app/run/run_computation.hpp"
#include "app/variants/ranks.hpp"
#include "app/variants/variant_points.hpp"
#include "app/variants/variant_table.hpp"
#include "app/variants/variant_work.hpp"

namespace drev::app {

namespace {

/// Options that a table has no use for, and why.
constexpr std::pair<const char*, const char*> kWithout[] = {
    {"--accuracy", "is for single runs, whose figures it finds with their errors"},
    {"--settle",
     "is for single runs: figures of a table are of the whole run; with --start static or periodic "
     "nothing has to settle"},
    {"--reduce", "is for single runs"},
    {"--events", "is for one run"},
    {"--rainflow", "is for single runs"},
    {"--orders-of", "is for single runs"},
    {"--energy", "is for single runs"},
    {"--every", "is for single runs, which have a history"},
    {"--format", "is for single runs, which have a history"}};

}  // namespace

void check_study_folder(const VariantStudy& study, const std::string& folder, bool resume) {
  const auto description = VariantStore::description_in(folder);
  std::vector<Finding> findings;
  std::vector<std::string> columns{"status"};
  for (const Varied& v : study.plan().varied()) columns.push_back(v.name);
  for (const FigureColumn& figure : study.figures()) columns.push_back(figure.name);
  if (const auto why = why_no_hdf5(columns))
    findings.push_back({kCommandLine, "--table", "", "", "cannot have all columns: " + *why});
  const auto refuse_others = [&](const std::string& path, const Json& then) {
    for (const std::string& difference : differences(then, study.description()))
      findings.push_back({path, "--resume", "", "", "cannot go on with another study: " + difference});
  };
  if (!description) {
    if (const auto then = resume ? study_of_table(folder) : std::nullopt)
      refuse_others(table_path(folder), *then);
  } else if (resume) {
    refuse_others(VariantStore::path_in(folder), Json::parse(*description, nullptr, false));
  } else if (const auto [done, all] = VariantStore::progress_in(folder); done > 0) {
    const auto then = Json::parse(*description, nullptr, false);
    const std::uint64_t variants = then.is_object() ? then.value("variants", all) : all;
    const std::uint64_t finished =
        std::min(variants, done * (then.is_object() ? then.value("block", 1U) : 1U));
    findings.push_back({VariantStore::path_in(folder), "", "", "",
                        "holds " + std::to_string(finished) + " finished variants, of " +
                            std::to_string(variants) +
                            ", of a study that did not come to its end: add --resume to go on with it, or "
                            "remove that file"});
  }
  if (!findings.empty()) throw ModelError(std::move(findings));
}

VariantSummary finish_table(const VariantStudy& study, VariantStore& store, const std::string& folder) {
  const VariantStatistics statistics = statistics_of(study, store);
  VariantSummary summary = summary_of(study, statistics, store, folder);
  write_variant_table(study, store, folder, json_text(summary.json));
  write_file(folder, "variants", "json", json_text(summary.json));
  sync_directory(folder);
  store.remove();
  return summary;
}

namespace {

int thread_count_of(const CommandLine& line, const Ranks& ranks) {
  std::vector<Finding> findings;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const auto jobs = line.option("--jobs");
  if (jobs) threads = read_count("--jobs", *jobs, kMostThreads, "", findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  return ranks.count() > 1 && !jobs ? 1 : threads;
}

/// The page of the table that is in the folder, where one is asked for.
void write_page(std::optional<ReportFile>& report, const CommandLine& line, const VariantStudy& study,
                const std::string& folder, const Json& summary) {
  if (!report) return;
  VariedTexts varied;
  for (const Varied& v : study.plan().varied()) varied[v.name] = v.text;
  const Json data = variants_report_data(study.request().model, varied, summary,
                                         variant_points(study, folder), words_of(line));
  report->commit(report_page({block_text(data)}, ReportPage::variants));
}

/// The work of the first rank, or of this process alone.
int lead(const CommandLine& line, const VariantStudy& study, const Ranks& ranks, bool& declined) {
  const std::string folder = *line.option("--out");
  const bool resume = line.list("--resume").has_value();
  const int threads = thread_count_of(line, ranks);
  check_study_folder(study, folder, resume);
  std::optional<ReportFile> report;
  if (const auto file = line.option("--report")) report.emplace(*file);
  if (resume && !VariantStore::description_in(folder))
    if (study_of_table(folder)) {  // of this study
      const Json summary = summary_of_table(folder).value_or(Json::object());
      write_page(report, line, study, folder, summary);
      print(line.json ? json_text(summary) : labelled("table", table_path(folder) + " is complete already"));
      const int code = exit_code_of(summary);
      if (code != kSuccess)
        std::fprintf(stderr, "drev: not all of its variants succeeded; variants.json in %s says why\n",
                     folder.c_str());
      return code;
    }
  watch_signals();
  VariantStore store(folder, study.description().dump(), study.store_shape(), resume);
  const std::string go_on = "the same command with --resume goes on";
  const auto kept = [&] {
    return std::to_string(std::min(study.plan().count(), store.count() * study.block_size())) + " of " +
           std::to_string(study.plan().count()) + " variants are kept in " + store.path() + "; " + go_on;
  };
  declined = false;
  WorkOutcome outcome;
  try {
    outcome = lead_work(study, ranks, threads, store);
  } catch (const OutputError& error) {
    throw OutputError(std::string(error.what()) + "; " + kept());
  }
  if (outcome.interrupted || !outcome.fault.empty()) {
    std::fprintf(stderr, "drev: %s; %s\n",
                 outcome.fault.empty() ? "interrupted" : ("ended: " + outcome.fault).c_str(), kept().c_str());
    return outcome.fault.empty() ? kInterrupted : kNotTrusted;
  }
  VariantSummary summary;
  try {
    summary = finish_table(study, store, folder);
  } catch (const OutputError& error) {
    throw OutputError(std::string(error.what()) + "; " + kept());
  }
  write_page(report, line, study, folder, summary.json);
  std::string text = summary.text;
  if (outcome.computed > 0 && outcome.seconds > 0.0) {
    const int cores = threads * ranks.count();
    // Of short work a whole number of seconds would be 0.
    const std::string time =
        outcome.seconds < 90.0 ? digits(outcome.seconds, 2) + " s" : rough_time(outcome.seconds);
    text +=
        labelled("time", time + " on " + std::to_string(cores) + (cores == 1 ? " thread: " : " threads: ") +
                             digits(static_cast<double>(outcome.computed) / outcome.seconds / cores, 3) +
                             " variants a second on each");
  }
  if (line.quiet || line.json)  // what is wrong is not seen in the text then
    std::fputs(summary.remarks.empty() ? "" : ("drev: of the variants\n" + summary.remarks).c_str(), stderr);
  print(line.json ? json_text(summary.json) : text);
  return summary.exit_code;
}

/// A distribution gives a number with digits that nobody typed: of a parameter that is another thing it is refused at once.
void check_distributions(const CommandLine& line, const std::vector<Varied>& varied,
                         std::vector<Finding>& findings) {
  using enum Varied::Kind;
  std::optional<Parameters> known;
  for (const Varied& v : varied) {
    if (v.kind != uniform && v.kind != normal) continue;
    if (!known && !(known = model_parameters(line))) return;
    for (const Parameter& p : known->known()) {
      if (p.name != v.name || p.kind == Parameter::Kind::number) continue;
      std::string why = "has a distribution of numbers, and " + p.name + " is " + p.range() +
                        ": give values, " + p.name + "=A,B,C";
      if (p.kind == Parameter::Kind::integer)
        why = p.name + " is a whole number: give its values, " + p.name + "=" +
              (v.kind == uniform ? short_digits(std::ceil(v.first), 12) + ":1:" +
                                       short_digits(std::max(std::ceil(v.first), std::floor(v.second)), 12)
                                 : "FIRST:1:LAST");
      findings.push_back({kCommandLine, "--vary", v.name + "=" + v.text, "", why});
    }
  }
}

}  // namespace

VariantStudy study_of(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  const auto models = line.list("MODEL").value_or(std::vector<std::string>{});
  const bool several = models.size() > 1 || (models.size() == 1 && is_model_directory(models.front()));
  if (several)
    findings.push_back({kCommandLine, "--table", "", "", "is of one model's variants; give one MODEL"});
  for (const auto& [option, why] : kWithout)
    if (line.list(option) && *line.option(option) != "0")
      findings.push_back({kCommandLine, option, "", "", why});
  const auto words = line.list("--vary").value_or(std::vector<std::string>{});
  if (words.empty())
    findings.push_back({kCommandLine, "--vary", "", "", "is needed: what differs between variants"});
  for (const std::string& word : words)
    for (const auto& [name, value] : line.parameters)
      if (word.starts_with(name + "="))
        findings.push_back({kCommandLine, "--vary", name, "", "is set by --set already"});
  const std::size_t before = findings.size();
  const bool sampled = line.option("--sample").has_value();
  std::vector<Varied> varied = read_varied(words, sampled ? 0.0 : VariantPlan::kMost, findings);
  check_finite("--vary", line, listed_values(varied), findings);
  check_distributions(line, varied, findings);
  std::optional<Sampling> sampling;
  if (sampled) sampling = read_sampling(*line.option("--sample"), findings);
  std::vector<Correlation> correlations =
      read_correlations(line.list("--correlate").value_or(std::vector<std::string>{}), findings);
  if (several) throw ModelError(std::move(findings));
  std::optional<VariantPlan> plan;
  if (findings.size() == before) plan.emplace(std::move(varied), sampling, std::move(correlations), findings);

  CommandLine first = line;  // What is wrong with all variants is said once, with what is wrong above.
  for (const char* option : {"--out", "--report", "--jobs", "--resume", "--sample", "--correlate", "--vary"})
    first.options.erase(option);
  first.keeps_history = true;  // --record needs no file
  for (const auto& [option, why] : kWithout)
    if (blamed(findings, option)) first.options.erase(option);
  VariantList variants;
  if (plan && findings.size() == before)
    variants = {plan->count(), [&plan](std::uint64_t i) { return plan->parameters(i); }};
  first.findings = findings;
  RunRequest request = request_variant(first, variants);
  if (const auto report = line.option("--report")) {
    if (const auto why = why_no_report(*report))
      findings.push_back({kCommandLine, "--report", *report, "", *why});
    check_output("--report", *report, request.model.model_case.files, findings);
    if (!findings.empty()) throw ModelError(std::move(findings));
  }
  if (request.accuracy)
    throw ModelError(std::vector<Finding>{
        {kCommandLine, "--accuracy", "", "",
         "of the model's [run] is for single runs: name a --method, or a --step, for the table"}});
  if (request.settle && (!request.settle->time || *request.settle->time > 0.0))
    throw ModelError(std::vector<Finding>{{kCommandLine, "--settle", "", "",
                                           "of the model's [run] is for single runs: figures of a table are "
                                           "of the whole run; give --settle 0"}});
  settle_method(request);
  return {std::move(request), std::move(*plan), line.list("--record").has_value()};
}

bool means_variants(const CommandLine& line) {
  return line.list("--table") || line.list("--resume") || line.list("--sample") || line.list("--correlate") ||
         (line.list("--vary") && launched_beside_others());
}

int run_variants(const CommandLine& line) {
  const Ranks ranks;
  if (!ranks.first()) set_quiet(true);
  bool declined = true;
  std::optional<VariantStudy> study;
  try {
    CommandLine asked = line;
    if (!line.option("--out"))
      asked.findings.push_back({kCommandLine, "--out", "", "", "is needed: the table's folder"});
    study.emplace(study_of(asked));
    if (ranks.first()) {
      const int code = lead(line, *study, ranks, declined);
      if (declined) decline_work(ranks, {});
      return code;
    }
  } catch (const std::exception& error) {
    if (!ranks.first()) {
      decline_work(ranks, error.what());
      return kSuccess;  // the first rank says it, and ends with the code
    }
    if (declined) decline_work(ranks, {});
    throw;
  }
  watch_signals();
  follow_work(*study, ranks, thread_count_of(line, ranks));
  return kSuccess;
}

}  // namespace drev::app
