#include "app/report/run_files.hpp"

#include <drev/core/channel.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <filesystem>

#include "app/base/output_file.hpp"
#include "app/base/text_layout.hpp"
#include "app/report/report_data.hpp"
#include "app/report/report_page.hpp"
#include "app/results/history_hdf5.hpp"
#include "app/results/run_json.hpp"
#include "app/results/run_text.hpp"

namespace drev::app {

namespace {

/// Channels of the report: those requested, and the forces of the contacts.
std::vector<std::string> report_channels(const RunRequest& request) {
  constexpr std::size_t kMeshes = 6;
  std::vector<std::string> names = request.record;
  std::size_t meshes = 0;
  for (const Channel& channel : mesh_channels(request.model.system))
    if (meshes++ < kMeshes && std::find(names.begin(), names.end(), channel.name()) == names.end())
      names.push_back(channel.name());
  return names;
}

/// The waterfall as CSV, with one row for each window and order.
std::string waterfall_as_csv(const OrderTracks& tracks) {
  std::string text = "time_s,speed_rpm,order";
  for (const std::string& channel : tracks.channels) text += "," + channel;
  text += "\n";
  for (std::size_t w = 0; w < tracks.time.size(); ++w)
    for (std::size_t k = 0; k < tracks.orders.size(); ++k) {
      text +=
          to_text(tracks.time[w]) + "," + to_text(to_rpm(tracks.speed[w])) + "," + to_text(tracks.orders[k]);
      for (const auto& channel : tracks.amplitude) text += "," + to_text(channel[k][w]);
      text += "\n";
    }
  return text;
}

}  // namespace

RunFiles::RunFiles(const RunRequest& request) : request_(request) {
  if (request.out) {
    create_directory(*request.out);
    history_.emplace(*request.out, request.record, request.every);
    summary_.emplace(*request.out, "summary", "json");
    summary_->replace(running_as_json(request));
  }
  if (request.events) events_.emplace(*request.events);
  if (request.report) report_.emplace(*request.report);
}

std::vector<Observer*> RunFiles::observers(const RunPlan& plan) {
  if (summary_) summary_->replace(running_as_json(request_));  // the method is settled
  const System& system = system_of(request_, plan);
  std::vector<Observer*> all;
  if (history_) {
    recorder_.emplace(system, request_.record, request_.every);
    recorder_->set_sink([this](double /*t*/, const std::vector<double>& row) { history_->add(row); });
    all.push_back(&*recorder_);
  }
  if (events_) {
    events_->follow(system);
    passed_.emplace(system, [this](const ContactEvent& event) { events_->add(event); });
    all.push_back(&*passed_);
  }
  if (history_ || report_) {
    shown_.emplace(system, report_channels(request_), report_interval(request_, plan.method));
    all.push_back(&*shown_);
  }
  return all;
}

bool RunFiles::close(const RunResult& result) {
  const bool complete = result.ok() || result.status == "energy_error";
  bool written = true;
  const auto note = [&](const std::string& error) {
    if (error.empty()) return;
    notes_.push_back(error);
    written = false;
  };
  if (events_) {
    events_->close(complete);
    note(events_->error());
    if (!complete) notes_.push_back("what there is of the contact events is in " + events_->partial_path());
  }
  if (!shown_) return written;
  if (history_) {
    history_->close(complete);
    note(history_->error());
  }
  try {
    if (summary_) write_summary(result, complete && written);
    if (complete && written) write_reports(result);
  } catch (const OutputError& error) {
    note(error.what());
  }
  if (!complete && history_)
    notes_.push_back("what there is of the run is in " + history_->partial_path() + " and " +
                     summary_->partial_path() + "; " + history_->path() +
                     ", summary.json and report.html, if they are there, are of an older run");
  return written;
}

std::string RunFiles::text() const {
  std::string text;
  if (history_)
    text += pad_right("History", 24) +
            wrap(std::to_string(history_->rows()) + " rows, every " + short_digits(request_.every, 12) +
                     " s, of " +
                     (request_.record.empty() ? "no channel: none is recorded" : join(request_.record)) +
                     ", in " + history_->path(),
                 24);
  if (events_)
    text +=
        pad_right("Contact events", 24) + std::to_string(events_->rows()) + " in " + events_->path() + "\n";
  if (shown_) text += pad_right("Report", 24) + join(report_paths_) + "\n";
  return text;
}

void RunFiles::write_summary(const RunResult& result, bool commit) {
  const std::string summary = run_as_json(request_, result);
  summary_->replace(summary);
  if (!commit) return;
  summary_->commit();
  if (result.run_up)
    write_file(*request_.out, "waterfall", "csv", waterfall_as_csv(result.run_up->waterfall));
  if (!request_.hdf5) return note_old_hdf5();
  std::vector<HistoryColumn> columns;
  for (const Channel& channel : find_channels(request_.model.system, request_.record, OverRun::taken))
    columns.push_back({channel.name(), channel.unit()});
  write_hdf5(*request_.out, history_->path(), columns, summary);
}

void RunFiles::note_old_hdf5() {
  const std::string old = *request_.out + "/history.h5";
  if (std::filesystem::exists(old)) notes_.push_back(old + " is of an older run; --format hdf5 replaces it");
}

void RunFiles::write_reports(const RunResult& result) {
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

RunOutcome run_and_write(RunRequest request, const Watchers& watchers) {
  RunFiles files(request);
  settle_method(request);
  const RunPlan plan = plan_run(request);
  std::vector<Observer*> observers = files.observers(plan);
  if (watchers)
    for (Observer* observer : watchers(system_of(request, plan))) observers.push_back(observer);
  const RunResult result = compute_run(request, plan, observers, [&] { return files.fault(); });
  RunOutcome outcome{.status = result.status};
  if (!result.ok()) outcome.warning = warning_of(result);
  outcome.written = files.close(result);
  outcome.notes = files.notes();
  outcome.json = run_as_json(request, result);
  const bool complete = result.ok() || result.status == "energy_error";
  outcome.text = run_as_text(request, result) + (outcome.written && complete ? files.text() : "");
  return outcome;
}

}  // namespace drev::app
