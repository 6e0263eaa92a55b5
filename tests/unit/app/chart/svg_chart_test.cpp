// The chart writer: well-formed XML, what is drawn, peaks kept, ticks, bad input.
#include "app/chart/svg_chart.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "tests/catch.hpp"

using namespace drev;
using namespace drev::app;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// Empty if every tag is closed in its order and every attribute quoted; else what is wrong.
std::string fault_in(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return "unclosed <";
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (tag.find('<') != std::string::npos) return "< inside a tag: " + tag;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return "odd quotes: " + tag;
    const std::string name = tag.substr(0, tag.find_first_of(" /"));
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return "closes nothing: " + tag;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
  }
  for (std::size_t at = xml.find('&'); at != std::string::npos; at = xml.find('&', at + 1))
    if (xml.find(';', at) == std::string::npos || xml.find(';', at) - at > 5) return "bare &";
  return open.empty() ? "" : "never closed: " + open.back();
}

/// The points of the n-th polyline, as (x, y) in px.
std::vector<std::pair<double, double>> points_of(const std::string& svg, std::size_t n) {
  std::size_t at = 0;
  for (std::size_t i = 0; i <= n; ++i) at = svg.find("<polyline", at + 1);
  at = svg.find(" points=\"", at) + 9;
  std::istringstream in(svg.substr(at, svg.find('"', at) - at));
  std::vector<std::pair<double, double>> points;
  double x = 0.0, y = 0.0;
  char comma = 0;
  while (in >> x >> comma >> y) points.emplace_back(x, y);
  return points;
}

const double kNaN = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("SVG chart: well-formed, one line a series, all points of a short one") {
  const std::string svg =
      svg_chart({.title = "Mesh & shaft <N>",
                 .x_label = "time [s]",
                 .y_label = "force \"y\" [N]",
                 .vertical_lines = {{1.0, "it's released"}, {1.5}}},
                {{.name = "a < b", .x = {0, 1, 2}, .y = {1, -3, 2}},
                 {.name = "points", .x = {0, 2}, .y = {0, 1}, .line = false, .markers = true},
                 {.name = "both", .x = {0, 1, 2, 3}, .y = {0, 1, 0, 1}, .markers = true}});
  CHECK(fault_in(svg) == "");
  CHECK(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  CHECK(count(svg, "<polyline") == 2);
  CHECK(points_of(svg, 0).size() == 3);
  CHECK(points_of(svg, 1).size() == 4);
  CHECK(count(svg, "<polygon") == 2 + 1 + 4 + 1);  // each series' points and its place in the legend
  CHECK(count(svg, "class=\"v\"") == 2);
  CHECK(count(svg, "a &lt; b") == 1);
  CHECK(count(svg, "Mesh &amp; shaft &lt;N&gt;") == 2);
  CHECK(count(svg, "it&apos;s released") == 1);
  CHECK(count(svg, "&quot;y&quot;") == 1);
  CHECK(count(svg, "prefers-color-scheme:dark") == 1);
}

TEST_CASE("SVG chart: values are placed linearly, up is larger") {
  const std::string svg = svg_chart({}, {{.name = "", .x = {0, 1, 4}, .y = {0, 10, 5}}});
  const auto p = points_of(svg, 0);
  CHECK((p[1].first - p[0].first) / (p[2].first - p[0].first) == Approx(0.25).margin(1e-4));
  CHECK((p[2].second - p[0].second) / (p[1].second - p[0].second) == Approx(0.5).margin(1e-4));
  CHECK(p[1].second < p[0].second);
}

TEST_CASE("SVG chart: to scale, a unit is as long along y as along x") {
  for (const double height : {0.1, 0.3, 2.0}) {
    const std::string svg = svg_chart({.y_label = "y [mm]", .to_scale = true},
                                      {{.name = "box", .x = {0, 1, 1}, .y = {200, 200, 200 + height}}});
    CHECK(fault_in(svg).empty());
    const std::size_t at = svg.find("points=\"") + 8;
    std::string text = svg.substr(at, svg.find('"', at) - at);
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream numbers(text);
    double x0, y0, x1, y1, x2, y2;
    REQUIRE(numbers >> x0 >> y0 >> x1 >> y1 >> x2 >> y2);
    CHECK(std::abs((y1 - y2) / height / (x1 - x0) - 1.0) < 0.01);
  }
  CHECK_THROWS_AS(svg_chart({.log_y = true, .to_scale = true}, {{.name = "a", .x = {1, 2}, .y = {1, 2}}}),
                  ModelError);
}

TEST_CASE("SVG chart: a long line is thinned to the pixels and keeps its peaks") {
  constexpr std::size_t kPoints = 500000;
  std::vector<double> t(kPoints), y(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i)
    t[i] = static_cast<double>(i) * 1e-5, y[i] = std::sin(500.0 * t[i]);
  y[123457] = 7.0;  // one sample each
  y[301234] = -5.0;
  const std::string svg = svg_chart({}, {{.name = "signal", .x = t, .y = y}});
  CHECK(svg.size() < 60000);
  const auto p = points_of(svg, 0);
  CHECK(p.size() <= 4 * 800);
  const auto [low, high] = std::minmax_element(
      p.begin(), p.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  // The top of the chart is the high peak, at its time: pixel scale from first and last point.
  const auto time = [&](double px) {
    return (px - p.front().first) / (p.back().first - p.front().first) * t.back();
  };
  CHECK(time(low->first) == Approx(1.23457).margin(1e-4));
  CHECK(time(high->first) == Approx(3.01234).margin(1e-4));
  // 12 units apart, 8 % of air: the same share of the plot in px.
  const std::string two = svg_chart({}, {{.name = "signal", .x = {0, 1}, .y = {-5, 7}}});
  CHECK(high->second - low->second ==
        Approx(points_of(two, 0)[0].second - points_of(two, 0)[1].second).margin(0.05));
}

TEST_CASE("SVG chart: logarithmic ticks are powers of ten, with lines between them") {
  const std::string svg = svg_chart({.log_x = true, .log_y = true},
                                    {{.name = "order 2", .x = {1e2, 1e3, 1e4}, .y = {1e-2, 1e-4, 1e-6}}});
  CHECK(fault_in(svg) == "");
  for (const std::string exponent :
       {">2</tspan>", ">3</tspan>", ">4</tspan>", ">-2</tspan>", ">-4</tspan>", ">-6</tspan>"})
    CHECK(count(svg, exponent) == 1);
  CHECK(count(svg, "class=\"n\"") >= 16);  // 2 to 9 of each decade of x
  const auto p = points_of(svg, 0);
  CHECK((p[1].first - p[0].first) / (p[2].first - p[0].first) == Approx(0.5).margin(1e-4));
  CHECK((p[1].second - p[0].second) / (p[2].second - p[0].second) == Approx(0.5).margin(1e-4));
}

TEST_CASE("SVG chart: linear ticks are round numbers, large and small ones are scaled") {
  const std::string svg = svg_chart({}, {{.name = "", .x = {0, 5}, .y = {-0.3, 0.7}}});
  for (const std::string tick : {">0.0<", ">0.2<", ">-0.2<", ">0.6<", ">5<"}) CHECK(count(svg, tick) >= 1);
  CHECK(count(svg, ">-0.0<") == 0);
  const std::string large = svg_chart({.y_label = "force [N]"}, {{.name = "", .x = {0, 1}, .y = {0, 4.2e6}}});
  CHECK(count(large, "force [N] (×10⁶)") == 1);
  CHECK(count(large, ">4.0<") == 1);
  const std::string small = svg_chart({.y_label = "error [m]"}, {{.name = "", .x = {0, 1}, .y = {0, 2e-6}}});
  CHECK(count(small, "error [m] (×10⁻⁶)") == 1);
}

TEST_CASE("SVG chart: a single point, a constant and extreme ranges are drawn") {
  for (const auto& [x, y] : {std::pair<std::vector<double>, std::vector<double>>{{1}, {2}},
                             {{0, 1}, {0, 0}},
                             {{0, 1}, {1e12, 1e12 + 1e-3}},
                             {{-1e300, 1e300}, {1e-300, 2e-300}}}) {
    const std::string svg = svg_chart({}, {{.name = "s", .x = x, .y = y, .markers = true}});
    CHECK(fault_in(svg) == "");
    CHECK(count(svg, "nan") == 0);
    CHECK(count(svg, "inf") == 0);
  }
  const std::string wide =
      svg_chart({.log_x = true, .log_y = true}, {{.name = "s", .x = {1e-300, 1e300}, .y = {3, 3}}});
  CHECK(fault_in(wide) == "");
  CHECK(wide.size() < 20000);
}

TEST_CASE("SVG chart: bad input is refused, with every finding") {
  const auto refused = [](const ChartOptions& o, const std::vector<ChartSeries>& s) {
    try {
      svg_chart(o, s);
    } catch (const ModelError& error) {
      return error.findings().size();
    }
    return std::size_t{0};
  };
  const ChartSeries good{.name = "good", .x = {1, 2}, .y = {1, 2}};
  CHECK(refused({}, {}) == 1);
  CHECK(refused({}, {{.name = "empty"}}) == 1);
  CHECK(refused({}, {{.name = "s", .x = {1, 2}, .y = {1}}}) == 1);
  CHECK(refused({}, {{.name = "s", .x = {1, 2}, .y = {1, kNaN}}, {.name = "t", .x = {kInf}, .y = {1}}}) == 2);
  CHECK(refused({.log_y = true}, {{.name = "s", .x = {1, 2}, .y = {1, 0}}}) == 1);
  CHECK(refused({.log_x = true}, {{.name = "s", .x = {-1, 2}, .y = {1, 0}}}) == 1);
  CHECK(refused({.vertical_lines = {{kNaN}}}, {good}) == 1);
  CHECK(refused({.width = 10, .height = 20000}, {good}) == 2);
  CHECK(refused({}, {{.name = "s", .x = {-1.7e308, 1.7e308}, .y = {1, 2}}}) == 1);
  CHECK(refused({}, {good}) == 0);
}

TEST_CASE("Chart: from the eighth series on the markers are open, rings surround points") {
  std::vector<ChartSeries> series;
  for (int i = 0; i < 8; ++i)
    series.push_back(
        {.name = "s" + std::to_string(i), .x = {0.0, 1.0}, .y = {0.0, 1.0 + i}, .markers = true});
  series.push_back({.name = "ring", .x = {0.5}, .y = {2.0}, .line = false, .rings = true});
  const std::string svg = svg_chart({}, series);
  const auto count = [&](const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1)) ++n;
    return n;
  };
  CHECK(count("class=\"m c0\"") == 3);    // two points and the legend
  CHECK(count("class=\"m c0 o\"") == 3);  // of the eighth
  CHECK(count("class=\"r\"") == 2);
}
