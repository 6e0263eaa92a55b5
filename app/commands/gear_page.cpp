#include "app/commands/gear_page.hpp"

#include <drev/core/version.hpp>
#include <drev/models/gears/meshed_teeth.hpp>

#include "app/chart/svg_chart.hpp"

namespace drev::app {

namespace {

constexpr const char* kStyle =
    "body{font:16px/1.45 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color-scheme:light dark}"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .8em;border-bottom:1px solid "
    "#8886;text-align:left}"
    "svg{max-width:100%;height:auto}";

std::string escaped(const std::string& text) {
  std::string all;
  for (const char c : text) {
    if (c == '&')
      all += "&amp;";
    else if (c == '<')
      all += "&lt;";
    else if (c == '>')
      all += "&gt;";
    else
      all += c;
  }
  return all;
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::string text = "<table>\n";
  for (const auto& row : rows) {
    text += "<tr>";
    for (const std::string& cell : row) text += "<td>" + escaped(cell) + "</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

ChartSeries drawn(const std::string& name, const Outline& line) {
  ChartSeries series{.name = name};
  for (const auto& p : line) series.x.push_back(1e3 * p[0]), series.y.push_back(1e3 * p[1]);
  return series;
}

ChartSeries over_phase(const std::string& name, const MeshCycle& cycle, double MeshPoint::*value,
                       double scale) {
  ChartSeries series{.name = name};
  for (const MeshPoint& p : cycle.points()) series.x.push_back(p.phase), series.y.push_back(p.*value / scale);
  return series;
}

std::string pictures(const GearCase& c) {
  const MeshCycle& cycle = c.data.cycle;
  const std::vector<ChartSeries> teeth{drawn("gear 1", meshed_teeth(c.data.pair, 0, 3)),
                                       drawn("gear 2", meshed_teeth(c.data.pair, 1, 3)),
                                       drawn("path of contact", path_of_contact(c.data.pair))};
  double low_x = 0.0, high_x = 0.0, low_y = 1e300, high_y = -1e300;
  for (const ChartSeries& s : teeth)
    for (std::size_t i = 0; i < s.x.size(); ++i)
      low_x = std::min(low_x, s.x[i]), high_x = std::max(high_x, s.x[i]), low_y = std::min(low_y, s.y[i]),
      high_y = std::max(high_y, s.y[i]);
  const int height =
      std::min(1200, std::max(300, static_cast<int>(100 + 700 * (high_y - low_y) / (high_x - low_x))));
  std::vector<ChartSeries> shares;
  for (std::size_t k = 0; k < 3; ++k) {
    ChartSeries one{.name = k == 0 ? "pair that enters" : std::to_string(k) + " before it"};
    double most = 0.0;
    for (const MeshPoint& p : cycle.points())
      one.x.push_back(p.phase), one.y.push_back(p.shares[k]), most = std::max(most, p.shares[k]);
    if (most > 0.0) shares.push_back(std::move(one));
  }
  std::string text =
      svg_chart({.title = "Tooth pair in mesh", .x_label = "x [mm]", .y_label = "y [mm]", .height = height},
                teeth) +
      svg_chart({.title = "Mesh stiffness", .x_label = "mesh phase [periods]", .y_label = "k [N/(mm um)]"},
                {over_phase("secant", cycle, &MeshPoint::secant, 1e9),
                 over_phase("tangent", cycle, &MeshPoint::tangent, 1e9)}) +
      svg_chart({.title = "Transmission error", .x_label = "mesh phase [periods]", .y_label = "error [um]"},
                {over_phase("loaded", cycle, &MeshPoint::loaded_error, 1e-6),
                 over_phase("unloaded", cycle, &MeshPoint::unloaded_error, 1e-6)});
  if (!shares.empty())
    text += svg_chart(
        {.title = "Load shared", .x_label = "mesh phase [periods]", .y_label = "part of the load"}, shares);
  return text;
}

}  // namespace

std::string gear_page(const std::string& file, const std::vector<GearCase>& cases) {
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Gears of " +
                     escaped(file) + "</title><style>" + kStyle + "</style></head><body>\n<h1>Gears of " +
                     escaped(file) + "</h1>\n";
  for (const GearCase& c : cases) {
    page += "<h2>" + escaped(c.name) + "</h2>\n" + table(gear_dimensions(c));
    std::vector<std::vector<std::string>> rows;
    for (const GearRow& row : gear_rows(c)) rows.push_back({row.name, row.value});
    page += table(rows) + pictures(c) + "<h3>What the figures rest on</h3>\n<ul>\n";
    for (const std::string& sentence : gear_conventions(c)) page += "<li>" + escaped(sentence) + "</li>\n";
    page += "</ul>\n";
  }
  return page + "<p>drev " + DREV_VERSION + "</p>\n</body></html>\n";
}

}  // namespace drev::app
