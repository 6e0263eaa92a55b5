// Makes docs/pictures/time_against_size.svg from what bench_large prints (lines "WHAT SHAPE N VALUE UNIT"):
//   build/release/bin/bench_large | build/release/bin/make_size_picture docs/pictures
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "app/chart/svg_chart.hpp"

int main(int argc, char** argv) {
  const std::map<std::string, std::string> wanted{{"step", "a step"}, {"modes", "ten modes"}};
  std::map<std::string, drev::app::ChartSeries> series;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string what, shape, unit;
    double n = 0.0, value = 0.0;
    if (!(words >> what >> shape >> n >> value >> unit) || unit != "s" || !wanted.count(what)) continue;
    drev::app::ChartSeries& s = series[what + shape];
    s.name = wanted.at(what) + ", " + shape;
    s.markers = true;
    s.x.push_back(n);
    s.y.push_back(value);
  }
  try {
    std::vector<drev::app::ChartSeries> all;
    for (auto& [key, s] : series) all.push_back(std::move(s));
    const std::string path = std::string(argc > 1 ? argv[1] : ".") + "/time_against_size.svg";
    std::ofstream out(path);
    out << drev::app::svg_chart({.title = "Time against size",
                                 .x_label = "unknowns",
                                 .y_label = "processor time [s]",
                                 .log_x = true,
                                 .log_y = true},
                                all);
    if (!out.flush()) throw std::runtime_error("cannot write " + path);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
