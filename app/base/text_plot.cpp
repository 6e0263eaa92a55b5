#include "app/base/text_plot.hpp"

#include <algorithm>
#include <cmath>

#include "app/base/text_layout.hpp"

namespace drev::app {

std::string text_plot(const std::vector<PlotLine>& lines, int columns, int rows, bool alike) {
  std::array<double, 2> low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  for (const PlotLine& line : lines)
    for (const auto& p : line.points)
      for (std::size_t d = 0; d < 2; ++d) low[d] = std::min(low[d], p[d]), high[d] = std::max(high[d], p[d]);
  if (!(low[0] <= high[0])) return "";
  std::array<double, 2> step{(high[0] - low[0]) / (columns - 1), (high[1] - low[1]) / (rows - 1)};
  if (alike) {
    const double one = std::max(step[0], 0.5 * step[1]);
    step = {one, 2.0 * one};
    rows = static_cast<int>(std::lround((high[1] - low[1]) / step[1])) + 1;
  }
  for (double& s : step)
    if (!(s > 0.0)) s = 1.0;
  std::vector<std::string> canvas(static_cast<std::size_t>(rows),
                                  std::string(static_cast<std::size_t>(columns), ' '));
  for (const PlotLine& line : lines) {
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const auto& to = line.points[i];
      const auto& from = line.points[i == 0 ? 0 : i - 1];
      const double span = std::max(std::abs(to[0] - from[0]) / step[0], std::abs(to[1] - from[1]) / step[1]);
      const int parts = std::max(1, static_cast<int>(std::ceil(span)));
      for (int k = 0; k <= parts; ++k) {
        const double part = static_cast<double>(k) / parts;
        const auto x = std::lround((from[0] + part * (to[0] - from[0]) - low[0]) / step[0]);
        const auto y = std::lround((from[1] + part * (to[1] - from[1]) - low[1]) / step[1]);
        if (x >= 0 && x < columns && y >= 0 && y < rows)
          canvas[static_cast<std::size_t>(rows - 1 - y)][static_cast<std::size_t>(x)] = line.mark;
      }
    }
  }
  const std::string top = short_digits(high[1], 4), bottom = short_digits(low[1], 4);
  const std::size_t margin = alike ? 2 : std::max(top.size(), bottom.size()) + 1;
  std::string text;
  for (std::size_t r = 0; r < canvas.size(); ++r) {
    const std::string label = alike ? "" : r == 0 ? top : r + 1 == canvas.size() ? bottom : "";
    std::string row = pad_left(label, margin - 1) + (alike ? " " : "|") + canvas[r];
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  if (!alike) {
    const std::string left = short_digits(low[0], 4), right = short_digits(high[0], 4);
    text += std::string(margin, ' ') + left +
            pad_left(right, static_cast<std::size_t>(columns) - left.size()) + "\n";
  }
  return text;
}

}  // namespace drev::app
