#include <cstdio>
#include <optional>

#include "app/commands.hpp"
#include "app/exit_codes.hpp"
#include "app/history_hdf5.hpp"
#include "app/interrupt.hpp"
#include "app/run_computation.hpp"
#include "app/run_json.hpp"
#include "app/run_report.hpp"
#include "app/run_text.hpp"
#include "app/text_layout.hpp"
#include "core/channel.hpp"

namespace drev::app {

namespace {

void say(const std::string& text) { std::fprintf(stderr, "drev: %s\n", text.c_str()); }

int exit_code(const RunResult& result) {
  if (result.ok()) return kSuccess;
  if (result.status == "interrupted") return kInterrupted;
  if (result.status == "output_error") return kNotWritten;
  return kNotTrusted;
}

/// The files of one run. They get their own names only if the run came to its end.
class RunFiles {
 public:
  RunFiles(const RunRequest& request) : request_(request) {
    if (!request.out) return;
    create_directory(*request.out);
    history_.emplace(*request.out, request.record, request.every);
    summary_.emplace(*request.out, "summary", "json");
  }

  HistoryFile* history() { return history_ ? &*history_ : nullptr; }

  /// Returns false, and says why, if something could not be written.
  bool close(const RunResult& result) {
    if (!history_) return true;
    const bool complete = result.ok() || result.status == "energy_error";
    history_->close(complete);
    bool written = history_->error().empty();
    if (!written) say(history_->error());
    try {
      const std::string summary = run_as_json(request_, result);
      summary_->write(summary);
      if (complete && written) {
        summary_->commit();
        if (request_.hdf5) {
          std::vector<HistoryColumn> columns;
          for (const Channel& channel : find_channels(request_.model.system, request_.record))
            columns.push_back({channel.name(), channel.unit()});
          write_hdf5(*request_.out, history_->path(), columns, summary);
        }
        OutputFile report(*request_.out, "report", "html");
        report.write(run_report(request_, result, history_->path()));
        report.commit();
        report_path_ = report.path();
      } else {
        summary_->flush();
      }
    } catch (const OutputError& error) {
      say(error.what());
      written = false;
    }
    if (!complete)
      say("what there is of the run is in " + history_->partial_path() + " and " +
          summary_->partial_path() + "; " + history_->path() +
          ", summary.json and report.html, if they are there, are of an older run");
    return written;
  }

  /// What was written where, for the table.
  std::string text() const {
    if (!history_) return {};
    return pad_right("History", 24) + wrap(std::to_string(history_->rows()) + " rows, every " +
                                               short_digits(request_.every, 12) + " s, of " +
                                               join(request_.record) + " in " + history_->path(),
                                           24) +
           pad_right("Report", 24) + report_path_ + "\n";
  }

 private:
  const RunRequest& request_;
  std::optional<HistoryFile> history_;
  std::optional<OutputFile> summary_;
  std::string report_path_;
};

}  // namespace

int run_command(const CommandLine& line) {
  const RunRequest request = request_run(line);
  watch_signals();
  RunFiles files(request);
  const RunResult result = compute_run(request, files.history());
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
