#pragma once
/// The files of one run: history, events, summary and reports. They get their own names only if the run
/// reached its end.
#include <drev/app/report/run_outcome.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/report/report_file.hpp"
#include "app/report/report_history.hpp"
#include "app/results/event_file.hpp"
#include "app/results/history_file.hpp"
#include "app/run/run_computation.hpp"

namespace drev::app {

class RunFiles {
 public:
  /// Opens the files that the request asks for. Throws OutputError.
  explicit RunFiles(const RunRequest& request);

  /// The observers that write the history of the run and keep the data of the report.
  std::vector<Observer*> observers(const RunPlan& plan);
  /// Why the history or the events cannot be written; empty: there is no fault.
  std::string fault() const {
    if (history_ && !history_->error().empty()) return history_->error();
    return events_ ? events_->error() : "";
  }

  /// Returns false if a file could not be written. notes() has the reason and other remarks.
  bool close(const RunResult& result);
  const std::vector<std::string>& notes() const { return notes_; }
  /// The files that were written, as text for the table.
  std::string text() const;

 private:
  void write_summary(const RunResult& result, bool commit);
  void note_old_hdf5();
  void write_reports(const RunResult& result);

  const RunRequest& request_;
  std::optional<HistoryFile> history_;
  std::optional<EventFile> events_;
  std::optional<ReplacedFile> summary_;
  std::optional<ReportFile> report_;
  std::optional<Recorder> recorder_;
  std::optional<ContactEvents> passed_;
  std::optional<ReportHistory> shown_;
  std::vector<std::string> report_paths_, notes_;
};

/// Makes further observers of a run from the system that is run, since a reduced system has fewer unknowns.
using Watchers = std::function<std::vector<Observer*>(const System& system)>;

/// Executes the requested run and writes its files. Throws OutputError if these cannot be opened.
RunOutcome run_and_write(RunRequest request, const Watchers& watchers = {});

}  // namespace drev::app
