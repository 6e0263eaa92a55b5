#include "app/chart/svg_chart.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace drev::app {

namespace {

constexpr int kStyles = 7;
constexpr double kCharacter = 6.6, kLegendRow = 18.0;  // px, of 12 px text
constexpr const char* kDashes[kStyles] = {"", "9 4", "3 3", "12 3 3 3", "6 2", "1.5 3", "14 3 3 3 3 3"};

/// Fixed or shortest decimal text, whatever the locale.
std::string with_decimals(double value, int decimals) {
  char buffer[400];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value == 0.0 ? 0.0 : value,
                                 std::chars_format::fixed, decimals);
  std::string text(buffer, end.ptr);
  if (text.find_first_not_of("-0.") == std::string::npos && text.front() == '-') text.erase(0, 1);
  return text;
}

std::string px(double value) { return with_decimals(value, 2); }

/// XML text: markup escaped, control characters (which XML cannot hold) as spaces.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&apos;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  return out;
}

double text_width(std::string_view text) {
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // not inside a UTF-8 sequence
  });
  return kCharacter * static_cast<double>(characters);
}

/// A whole number in raised digits (UTF-8).
std::string superscript(int value) {
  constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out;
  for (const char c : std::to_string(value)) out += c == '-' ? "⁻" : digits[c - '0'];
  return out;
}

struct Tick {
  double at = 0.0;  // on the axis: log10 of the value on a logarithmic one
  std::string label = {};
  std::string exponent = {};  // written above the label's line
};

/// One axis: data range, ticks, and the map from data to pixels.
struct Axis {
  bool log = false;
  double low = 0.0, high = 1.0;   // log10 where log
  double begin = 0.0, end = 1.0;  // px of low and high
  std::vector<Tick> ticks = {};
  std::string label = {};

  double scale(double value) const { return log ? std::log10(value) : value; }
  double pixel(double value) const { return begin + (scale(value) - low) / (high - low) * (end - begin); }
  double at(const Tick& tick) const { return begin + (tick.at - low) / (high - low) * (end - begin); }
};

/// 1, 2 or 5 times a power of ten: at most `most` steps in the range.
double nice_step(double range, double most) {
  const double raw = range / std::max(most, 1.0);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * (1.0 - 1e-9)) return factor * power;
  return 10.0 * power;
}

void add_linear_ticks(Axis& axis, double most) {
  const double step = nice_step(axis.high - axis.low, most);
  const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
  // Large and small numbers are written in thousands, thousandths, ...
  int thousands = 0;
  if (largest >= 1e5 || largest < 1e-2) thousands = static_cast<int>(std::floor(std::log10(largest) / 3.0));
  const double unit = std::pow(1000.0, thousands);
  if (thousands != 0) axis.label += " (×10" + superscript(3 * thousands) + ")";
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step / unit) - 1e-9)), 0, 12);
  const double first = std::ceil(axis.low / step - 1e-9), last = std::floor(axis.high / step + 1e-9);
  for (double i = first; i <= last; i += 1.0)
    axis.ticks.push_back({i * step, with_decimals(i * step / unit, decimals)});
}

void add_log_ticks(Axis& axis, double most) {
  const double decades = axis.high - axis.low;
  // Less than about a decade and a half: 1, 2, 5 between the powers too, written out.
  const bool between = decades < 1.6;
  const double stride = std::max(1.0, std::ceil(decades / std::max(most, 1.0)));
  const double first = std::floor(axis.low);
  for (double n = first; n <= axis.high + 1e-9; n += 1.0) {
    const auto shown = [&](double at) { return at >= axis.low - 1e-9 && at <= axis.high + 1e-9; };
    const int power = static_cast<int>(n);
    if (shown(n)) {
      const bool labelled = std::fmod(std::abs(n), stride) == 0.0;
      if (between && std::abs(power) <= 4)
        axis.ticks.push_back({n, with_decimals(std::pow(10.0, n), std::max(0, -power))});
      else if (labelled || decades < 60.0)
        axis.ticks.push_back({n, labelled ? "10" : "", labelled ? std::to_string(power) : ""});
    }
    if (decades > 6.0) continue;
    for (int factor = 2; factor <= 9; ++factor) {
      const double at = n + std::log10(factor);
      if (!shown(at)) continue;
      const bool labelled = between && std::abs(power) <= 4 && (factor == 2 || factor == 5);
      axis.ticks.push_back(
          {at, labelled ? with_decimals(factor * std::pow(10.0, n), std::max(0, -power)) : ""});
    }
  }
}

/// Range of the data with a little air; ticks come later, when the pixels are known.
Axis make_axis(bool log, std::string label, double low, double high, double air) {
  Axis axis{.log = log, .label = std::move(label)};
  axis.low = axis.scale(low), axis.high = axis.scale(high);
  const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
  if (axis.high - axis.low <= 1e-12 * largest || axis.high == axis.low) {
    const double half = log ? 0.5 : largest > 0.0 ? 0.1 * largest : 1.0;
    axis.low -= half, axis.high += half;
  } else {
    const double margin = air * (axis.high - axis.low);
    axis.low -= margin, axis.high += margin;
  }
  return axis;
}

/// A logarithmic y axis is widened to whole decades where that costs little.
void widen_to_decades(Axis& axis) {
  if (!axis.log || axis.high - axis.low < 1.0) return;
  axis.low = std::floor(axis.low), axis.high = std::ceil(axis.high);
}

void check(const ChartOptions& o, const std::vector<ChartSeries>& series) {
  std::vector<Finding> findings;
  ParameterCheck chart("chart", findings);
  chart.within("width", o.width, 200, 10000, "px");
  chart.within("height", o.height, 150, 10000, "px");
  if (o.to_scale && (o.log_x || o.log_y))
    chart.fail("to_scale", "true", "", "must not be there on a logarithmic axis");
  if (series.empty()) chart.fail("series", "0", "", "must be at least one");
  for (std::size_t i = 0; i < o.vertical_lines.size(); ++i) {
    const std::string item = "vertical_lines[" + std::to_string(i) + "].x";
    chart.finite(item, o.vertical_lines[i].x, "");
    if (o.log_x && o.vertical_lines[i].x <= 0.0)
      chart.fail(item, to_text(o.vertical_lines[i].x), "", "must be > 0 on a logarithmic axis");
  }
  for (std::size_t s = 0; s < series.size(); ++s) {
    const std::string name = series[s].name.empty() ? std::to_string(s) : series[s].name;
    ParameterCheck one("chart/" + name, findings);
    if (series[s].x.empty()) one.fail("x", "0 points", "", "must have at least one");
    if (series[s].x.size() != series[s].y.size())
      one.fail("y", std::to_string(series[s].y.size()) + " points", "",
               "must have as many as x, which has " + std::to_string(series[s].x.size()));
    const auto values = [&](const char* axis, const std::vector<double>& all, bool log) {
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (std::isfinite(all[i]) && (!log || all[i] > 0.0)) continue;
        one.fail(std::string(axis) + "[" + std::to_string(i) + "]", to_text(all[i]), "",
                 log ? "must be finite and > 0 on a logarithmic axis" : "must be finite");
        return;  // the first of them is enough
      }
    };
    values("x", series[s].x, o.log_x);
    values("y", series[s].y, o.log_y);
  }
  if (!findings.empty()) throw ModelError(findings);
}

/// The points of a line that can be told apart: first, lowest, highest and last of each pixel column.
std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>>& all) {
  std::vector<std::pair<double, double>> kept;
  for (std::size_t begin = 0; begin < all.size();) {
    const double column = std::floor(all[begin].first);
    std::size_t end = begin, low = begin, high = begin;
    for (; end < all.size() && std::floor(all[end].first) == column; ++end) {
      if (all[end].second < all[low].second) low = end;
      if (all[end].second > all[high].second) high = end;
    }
    std::size_t chosen[4] = {begin, low, high, end - 1};
    std::sort(chosen, chosen + 4);
    for (int i = 0; i < 4; ++i)
      if (i == 0 || chosen[i] != chosen[i - 1]) kept.push_back(all[chosen[i]]);
    begin = end;
  }
  return kept;
}

/// The symbol of a series at a point, about 7 px wide.
std::string symbol(int series, double x, double y) {
  const int style = series % kStyles;
  const std::string c = " class=\"m c" + std::to_string(style) + (series >= kStyles ? " o" : "") + "\"";
  const auto polygon = [&](std::initializer_list<std::pair<double, double>> corners) {
    std::string points;
    for (const auto& [dx, dy] : corners)
      points += (points.empty() ? "" : " ") + px(x + dx) + "," + px(y + dy);
    return "<polygon" + c + " points=\"" + points + "\"/>";
  };
  switch (style) {
    case 1:
      return polygon({{-3.2, -3.2}, {3.2, -3.2}, {3.2, 3.2}, {-3.2, 3.2}});
    case 2:
      return polygon({{0, -4}, {4, 3.2}, {-4, 3.2}});
    case 3:
      return polygon({{0, -4.4}, {4.4, 0}, {0, 4.4}, {-4.4, 0}});
    case 4:
      return polygon({{0, 4}, {4, -3.2}, {-4, -3.2}});
    case 5:
      return polygon({{-4, 0}, {3.2, -4}, {3.2, 4}});
    case 6:
      return polygon({{4, 0}, {-3.2, -4}, {-3.2, 4}});
    default:
      return "<circle" + c + " cx=\"" + px(x) + "\" cy=\"" + px(y) + "\" r=\"3.5\"/>";
  }
}

std::string line(const char* css, double x1, double y1, double x2, double y2) {
  return std::string("<line class=\"") + css + "\" x1=\"" + px(x1) + "\" y1=\"" + px(y1) + "\" x2=\"" +
         px(x2) + "\" y2=\"" + px(y2) + "\"/>\n";
}

std::string text(double x, double y, const char* anchor, const std::string& content,
                 const std::string& more = {}) {
  return "<text x=\"" + px(x) + "\" y=\"" + px(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
         content + "</text>\n";
}

std::string tick_text(const Tick& tick) {
  if (tick.exponent.empty()) return escaped(tick.label);
  return escaped(tick.label) + "<tspan dy=\"-5\" font-size=\"9\">" + tick.exponent + "</tspan>";
}

/// Colours 0 and 5 change places on a dark page, where the dark blue is hard to see.
constexpr const char* kStyle =
    "<style>\n"
    "text{font:12px system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif;fill:#222}\n"
    ".h{font-size:14px;font-weight:600}.g{stroke:#ddd}.n{stroke:#eee}.z{stroke:#999}.f{stroke:#666}\n"
    ".v{stroke:#666;stroke-dasharray:4 3}.l{fill:none;stroke-width:1.6;stroke-linejoin:round}\n"
    ".bg{fill:#fff}.m{stroke-width:1}\n"
    ".c0{stroke:#0072B2}.c1{stroke:#D55E00}.c2{stroke:#009E73}.c3{stroke:#CC79A7}.c4{stroke:#E69F00}"
    ".c5{stroke:#56B4E9}.c6{stroke:#000}\n"
    ".m.c0{fill:#0072B2}.m.c1{fill:#D55E00}.m.c2{fill:#009E73}.m.c3{fill:#CC79A7}.m.c4{fill:#E69F00}"
    ".m.c5{fill:#56B4E9}.m.c6{fill:#000}\n"
    "@media(prefers-color-scheme:dark){text{fill:#ddd}.bg{fill:#16181c}.g{stroke:#34373d}"
    ".n{stroke:#25282d}.z{stroke:#777}.f,.v{stroke:#999}.c0{stroke:#56B4E9}.c5{stroke:#0072B2}"
    ".c6{stroke:#eee}.m.c0{fill:#56B4E9}.m.c5{fill:#0072B2}.m.c6{fill:#eee}}\n"
    ".m.o{fill:none;stroke-width:1.5}.r{fill:none;stroke:#888;stroke-width:1.5}\n"
    "</style>\n";

/// Grid, frame, tick labels and axis titles.
std::string axes_text(const Axis& x, const Axis& y) {
  std::string out;
  for (const Tick& t : x.ticks) {
    const double at = x.at(t);
    const bool zero = !x.log && t.at == 0.0;
    out += line(zero ? "z" : t.label.empty() ? "n" : "g", at, y.begin, at, y.end);
    if (!t.label.empty()) out += text(at, y.begin + 17, "middle", tick_text(t));
  }
  for (const Tick& t : y.ticks) {
    const double at = y.at(t);
    const bool zero = !y.log && t.at == 0.0;
    out += line(zero ? "z" : t.label.empty() ? "n" : "g", x.begin, at, x.end, at);
    if (!t.label.empty()) out += text(x.begin - 7, at + 4, "end", tick_text(t));
  }
  out += "<rect class=\"f\" fill=\"none\" x=\"" + px(x.begin) + "\" y=\"" + px(y.end) + "\" width=\"" +
         px(x.end - x.begin) + "\" height=\"" + px(y.begin - y.end) + "\"/>\n";
  if (!x.label.empty()) out += text(0.5 * (x.begin + x.end), y.begin + 36, "middle", escaped(x.label));
  if (!y.label.empty()) {
    const std::string at = px(15) + " " + px(0.5 * (y.begin + y.end));
    out += "<text transform=\"translate(" + at + ") rotate(-90)\" text-anchor=\"middle\">" +
           escaped(y.label) + "</text>\n";
  }
  return out;
}

std::string ring(double x, double y) {
  return "<circle class=\"r\" cx=\"" + px(x) + "\" cy=\"" + px(y) + "\" r=\"8\"/>";
}

std::string series_text(const ChartSeries& s, int series, const Axis& x, const Axis& y) {
  const int style = series % kStyles;
  std::vector<std::pair<double, double>> points(s.x.size());
  for (std::size_t i = 0; i < s.x.size(); ++i) points[i] = {x.pixel(s.x[i]), y.pixel(s.y[i])};
  points = thinned(points);
  std::string out;
  const std::string dash = kDashes[style];
  if (s.line) {
    out += "<polyline class=\"l c" + std::to_string(style) + "\"";
    if (!dash.empty()) out += " stroke-dasharray=\"" + dash + "\"";
    out += " points=\"";
    for (std::size_t i = 0; i < points.size(); ++i)
      out += (i == 0 ? "" : " ") + px(points[i].first) + "," + px(points[i].second);
    out += "\"/>\n";
  }
  if (s.markers)
    for (const auto& [at_x, at_y] : points) out += symbol(series, at_x, at_y) + "\n";
  if (s.rings)
    for (const auto& [at_x, at_y] : points) out += ring(at_x, at_y) + "\n";
  return out;
}

/// Rows of names above the plot; returns the height used.
double add_legend(const std::vector<ChartSeries>& series, double left, double right, double top,
                  std::string& out) {
  double x = left, y = top;
  bool any = false;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const ChartSeries& s = series[i];
    if (s.name.empty()) continue;
    const int style = static_cast<int>(i % kStyles);
    const double width = 36.0 + text_width(s.name) + 16.0;
    if (any && x + width > right) x = left, y += kLegendRow;
    if (s.line) {
      out += "<line class=\"l c" + std::to_string(style) + "\" x1=\"" + px(x) + "\" y1=\"" + px(y + 8) +
             "\" x2=\"" + px(x + 30) + "\" y2=\"" + px(y + 8) + "\"";
      if (*kDashes[style] != '\0') out += " stroke-dasharray=\"" + std::string(kDashes[style]) + "\"";
      out += "/>\n";
    }
    if (s.markers) out += symbol(static_cast<int>(i), x + 15, y + 8) + "\n";
    if (s.rings) out += ring(x + 15, y + 8) + "\n";
    out += text(x + 36, y + 12, "start", escaped(s.name));
    x += width;
    any = true;
  }
  return any ? y + kLegendRow - top + 4.0 : 0.0;
}

}  // namespace

std::string svg_chart(const ChartOptions& o, const std::vector<ChartSeries>& series) {
  check(o, series);
  double low[2] = {series[0].x[0], series[0].y[0]}, high[2] = {low[0], low[1]};
  const auto widen = [&](int axis, double value) {
    low[axis] = std::min(low[axis], value), high[axis] = std::max(high[axis], value);
  };
  for (const ChartSeries& s : series)
    for (std::size_t i = 0; i < s.x.size(); ++i) widen(0, s.x[i]), widen(1, s.y[i]);
  for (const ChartMarker& m : o.vertical_lines) widen(0, m.x);
  if (!std::isfinite(2.0 * (high[0] - low[0])) || !std::isfinite(2.0 * (high[1] - low[1])))
    throw ModelError({{"chart", "range", "infinite", "", "must be within what a number can hold"}});

  Axis x = make_axis(o.log_x, o.x_label, low[0], high[0], o.log_x ? 0.03 : 0.0);
  Axis y = make_axis(o.log_y, o.y_label, low[1], high[1], 0.04);
  widen_to_decades(y);

  double top = 10.0;
  std::string head;
  if (!o.title.empty()) {
    head += text(12, top + 13, "start", escaped(o.title), " class=\"h\"");
    top += 26.0;
  }
  top += add_legend(series, 12, o.width - 10, top, head);
  const bool labels = std::any_of(o.vertical_lines.begin(), o.vertical_lines.end(),
                                  [](const ChartMarker& m) { return !m.label.empty(); });
  if (labels) top += 16.0;

  const double below = o.x_label.empty() ? 28.0 : 46.0;
  const auto lay_y = [&](int height) {
    y.begin = height - below;
    y.end = std::min(top + 6.0, y.begin - 40.0);
    y.ticks.clear(), y.label = o.y_label;
    if (y.log)
      add_log_ticks(y, (y.begin - y.end) / 22.0);
    else
      add_linear_ticks(y, (y.begin - y.end) / 36.0);
    double widest = 0.0;
    for (const Tick& t : y.ticks)
      widest = std::max(widest, text_width(t.label) + 0.8 * text_width(t.exponent));
    x.begin = 14.0 + widest + (o.y_label.empty() ? 0.0 : 20.0);
    x.end = o.width - 18.0;
  };
  int height = o.height;
  lay_y(height);
  if (o.to_scale) {
    constexpr double kLeast = 40.0, kMost = 2000.0;  // px of the plot
    height = static_cast<int>(
        std::lround(top + 6.0 + below +
                    std::clamp((y.high - y.low) / (x.high - x.low) * (x.end - x.begin), kLeast, kMost)));
    lay_y(height);
  }
  if (x.log)
    add_log_ticks(x, (x.end - x.begin) / 45.0);
  else
    add_linear_ticks(x, (x.end - x.begin) / 80.0);

  const std::string w = std::to_string(o.width), h = std::to_string(height);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + w + " " + h + "\" width=\"" +
                    w + "\" height=\"" + h + "\" role=\"img\">\n";
  if (!o.title.empty()) out += "<title>" + escaped(o.title) + "</title>\n";
  out += kStyle;
  out += "<rect class=\"bg\" width=\"" + w + "\" height=\"" + h + "\"/>\n" + head + axes_text(x, y);
  for (const ChartMarker& m : o.vertical_lines) {
    const double at = x.pixel(m.x);
    out += line("v", at, y.begin, at, y.end);
    if (!m.label.empty()) out += text(at, y.end - 6, "middle", escaped(m.label));
  }
  for (std::size_t i = 0; i < series.size(); ++i) out += series_text(series[i], static_cast<int>(i), x, y);
  return out + "</svg>\n";
}

}  // namespace drev::app
