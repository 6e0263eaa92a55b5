#include "app/results/many_runs.hpp"

#include <algorithm>

#include "app/base/csv_cell.hpp"
#include "app/base/text_layout.hpp"
#include "app/results/run_json.hpp"

namespace drev::app {

namespace {

/// Names of the figures in runs.csv, as in the results of a summary.
constexpr const char* kFigures[] = {"deflection_deg",        "deflection_m",     "max_torque_Nm",
                                    "max_force_N",           "static_torque_Nm", "static_force_N",
                                    "dynamic_amplification", "max_mesh_force_N", "front_contacts",
                                    "back_contacts",         "time_separated_s"};

Json figure(const OneOfMany& run, const char* key) {
  return run.summary.is_object() ? run.summary.at("results").at(key) : Json();
}

/// The figure of the first key that has a number, with its unit; empty: there is none.
std::string shown(const OneOfMany& run, const std::vector<std::pair<const char*, const char*>>& keys) {
  for (const auto& [key, unit] : keys)
    if (const Json value = figure(run, key); value.is_number()) return digits(value, 5) + " " + unit;
  return {};
}

}  // namespace

std::size_t ManyRuns::count(bool ok) const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [&](const OneOfMany& r) { return r.ended() && r.ok() == ok; }));
}

std::string many_as_json(const ManyRuns& many) {
  Json object = result_object("runs");
  object["status"] = many.status;
  object["folder"] = many.folder;
  object["runs"] = Json::array();
  for (const OneOfMany& run : many.runs)
    object["runs"].push_back({{"name", run.model.name},
                              {"model", run.model.model},
                              {"varied", values_object(run.varied)},
                              {"folder", run.folder},
                              {"status", run.status},
                              {"reason", text_or_null(run.reason)},
                              {"exit_code", run.ended() && run.code >= 0 ? Json(run.code) : Json()},
                              {"wall_time_s", run.ended() ? number(run.wall_time) : Json()},
                              {"summary", run.summary}});
  object["skipped"] = Json::array();
  for (const SkippedFile& file : many.skipped)
    object["skipped"].push_back({{"file", file.file}, {"reason", file.reason}});
  return json_text(object);
}

std::string many_as_csv(const ManyRuns& many) {
  std::string text = "name,status";
  for (const auto& [name, value] : many.runs.front().varied) text += "," + csv_cell(name);
  for (const char* key : kFigures) text += std::string(",") + key;
  text += "\n";
  for (const OneOfMany& run : many.runs) {
    text += csv_cell(run.model.name) + "," + run.status;
    for (const auto& [name, value] : run.varied) text += "," + csv_cell(value);
    for (const char* key : kFigures) {
      const Json value = figure(run, key);
      text += "," + (value.is_null() ? "" : value.dump());
    }
    text += "\n";
  }
  return text;
}

std::string many_as_text(const ManyRuns& many) {
  std::vector<std::vector<std::string>> columns{
      {"run"}, {"status"}, {"deflection"}, {"torque or force"}, {"mesh force"}, {"results in"}};
  for (const OneOfMany& run : many.runs) {
    columns[0].push_back(run.model.name);
    columns[1].push_back(run.status);
    columns[2].push_back(shown(run, {{"deflection_deg", "deg"}, {"deflection_m", "m"}}));
    columns[3].push_back(shown(run, {{"max_torque_Nm", "N m"}, {"max_force_N", "N"}}));
    columns[4].push_back(shown(run, {{"max_mesh_force_N", "N"}}));
    columns[5].push_back(run.summary.is_object() || run.status == "killed" ? run.folder : "");
  }
  // Columns that are empty for all runs are left out.
  std::erase_if(columns, [](const std::vector<std::string>& column) {
    return std::all_of(column.begin() + 1, column.end(),
                       [](const std::string& cell) { return cell.empty(); });
  });
  std::string text;
  for (std::size_t row = 0; row <= many.runs.size(); ++row) {
    std::string line;
    for (const std::vector<std::string>& column : columns) {
      std::size_t width = 0;
      for (const std::string& cell : column) width = std::max(width, cell.size());
      const bool words = column[0] == "run" || column[0] == "status" || column[0] == "results in";
      line += (words ? pad_right(column[row], width) : pad_left(column[row], width)) + "  ";
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  for (const OneOfMany& run : many.runs)
    if (!run.reason.empty()) text += "\n" + wrap(run.model.name + ": " + run.status + ": " + run.reason, 2);
  if (!many.skipped.empty()) text += "\n";
  for (const SkippedFile& file : many.skipped) text += wrap("not run: " + file.file + ": " + file.reason, 2);
  const std::string part = many.status == "interrupted" ? ".partial" : "";
  return text + "\n" + std::to_string(many.count(true)) + " of " + std::to_string(many.runs.size()) +
         " succeeded; figures of all in " + many.folder + "/runs" + part + ".csv and runs" + part + ".json\n";
}

}  // namespace drev::app
