#include "app/run_report.hpp"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "app/output_file.hpp"
#include "app/run_text.hpp"
#include "app/svg_chart.hpp"
#include "app/text_layout.hpp"
#include "models/settings.hpp"

namespace drev::app {

namespace {

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

Table read_history(const std::string& path) {
  std::ifstream in(path);
  Table table;
  std::string line, cell;
  if (!std::getline(in, line)) throw OutputError(path + ": cannot be read back for the report");
  std::istringstream header(line);
  while (std::getline(header, cell, ',')) table.names.push_back(cell);
  table.columns.resize(table.names.size());
  while (std::getline(in, line)) {
    std::istringstream row(line);
    for (auto& column : table.columns) {
      double value = 0.0;
      if (!std::getline(row, cell, ',') || !read_number(cell, value))
        throw OutputError(path + ": row " + std::to_string(table.columns.back().size() + 2) +
                          " cannot be read back for the report");
      column.push_back(value);
    }
  }
  return table;
}

/// "angle_rad" -> "angle [rad]", "speed_rad_per_s" -> "speed [rad/s]".
std::string axis_title(const std::string& quantity) {
  static const std::map<std::string, std::string> titles{
      {"angle_rad", "deviation of the angle [rad]"},
      {"speed_rad_per_s", "deviation of the speed [rad/s]"},
      {"acceleration_rad_per_s2", "acceleration [rad/s²]"},
      {"position_m", "position [m]"},
      {"velocity_m_per_s", "velocity [m/s]"},
      {"acceleration_m_per_s2", "acceleration [m/s²]"},
      {"twist_rad", "twist [rad]"},
      {"distance_m", "distance [m]"},
      {"reaction_Nm", "reaction [N m]"},
      {"reaction_N", "reaction [N]"},
      {"torque_Nm", "torque [N m]"},
      {"force_N", "force [N]"},
      {"deflection_m", "deflection [m]"},
      {"deflection_rad", "deflection [rad]"}};
  const auto found = titles.find(quantity);
  return found == titles.end() ? quantity : found->second;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

/// Channels of one quantity share a chart, in the order in which they were asked for.
std::string charts(const Table& table) {
  std::vector<std::string> quantities;
  std::map<std::string, std::vector<ChartSeries>> groups;
  for (std::size_t c = 1; c < table.names.size(); ++c) {
    const std::size_t dot = table.names[c].rfind('.');
    const std::string quantity = table.names[c].substr(dot + 1);
    if (!groups.contains(quantity)) quantities.push_back(quantity);
    groups[quantity].push_back({.name = table.names[c].substr(0, dot),
                                .x = table.columns[0],
                                .y = table.columns[c]});
  }
  std::string html;
  for (const std::string& quantity : quantities)
    html += "<figure>" +
            svg_chart({.x_label = "time [s]", .y_label = axis_title(quantity), .width = 1000,
                       .height = 360},
                      groups[quantity]) +
            "</figure>\n";
  return html;
}

}  // namespace

std::string run_report(const RunRequest& request, const RunResult& result,
                       const std::string& history) {
  const Table table = read_history(history);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>drev: " +
      escaped(request.model.entry->name) +
      "</title>\n<style>\n:root { color-scheme: light dark; }\n"
      "body { font-family: sans-serif; max-width: 64rem; margin: 2rem auto; padding: 0 1rem; }\n"
      "pre { white-space: pre-wrap; line-height: 1.35; }\n"
      ".warning { border: 2px solid #d55e00; padding: 0.5rem 1rem; }\n"
      "figure { margin: 1.5rem 0; } svg { width: 100%; height: auto; }\n"
      "</style></head><body>\n<h1>" +
      escaped(request.model.entry->name) + "</h1>\n";
  if (const std::string warning = warning_of(result); !warning.empty())
    html += "<p class=\"warning\">" + escaped(warning) + "</p>\n";
  html += "<pre>" + escaped(run_as_text(request, result)) + "</pre>\n";
  if (!table.columns[0].empty())
    html += "<p>Drawn from the samples of history.csv, one every " +
            short_digits(request.every, 12) +
            " s. What happens between two samples is not in the curves; the table holds the largest values "
            "of the whole run.</p>\n" +
            charts(table);
  return html + "</body></html>\n";
}

}  // namespace drev::app
