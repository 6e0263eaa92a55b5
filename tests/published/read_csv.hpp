#pragma once
/// Reads a table of the tests' own data folder.
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// Rows of cells as text; the header row is left out. File relative to tests/published/data.
inline std::vector<std::vector<std::string>> read_csv(const std::string& file) {
  std::ifstream in(std::string(DREV_SOURCE_DIR) + "/tests/published/data/" + file);
  if (!in) throw std::runtime_error("cannot open " + file);
  std::vector<std::vector<std::string>> rows;
  std::string line, cell;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> row;
    std::istringstream cells(line);
    while (std::getline(cells, cell, ',')) row.push_back(cell);
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}
