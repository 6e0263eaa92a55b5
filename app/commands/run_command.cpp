#include <drev/core/channel.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "app/base/interrupt.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/run_many.hpp"
#include "app/commands/run_request.hpp"
#include "app/report/report_data.hpp"
#include "app/report/report_file.hpp"
#include "app/report/report_history.hpp"
#include "app/report/report_page.hpp"
#include "app/results/history_file.hpp"
#include "app/results/history_hdf5.hpp"
#include "app/results/run_json.hpp"
#include "app/results/run_text.hpp"
#include "app/run/run_computation.hpp"

namespace drev::app {

namespace {

void say(const std::string& text) { std::fprintf(stderr, "drev: %s\n", text.c_str()); }

int exit_code(const RunResult& result) {
  if (result.ok()) return kSuccess;
  if (result.status == "interrupted") return kInterrupted;
  if (result.status == "output_error") return kNotWritten;
  return kNotTrusted;
}

/// Channels of the report: those asked for, and what the contacts carry.
std::vector<std::string> report_channels(const RunRequest& request) {
  constexpr std::size_t kMeshes = 6;
  std::vector<std::string> names = request.record;
  std::size_t meshes = 0;
  for (const Channel& channel : mesh_channels(request.model.system))
    if (meshes++ < kMeshes && std::find(names.begin(), names.end(), channel.name()) == names.end())
      names.push_back(channel.name());
  return names;
}

/// The files of one run. They get their own names only if the run came to its end.
class RunFiles {
 public:
  RunFiles(const RunRequest& request) : request_(request) {
    if (request.out) {
      create_directory(*request.out);
      history_.emplace(*request.out, request.record, request.every);
      summary_.emplace(*request.out, "summary", "json");
      summary_->replace(running_as_json(request));
    }
    if (request.report) report_.emplace(*request.report);
  }

  /// What writes the history of the run, and keeps of it what the report shows.
  std::vector<Observer*> observers(const RunPlan& plan) {
    const System& system = system_of(request_, plan);
    std::vector<Observer*> all;
    if (history_) {
      recorder_.emplace(system, request_.record, request_.every);
      recorder_->set_sink([this](double /*t*/, const std::vector<double>& row) { history_->add(row); });
      all.push_back(&*recorder_);
    }
    if (history_ || report_) {
      shown_.emplace(system, report_channels(request_), report_interval(request_, plan.method));
      all.push_back(&*shown_);
    }
    return all;
  }
  /// What keeps the history from being written; empty: nothing.
  std::string fault() const { return history_ ? history_->error() : ""; }

  /// Returns false, and says why, if something could not be written.
  bool close(const RunResult& result) {
    if (!shown_) return true;
    const bool complete = result.ok() || result.status == "energy_error";
    if (history_) history_->close(complete);
    bool written = !history_ || history_->error().empty();
    if (!written) say(history_->error());
    try {
      if (summary_) write_summary(result, complete && written);
      if (complete && written) write_reports(result);
    } catch (const OutputError& error) {
      say(error.what());
      written = false;
    }
    if (!complete && history_)
      say("what there is of the run is in " + history_->partial_path() + " and " + summary_->partial_path() +
          "; " + history_->path() + ", summary.json and report.html, if they are there, are of an older run");
    return written;
  }

  /// What was written where, for the table.
  std::string text() const {
    std::string text;
    if (history_)
      text += pad_right("History", 24) +
              wrap(std::to_string(history_->rows()) + " rows, every " + short_digits(request_.every, 12) +
                       " s, of " + join(request_.record) + " in " + history_->path(),
                   24);
    if (shown_) text += pad_right("Report", 24) + join(report_paths_) + "\n";
    return text;
  }

 private:
  void write_summary(const RunResult& result, bool commit) {
    const std::string summary = run_as_json(request_, result);
    summary_->replace(summary);
    if (!commit) return;
    summary_->commit();
    if (!request_.hdf5) return warn_of_old_hdf5();
    std::vector<HistoryColumn> columns;
    for (const Channel& channel : find_channels(request_.model.system, request_.record))
      columns.push_back({channel.name(), channel.unit()});
    write_hdf5(*request_.out, history_->path(), columns, summary);
  }

  void warn_of_old_hdf5() const {
    const std::string old = *request_.out + "/history.h5";
    if (std::filesystem::exists(old)) say(old + " is of an older run; --format hdf5 replaces it");
  }

  void write_reports(const RunResult& result) {
    const std::string page = report_page({block_text(report_data(request_, result, *shown_))});
    const auto commit = [&](ReportFile& file) {
      file.commit(page);
      report_paths_.push_back(file.path());
    };
    if (request_.out) {
      ReportFile beside(*request_.out + "/report.html");
      commit(beside);
    }
    if (report_) commit(*report_);
  }

  const RunRequest& request_;
  std::optional<HistoryFile> history_;
  std::optional<ReplacedFile> summary_;
  std::optional<ReportFile> report_;
  std::optional<Recorder> recorder_;
  std::optional<ReportHistory> shown_;
  std::vector<std::string> report_paths_;
};

}  // namespace

int run_command(const CommandLine& line) {
  if (means_many(line)) return run_many(line);
  const RunRequest request = request_run(line);
  watch_signals();
  RunFiles files(request);
  const RunPlan plan = plan_run(request);
  const RunResult result = compute_run(request, plan, files.observers(plan), [&] { return files.fault(); });
  if (!result.ok()) say(warning_of(result));
  const bool written = files.close(result);
  if (line.json) {
    print(run_as_json(request, result));
  } else {
    const bool complete = result.ok() || result.status == "energy_error";
    print(run_as_text(request, result) + (written && complete ? files.text() : ""));
  }
  const int code = exit_code(result);
  return code == kSuccess && !written ? kNotWritten : code;
}

}  // namespace drev::app
