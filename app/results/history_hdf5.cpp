#include "app/results/history_hdf5.hpp"

#include <drev/core/version.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include "app/base/output_file.hpp"
#include "app/results/hdf5_file.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kBlock = 1024;  // number of rows written at once

/// The cells of a line of CSV as csv_cell() writes them; moves past its end.
std::vector<std::string> cells_of(const std::string& csv, std::size_t& at) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (; at < csv.size(); ++at) {
    const char c = csv[at];
    if (c == '"') {
      if (quoted && at + 1 < csv.size() && csv[at + 1] == '"')
        cells.back() += csv[++at];
      else
        quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c == '\n' && !quoted) {
      ++at;
      break;
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells)
    if (!cell.empty() && cell.front() == '\'') cell.erase(0, 1);
  return cells;
}

/// The cells as numbers if all of them are; an empty cell gives NaN.
std::optional<std::vector<double>> numbers_of(const std::vector<std::string>& cells) {
  std::vector<double> numbers;
  for (const std::string& cell : cells) {
    char* end = nullptr;
    numbers.push_back(cell.empty() ? std::numeric_limits<double>::quiet_NaN()
                                   : std::strtod(cell.c_str(), &end));
    if (!cell.empty() && *end != '\0') return std::nullopt;
  }
  return numbers;
}

}  // namespace

void write_tables_hdf5(const std::string& path, const std::vector<TableText>& tables,
                       const std::string& summary) {
  const std::string extension = ".h5", name = std::filesystem::path(path).filename().string();
  create_directory(folder_of(path));
  OutputFile file(folder_of(path), name.substr(0, name.size() - extension.size()), "h5");
  {
    Hdf5File h5(file.partial_path());
    h5.add_text("drev", DREV_VERSION);
    h5.add_text("summary", summary);
    std::size_t number = 0;
    for (const TableText& table : tables) {
      std::size_t at = 0;
      const std::vector<std::string> names = cells_of(table.csv, at);
      std::vector<std::vector<std::string>> columns(names.size());
      while (at < table.csv.size()) {
        const std::vector<std::string> row = cells_of(table.csv, at);
        for (std::size_t c = 0; c < columns.size() && c < row.size(); ++c) columns[c].push_back(row[c]);
      }
      for (std::size_t c = 0; c < names.size(); ++c) {
        const std::string place = table.name + "/" + names[c];
        if (const auto numbers = numbers_of(columns[c])) {
          h5.add_column({.name = place});
          if (!numbers->empty()) h5.write(number, 0, *numbers);
        } else {
          std::size_t longest = 1;
          for (const std::string& cell : columns[c]) longest = std::max(longest, cell.size());
          h5.add_column({.name = place, .rows = columns[c].size(), .text_size = longest});
          h5.write(number, 0, columns[c]);
        }
        ++number;
      }
    }
    h5.close();
  }
  file.commit();
}

void write_hdf5(const std::string& directory, const std::string& csv,
                const std::vector<HistoryColumn>& columns, const std::string& summary) {
  std::ifstream in(csv);
  std::string line;
  if (!std::getline(in, line)) throw OutputError("cannot read " + csv + ": " + std::strerror(errno));
  OutputFile file(directory, "history", "h5");
  {
    Hdf5File h5(file.partial_path());
    h5.add_text("drev", DREV_VERSION);
    h5.add_text("summary", summary);
    h5.add_column({"time_s", "s"});
    for (const HistoryColumn& column : columns) h5.add_column({column.name, column.unit});
    std::vector<std::vector<double>> block(columns.size() + 1);
    std::uint64_t rows = 0;
    const auto empty_block = [&] {
      if (block[0].empty()) return;
      for (std::size_t c = 0; c < block.size(); ++c) h5.write(c, rows, block[c]);
      rows += block[0].size();
      for (std::vector<double>& values : block) values.clear();
    };
    while (std::getline(in, line)) {
      char* at = line.data();
      for (std::vector<double>& values : block) {
        values.push_back(std::strtod(at, &at));
        if (*at == ',') ++at;
      }
      if (block[0].size() == kBlock) empty_block();
    }
    empty_block();
    h5.close();
  }
  file.commit();
}

}  // namespace drev::app
