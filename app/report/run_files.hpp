#pragma once
/// The files of one run: history, events, summary and reports. They get their own names only if the run came to its
/// end.
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
  /// Opens what the request asks for. Throws OutputError.
  explicit RunFiles(const RunRequest& request);

  /// What writes the history of the run, and keeps of it what the report shows.
  std::vector<Observer*> observers(const RunPlan& plan);
  /// What keeps the history or the events from being written; empty: nothing.
  std::string fault() const {
    if (history_ && !history_->error().empty()) return history_->error();
    return events_ ? events_->error() : "";
  }

  /// Returns false if something could not be written. notes() has the reason, and what else is to be known.
  bool close(const RunResult& result);
  const std::vector<std::string>& notes() const { return notes_; }
  /// What was written where, for the table.
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

/// What else watches a run, made of the system that is run: a reduction has fewer unknowns.
using Watchers = std::function<std::vector<Observer*>(const System& system)>;

/// Runs what was asked for and writes its files. Throws OutputError where these cannot be opened.
RunOutcome run_and_write(const RunRequest& request, const Watchers& watchers = {});

}  // namespace drev::app
