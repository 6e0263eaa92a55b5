#include "app/model_file/csv_table.hpp"

#include <drev/models/parameters.hpp>

#include <algorithm>
#include <cmath>

namespace drev::app {

namespace {

constexpr std::size_t kMostFindings = 20;

/// Cells of a line with the columns where they begin, without blanks about them.
std::vector<std::pair<std::string, int>> cells_of(const std::string& line) {
  std::vector<std::pair<std::string, int>> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::size_t first = begin, last = end;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    cells.emplace_back(line.substr(first, last - first), static_cast<int>(first) + 1);
    begin = end + 1;
  }
  return cells;
}

}  // namespace

CsvTable read_csv(const std::string& path, const Position& named_at) {
  const std::string text = read_text(path, &named_at);
  const auto file = std::make_shared<const std::string>(path);
  CsvTable table;
  std::vector<Finding> findings;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size() && findings.size() < kMostFindings;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    const auto cells = cells_of(line);
    if (table.names.empty()) {
      for (const auto& [name, column] : cells) {
        if (name.empty() || std::count(table.names.begin(), table.names.end(), name) > 0)
          findings.push_back(
              fault_at({file, number, column}, "header",
                       name.empty() ? "a column has no name" : "the column " + name + " is there twice"));
        table.names.push_back(name);
      }
      table.columns.resize(table.names.size());
      continue;
    }
    if (cells.size() != table.names.size()) {
      findings.push_back(fault_at({file, number, 1}, "row",
                                  "has " + std::to_string(cells.size()) + " cells, the header " +
                                      std::to_string(table.names.size())));
      continue;
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      double value = 0.0;
      if (!drev::read_number(cells[c].first, value) || !std::isfinite(value))
        findings.push_back(fault_at({file, number, cells[c].second}, table.names[c],
                                    "'" + cells[c].first.substr(0, 40) + "' is no finite number"));
      table.columns[c].push_back(value);
    }
  }
  if (table.names.empty() && findings.empty())
    findings.push_back(fault_at({file, 1, 1}, "header", "the file is empty"));
  if (!findings.empty()) throw ModelError(std::move(findings));
  return table;
}

}  // namespace drev::app
