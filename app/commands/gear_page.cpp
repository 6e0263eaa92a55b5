#include "app/commands/gear_page.hpp"

#include <drev/core/version.hpp>

#include "app/chart/svg_chart.hpp"
#include "models/gears/meshed_teeth.hpp"

namespace drev::app {

namespace {

constexpr const char* kGearPageStyle =
    "body{font:16px/1.45 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color-scheme:light dark}"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .8em;border-bottom:1px solid "
    "#8886;text-align:left}"
    "svg{max-width:100%;height:auto}svg,tr{break-inside:avoid}h2,h3{break-after:avoid}"
    "h2:not(:first-of-type){break-before:page}"
    "@page{size:A4;margin:14mm 13mm}@media print{body{margin:0;max-width:none;font-size:13px}}";

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
  std::vector<ChartSeries> shares;
  for (std::size_t k = 0; k < 3; ++k) {
    static constexpr const char* kNames[] = {"pair that enters", "pair before it", "pair before that"};
    ChartSeries one{.name = kNames[k]};
    double most = 0.0;
    for (const MeshPoint& p : cycle.points())
      one.x.push_back(p.phase), one.y.push_back(p.shares[k]), most = std::max(most, p.shares[k]);
    if (most > 0.0) shares.push_back(std::move(one));
  }
  std::string text =
      svg_chart({.title = "Tooth pair in mesh", .x_label = "x [mm]", .y_label = "y [mm]", .to_scale = true},
                teeth) +
      svg_chart({.title = "Mesh stiffness",
                 .x_label = "mesh phase [periods]",
                 .y_label = "k [N/(mm um)]",
                 .height = 320},
                {over_phase("secant", cycle, &MeshPoint::secant, 1e9),
                 over_phase("tangent", cycle, &MeshPoint::tangent, 1e9)}) +
      svg_chart({.title = "Transmission error",
                 .x_label = "mesh phase [periods]",
                 .y_label = "error [um]",
                 .height = 320},
                {over_phase("loaded", cycle, &MeshPoint::loaded_error, 1e-6),
                 over_phase("unloaded", cycle, &MeshPoint::unloaded_error, 1e-6)});
  if (!shares.empty())
    text += svg_chart({.title = "Load shared",
                       .x_label = "mesh phase [periods]",
                       .y_label = "part of the load",
                       .height = 320},
                      shares);
  return text;
}

}  // namespace

std::string gear_page(const std::string& file, const std::vector<GearCase>& cases) {
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Gears of " +
                     escaped(file) + "</title><style>" + kGearPageStyle +
                     "</style></head><body>\n<h1>Gears of " + escaped(file) + "</h1>\n";
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
