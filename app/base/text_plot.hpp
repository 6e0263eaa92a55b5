#pragma once
/// Curves drawn with characters, for the terminal.
#include <array>
#include <string>
#include <vector>

namespace drev::app {

struct PlotLine {
  char mark = '*';
  std::vector<std::array<double, 2>> points;  ///< joined in their order
};

/// columns x rows characters and a frame with the ranges; `alike`: both axes with one scale (a character is twice as high
/// as wide). Lines later in the list are drawn over those before. Ends with a line end.
std::string text_plot(const std::vector<PlotLine>& lines, int columns, int rows, bool alike = false);

}  // namespace drev::app
