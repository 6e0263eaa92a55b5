#pragma once
/// Line charts as self-contained SVG text, for reports and for the documentation.
///
///   const std::string svg = svg_chart({.title = "Work and precision",
///                                      .x_label = "steps", .y_label = "error [m]",
///                                      .log_x = true, .log_y = true},
///                                     {{.name = "average acceleration", .x = steps, .y = errors,
///                                       .markers = true}});
///
/// Readable on a light and on a dark page (the page's colour scheme decides) and without colour vision:
/// the colours are those of Okabe and Ito, and every series has a dash pattern and a marker of its own; from
/// the eighth series on the markers are open.
///
/// A line with more points than the chart has pixels is thinned: of the points in one pixel column the
/// first, the lowest, the highest and the last are kept, so that no peak is lost. The file's size depends
/// on the chart's width, not on the length of the run.
///
/// Source of the colours: M. Okabe, K. Ito, Color Universal Design, University of Tokyo, 2008.
#include <string>
#include <vector>

namespace drev::app {

/// One curve, or a set of points.
struct ChartSeries {
  std::string name;                    ///< in the legend; empty: not listed there
  std::vector<double> x = {}, y = {};  ///< same length, at least one point, finite; > 0 on a logarithmic axis
  bool line = true;                    ///< points joined in the order given
  bool markers = false;                ///< a symbol at every point
  bool rings = false;                  ///< a wide circle around every point, of no colour of its own
};

/// A vertical line across the chart, for an event or a reference value of x.
struct ChartMarker {
  double x = 0.0;
  std::string label = {};
};

struct ChartOptions {
  std::string title = {};
  std::string x_label = {}, y_label = {};  ///< with units, e.g. "time [s]"
  bool log_x = false, log_y = false;
  std::vector<ChartMarker> vertical_lines = {};
  int width = 800, height = 400;  ///< px, at least 200 x 150, at most 10000; the image scales
  bool to_scale = false;          ///< a unit is as long along y as along x, the height follows; linear axes
};

/// The chart as one SVG document. Throws ModelError, with every finding, for no series, a series without
/// points, lengths that differ, values that are not finite or not positive on a logarithmic axis.
std::string svg_chart(const ChartOptions& options, const std::vector<ChartSeries>& series);

}  // namespace drev::app
