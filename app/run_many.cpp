#include "app/run_many.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <thread>

#include "app/child_process.hpp"
#include "app/exit_codes.hpp"
#include "app/interrupt.hpp"
#include "app/model_list.hpp"
#include "app/output_file.hpp"
#include "app/progress.hpp"
#include "app/run_json.hpp"
#include "app/text_layout.hpp"

namespace drev::app {

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kPlace = "command line";
constexpr double kMostJobs = 1000;

struct Job {
  NamedModel model;
  std::string folder;
  std::unique_ptr<ChildProcess> process = {};  ///< while it runs
  Clock::time_point started = {};
  double wall_time = 0.0;  ///< s
  std::string status = "not_started", reason = {};
  int code = 0;       ///< the exit code of its process, -1: killed
  Json summary = {};  ///< null: there is none

  bool ended() const { return status != "not_started" && status != "running"; }
  bool ok() const { return status == "success"; }
};

std::string without_prefix(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text.starts_with("drev: ") ? text.substr(6) : text;
}

/// What became of a run whose process has ended.
void take_result(Job& job) {
  const ChildProcess& process = *job.process;
  job.wall_time = std::chrono::duration<double>(Clock::now() - job.started).count();
  job.code = process.exit_code();
  const Json printed = Json::parse(process.out(), nullptr, false);
  if (printed.is_object()) job.summary = printed;
  const std::string said = without_prefix(process.err());
  if (process.signal() != 0) {
    job.status = interrupted() ? "interrupted" : "killed";
    job.reason = std::string("its process was ended by a signal: ") + ::strsignal(process.signal());
  } else if (job.code == kNotWritten) {
    job.status = "output_error";
    job.reason = said;
  } else if (job.summary.is_object()) {
    job.status = job.summary["status"];
    if (job.summary["reason"].is_string()) job.reason = job.summary["reason"];
  } else {
    job.status = job.code == kBadInput ? "bad_input" : "failed";
    job.reason = said.empty() ? "it ended with exit code " + std::to_string(job.code) : said;
  }
  job.process.reset();
}

/// Options of the command line that go to every run.
std::vector<std::string> shared_arguments(const CommandLine& line) {
  std::vector<std::string> arguments{"--json"};
  for (const auto& [name, value] : line.settings) {
    arguments.push_back("--set");
    arguments.push_back(name + "=" + value);
  }
  for (const auto& [name, values] : line.options)
    if (name != "MODEL" && name != "--out" && name != "--jobs")
      arguments.push_back(name + "=" + join(values, ","));
  return arguments;
}

class Batch {
 public:
  Batch(std::vector<NamedModel> models, std::vector<SkippedFile> skipped, const std::string& out)
      : skipped_(std::move(skipped)), out_(out) {
    for (NamedModel& model : models) {
      const std::string folder = out + "/" + model.name;
      jobs_.push_back({.model = std::move(model), .folder = folder});
    }
    create_directory(out);
    state_.emplace(out, "runs", "json");
    state_->replace(text());
  }

  /// Returns when nothing runs any more: all have ended, or those that ran when the signal came.
  void run(std::size_t at_once, const std::vector<std::string>& arguments) {
    bool stopped = false;
    for (std::size_t next = 0; next < jobs_.size() || running() > 0;) {
      while (!interrupted() && next < jobs_.size() && running() < at_once)
        start(jobs_[next++], arguments);
      if (interrupted()) {
        next = jobs_.size();
        if (!stopped)
          for (const Job& job : jobs_)
            if (job.process) job.process->stop();
        stopped = true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      for (Job& job : jobs_)
        if (job.process && job.process->ended()) end(job);
      progress_.show(progress_text());
    }
    progress_.clear();
    over_ = true;
    state_->replace(text());
    if (!interrupted()) state_->commit();
  }

  int exit_code() const {
    if (interrupted()) return kInterrupted;
    std::vector<int> codes;
    for (const Job& job : jobs_)
      if (!job.ok()) codes.push_back(job.code > 0 ? job.code : kNotTrusted);
    if (codes.empty()) return kSuccess;
    const bool alike = std::count(codes.begin(), codes.end(), codes.front()) == std::ssize(codes);
    return alike ? codes.front() : kNotTrusted;
  }

  std::string text() const;
  std::string table() const;

 private:
  std::size_t running() const {
    return static_cast<std::size_t>(std::count_if(
        jobs_.begin(), jobs_.end(), [](const Job& job) { return job.process != nullptr; }));
  }
  std::size_t count(bool ok) const {
    return static_cast<std::size_t>(std::count_if(
        jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.ended() && job.ok() == ok; }));
  }

  void start(Job& job, const std::vector<std::string>& shared) {
    std::vector<std::string> arguments{"run", job.model.model, "--out=" + job.folder};
    arguments.insert(arguments.end(), shared.begin(), shared.end());
    job.started = Clock::now();
    job.process = std::make_unique<ChildProcess>(arguments);
    job.status = "running";
    write_state();
  }

  void end(Job& job) {
    take_result(job);
    if (!job.ok()) {
      progress_.clear();
      std::fprintf(stderr, "drev: %s: %s: %s\n", job.model.name.c_str(), job.status.c_str(),
                   job.reason.c_str());
    }
    write_state();
  }

  /// Not more often than every second.
  void write_state() {
    if (Clock::now() - written_ < std::chrono::seconds(1)) return;
    state_->replace(text());
    written_ = Clock::now();
  }

  std::string progress_text() const {
    std::vector<std::string> names;
    for (const Job& job : jobs_)
      if (job.process) names.push_back(job.model.name);
    std::string text = std::to_string(count(true) + count(false)) + " of " +
                       std::to_string(jobs_.size()) + " done";
    if (count(false) > 0) text += ", " + std::to_string(count(false)) + " failed";
    return text + (interrupted() ? "; waiting for " : "; running ") + join(names);
  }

  std::vector<Job> jobs_;
  std::vector<SkippedFile> skipped_;
  std::string out_;
  std::optional<ReplacedFile> state_;
  Progress progress_;
  Clock::time_point written_ = {};
  bool over_ = false;
};

std::string Batch::text() const {
  Json object = result_object("runs");
  object["status"] = !over_                        ? "running"
                     : interrupted()               ? "interrupted"
                     : count(true) == jobs_.size() ? "success"
                                                   : "failed";
  object["folder"] = out_;
  object["runs"] = Json::array();
  for (const Job& job : jobs_)
    object["runs"].push_back({{"name", job.model.name},
                              {"model", job.model.model},
                              {"folder", job.folder},
                              {"status", job.status},
                              {"reason", text_or_null(job.reason)},
                              {"exit_code", job.ended() && job.code >= 0 ? Json(job.code) : Json()},
                              {"wall_time_s", job.ended() ? number(job.wall_time) : Json()},
                              {"summary", job.summary}});
  object["skipped"] = Json::array();
  for (const SkippedFile& file : skipped_)
    object["skipped"].push_back({{"file", file.file}, {"reason", file.reason}});
  return json_text(object);
}

/// The first of the keys that has a number, with its unit; empty: none.
std::string figure(const Json& summary,
                   const std::vector<std::pair<const char*, const char*>>& keys) {
  if (!summary.is_object()) return {};
  for (const auto& [key, unit] : keys)
    if (const Json& value = summary["results"][key]; value.is_number())
      return digits(value.get<double>(), 5) + " " + unit;
  return {};
}

std::string Batch::table() const {
  std::vector<std::vector<std::string>> rows{
      {"model", "status", "deflection", "torque or force", "results in"}};
  for (const Job& job : jobs_)
    rows.push_back({job.model.name, job.status,
                    figure(job.summary, {{"deflection_deg", "deg"}, {"deflection_m", "m"}}),
                    figure(job.summary, {{"max_torque_Nm", "N m"}, {"max_force_N", "N"}}),
                    job.summary.is_object() || job.status == "killed" ? job.folder : ""});
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    std::string shown;
    for (std::size_t c = 0; c < row.size(); ++c) {
      std::size_t width = 0;
      for (const std::vector<std::string>& other : rows) width = std::max(width, other[c].size());
      const bool figures = c == 2 || c == 3;
      shown += (figures ? pad_left(row[c], width) : pad_right(row[c], width)) + "  ";
    }
    text += shown.substr(0, shown.find_last_not_of(' ') + 1) + "\n";
  }
  for (const Job& job : jobs_)
    if (!job.reason.empty())
      text += "\n" + wrap(job.model.name + ": " + job.status + ": " + job.reason, 2);
  if (!skipped_.empty()) text += "\n";
  for (const SkippedFile& file : skipped_)
    text += wrap("not run: " + file.file + ": " + file.reason, 2);
  return text + "\n" + std::to_string(count(true)) + " of " + std::to_string(jobs_.size()) +
         " succeeded; " + out_ + (interrupted() ? "/runs.partial.json" : "/runs.json") +
         " has all of this table and more\n";
}

}  // namespace

bool means_many(const CommandLine& line) {
  const auto models = line.list("MODEL").value_or(std::vector<std::string>{});
  return models.size() > 1 || (models.size() == 1 && is_model_directory(models.front()));
}

int run_many(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  ModelList list = list_models(line.list("MODEL").value_or(std::vector<std::string>{}), findings);
  if (!line.option("--out"))
    findings.push_back(
        {kPlace, "--out", "", "", "is needed for several models: each has its folder there"});
  if (const auto report = line.option("--report"))
    findings.push_back({kPlace, "--report", *report, "",
                        "is for one model; of several, each folder has a report"});
  double at_once = std::max(1U, std::thread::hardware_concurrency());
  if (const auto jobs = line.option("--jobs"))
    if (!read_number(*jobs, at_once) || at_once != std::floor(at_once) ||
        !(at_once >= 1 && at_once <= kMostJobs))
      findings.push_back({kPlace, "--jobs", *jobs, "", "must be a whole number from 1 to 1000"});
  if (!findings.empty()) throw ModelError(std::move(findings));

  watch_signals();
  Batch batch(std::move(list.models), std::move(list.skipped), *line.option("--out"));
  batch.run(static_cast<std::size_t>(at_once), shared_arguments(line));
  print(line.json ? batch.text() : batch.table());
  return batch.exit_code();
}

}  // namespace drev::app
