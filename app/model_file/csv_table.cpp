#include "app/model_file/csv_table.hpp"

#include <drev/models/parameters.hpp>

#include <algorithm>
#include <cmath>

namespace drev::app {

namespace {

constexpr std::size_t kMostBadRows = 20;

/// A name that drev would have written with ' before it, so that no spreadsheet takes it for a formula.
std::string column_name(const std::string& cell) {
  const std::size_t first = cell.find_first_not_of('\'');
  const bool marked =
      first != cell.npos && first > 0 && std::string("=+-@").find(cell[first]) != std::string::npos;
  return marked ? cell.substr(1) : cell;
}

}  // namespace

// No message quotes the file: it may be any that this user can read, and a model may come from anyone.
CsvTable read_csv(const std::string& path, const Position& named_at) {
  const std::string text = read_text(path, &named_at);
  const auto file = std::make_shared<const std::string>(path);
  CsvTable table;
  std::vector<Finding> findings;
  const auto refuse = [&](const CsvCell& at, const char* where, const std::string& sentence) {
    findings.push_back(fault_at({file, at.line, at.column}, where, sentence));
  };
  CsvRows rows(text);
  std::vector<CsvCell> cells;
  std::string fault;
  std::size_t count = 0;
  while (findings.size() < kMostBadRows && fault.empty() && rows.next(cells, fault)) {
    const bool header = table.names.empty();
    if (!fault.empty()) {
      refuse(cells.back(), header ? "header" : "row", fault);
    } else if (header) {
      for (const CsvCell& cell : cells) {
        const std::string name = column_name(cell.text);
        const auto same = std::find(table.names.begin(), table.names.end(), name);
        if (name.empty())
          refuse(cell, "header", "a column has no name");
        else if (same != table.names.end())
          refuse(cell, "header",
                 "has the name of column " + std::to_string(same - table.names.begin() + 1) + " once more");
        table.names.push_back(name);
      }
      table.columns.resize(table.names.size());
    } else if (cells.size() != table.names.size()) {
      refuse(
          cells.front(), "row",
          "has " + std::to_string(cells.size()) + " cells, the header " + std::to_string(table.names.size()));
    } else {
      ++count;
      for (std::size_t c = 0; c < cells.size(); ++c) {
        double value = 0.0;
        if (!drev::read_number(cells[c].text, value) || !std::isfinite(value))
          refuse(cells[c], "row", "the cell of column " + std::to_string(c + 1) + " is no finite number");
        table.columns[c].push_back(value);
      }
    }
  }
  if (findings.empty() && table.names.empty()) refuse({}, "header", "the file is empty");
  if (findings.empty() && count == 0) refuse({}, "row", "the file has a header and no rows");
  if (!findings.empty()) throw ModelError(std::move(findings));
  return table;
}

}  // namespace drev::app
