#include "app/commands/run_many.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>
#include <thread>

#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/base/progress.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/option_values.hpp"
#include "app/cli/print.hpp"
#include "app/commands/child_process.hpp"
#include "app/commands/model_list.hpp"
#include "app/commands/variants.hpp"
#include "app/results/many_runs.hpp"
#include "app/variants/varied.hpp"

namespace drev::app {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMostJobs = 400;  // two descriptors each

std::string without_prefix(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text.starts_with("drev: ") ? text.substr(6) : text;
}

/// What became of a run whose process has ended.
void take_result(const ChildProcess& process, OneOfMany& run) {
  run.code = process.exit_code();
  const Json printed = Json::parse(process.out(), nullptr, false);
  if (printed.is_object()) run.summary = printed;
  const std::string said = without_prefix(process.err());
  if (process.signal() != 0) {
    run.status = interrupted() && process.signal() == SIGTERM ? "interrupted" : "killed";
    run.reason = std::string("its process was ended by a signal: ") + ::strsignal(process.signal());
  } else if (run.code == kNotWritten) {
    run.status = "output_error";
    run.reason = said;
  } else if (run.summary.is_object()) {
    run.status = run.summary["status"];
    if (run.summary["reason"].is_string()) run.reason = run.summary["reason"];
  } else {
    run.status = run.code == kBadInput ? "bad_input" : "failed";
    run.reason = said.empty() ? "it ended with exit code " + std::to_string(run.code) : said;
  }
}

class Batch {
 public:
  /// Opens runs.json.
  Batch(ManyRuns many, const CommandLine& line)
      : many_(std::move(many)), line_(line), running_(many_.runs.size()) {
    create_directory(many_.folder);
    json_.emplace(many_.folder, "runs", "json");
    json_->replace(many_as_json(many_));
  }

  /// Returns when nothing runs any more: all have ended, or those that ran when the signal came.
  void run(std::size_t at_once) {
    bool stopped = false;
    for (std::size_t next = 0; next < many_.runs.size() || in_work() > 0;) {
      while (!interrupted() && next < many_.runs.size() && in_work() < at_once) start(next++);
      if (interrupted()) {
        next = many_.runs.size();
        if (!stopped)
          for (const Running& running : running_)
            if (running.process) running.process->stop();
        stopped = true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      for (std::size_t i = 0; i < running_.size(); ++i)
        if (running_[i].process && running_[i].process->ended()) end(i);
      write_state();
      progress_.show(progress_text());
    }
    progress_.clear();
    many_.status = interrupted()                            ? "interrupted"
                   : many_.count(true) == many_.runs.size() ? "success"
                                                            : "failed";
  }

  /// runs.csv and runs.json. Throws OutputError.
  void write_results() {
    OutputFile csv(many_.folder, "runs", "csv");
    csv.write(many_as_csv(many_));
    json_->replace(many_as_json(many_));
    if (many_.status == "interrupted") return csv.flush();
    csv.commit();
    json_->commit();
  }

  const ManyRuns& result() const { return many_; }

  int exit_code() const {
    if (many_.status == "interrupted") return kInterrupted;
    std::vector<int> codes;
    for (const OneOfMany& run : many_.runs)
      if (!run.ok()) codes.push_back(run.code > 0 ? run.code : kNotTrusted);
    if (codes.empty()) return kSuccess;
    const bool alike = std::count(codes.begin(), codes.end(), codes.front()) == std::ssize(codes);
    return alike ? codes.front() : kNotTrusted;
  }

 private:
  struct Running {
    std::unique_ptr<ChildProcess> process = {};
    Clock::time_point started = {};
  };

  std::size_t in_work() const {
    return static_cast<std::size_t>(std::count_if(running_.begin(), running_.end(),
                                                  [](const Running& r) { return r.process != nullptr; }));
  }

  void start(std::size_t i) {
    OneOfMany& run = many_.runs[i];
    std::vector<std::string> arguments{"run", run.model.model, "--out=" + run.folder, "--json"};
    for (const auto& parameters : {line_.parameters, run.varied})
      for (const auto& [name, value] : parameters) {
        arguments.push_back("--set");
        arguments.push_back(name + "=" + value);
      }
    for (const auto& [name, values] : line_.options)
      if (name != "MODEL" && name != "--out" && name != "--jobs" && name != "--vary")
        arguments.push_back(name + "=" + join(values, ","));
    changed_ = true;
    try {
      running_[i] = {std::make_unique<ChildProcess>(arguments), Clock::now()};
      run.status = "running";
    } catch (const std::system_error& error) {
      run.status = "failed";
      run.reason = error.what();
      run.code = kNotTrusted;
      tell_failure(run);
    }
  }

  void end(std::size_t i) {
    OneOfMany& run = many_.runs[i];
    take_result(*running_[i].process, run);
    run.wall_time = std::chrono::duration<double>(Clock::now() - running_[i].started).count();
    running_[i].process.reset();
    changed_ = true;
    if (!run.ok()) tell_failure(run);
  }

  void tell_failure(const OneOfMany& run) {
    progress_.clear();
    std::fprintf(stderr, "drev: %s: %s: %s\n", run.model.name.c_str(), run.status.c_str(),
                 run.reason.c_str());
  }

  /// Not more often than every second.
  void write_state() {
    if (!changed_ || Clock::now() - written_ < std::chrono::seconds(1)) return;
    written_ = Clock::now();
    try {
      json_->replace(many_as_json(many_));
      changed_ = false;
    } catch (const OutputError&) {  // what can still be written at the end, is
    }
  }

  std::string progress_text() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < running_.size(); ++i)
      if (running_[i].process) names.push_back(many_.runs[i].model.name);
    const std::size_t failed = many_.count(false);
    std::string text =
        std::to_string(many_.count(true) + failed) + " of " + std::to_string(many_.runs.size()) + " done";
    if (failed > 0) text += ", " + std::to_string(failed) + " failed";
    return text + (interrupted() ? "; waiting for " : "; running ") + join(names);
  }

  ManyRuns many_;
  const CommandLine& line_;
  std::vector<Running> running_;  ///< one each of many_.runs
  std::optional<ReplacedFile> json_;
  Progress progress_;
  bool changed_ = false;  ///< since it was written
  Clock::time_point written_ = {};
};

/// Every model with every variant, each with a folder of its own.
std::vector<OneOfMany> all_runs(const std::vector<NamedModel>& models, const std::vector<Variant>& variants,
                                const std::string& folder) {
  std::vector<OneOfMany> runs;
  for (const NamedModel& model : models)
    for (const Variant& variant : variants) {
      const std::string varied = variant.name();
      const std::string name = varied.empty()      ? model.name
                               : models.size() > 1 ? model.name + "," + varied
                                                   : varied;
      runs.push_back(
          {.model = {name, model.model}, .varied = variant.parameters, .folder = folder + "/" + name});
    }
  return runs;
}

}  // namespace

bool means_many(const CommandLine& line) {
  const auto models = line.list("MODEL").value_or(std::vector<std::string>{});
  return models.size() > 1 || (models.size() == 1 && is_model_directory(models.front())) ||
         line.list("--vary");
}

int run_many(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  ModelList list = list_models(line.list("MODEL").value_or(std::vector<std::string>{}), findings);
  // What is wrong with all variants of one model is said once, with what is wrong with the line.
  CommandLine first = line;
  const bool one = line.list("--vary") && list.models.size() <= 1;
  if (one && !list.models.empty()) first.model = list.models.front().model;
  const auto words = line.list("--vary").value_or(std::vector<std::string>{});
  const std::size_t before = findings.size();
  const std::vector<Variant> variants = read_variants(words, findings);
  std::vector<Finding> told;
  check_finite("--vary", first, listed_values(read_varied(words, 0.0, told)), findings);
  if (!variants.empty())
    for (const auto& [name, value] : variants.front().parameters)
      if (std::any_of(line.parameters.begin(), line.parameters.end(),
                      [&name = name](const auto& parameter) { return parameter.first == name; }))
        findings.push_back({kCommandLine, "--vary", name, "", "is set by --set already"});
  VariantList listed;
  if (findings.size() == before)
    listed = {variants.size(), [&variants](std::uint64_t i) { return variants[i].parameters; }};
  if (!line.option("--out"))
    findings.push_back(
        {kCommandLine, "--out", "", "", "is needed for several runs: each has its folder there"});
  if (const auto report = line.option("--report"))
    findings.push_back(
        {kCommandLine, "--report", *report, "", "is for one run; of several, each folder has a report"});
  if (const auto events = line.option("--events"))
    findings.push_back({kCommandLine, "--events", *events, "", "is for one run"});
  int at_once = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (const auto jobs = line.option("--jobs")) at_once = read_count("--jobs", *jobs, kMostJobs, "", findings);
  if (one) {
    for (const char* option : {"--jobs", "--report", "--events"}) first.options.erase(option);
    if (!line.option("--out")) first.options.erase("--format");
    first.keeps_history = true;  // --record needs no more than the --out that is asked for above
    first.findings = findings;
    request_variant(first, listed);
  }
  if (!findings.empty()) throw ModelError(std::move(findings));

  watch_signals();
  const std::string folder = *line.option("--out");
  Batch batch(
      {.runs = all_runs(list.models, variants, folder), .skipped = std::move(list.skipped), .folder = folder},
      line);
  batch.run(static_cast<std::size_t>(at_once));
  std::optional<OutputError> unwritten;
  try {
    batch.write_results();
  } catch (const OutputError& error) {  // what became of the runs is told all the same
    unwritten = error;
  }
  print(line.json ? many_as_json(batch.result()) : many_as_text(batch.result()));
  if (unwritten) throw *unwritten;
  return batch.exit_code();
}

}  // namespace drev::app
