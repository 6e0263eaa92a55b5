#include "app/results/history_file.hpp"

#include "app/base/csv_cell.hpp"

namespace drev::app {

namespace {

std::string history_header(const std::vector<std::string>& channels) {
  std::string line = "time_s";
  for (const std::string& channel : channels) line += "," + csv_cell(channel);
  return line;
}

}  // namespace

HistoryFile::HistoryFile(const std::string& directory, const std::vector<std::string>& channels, double every)
    : RowFile(directory, "history", history_header(channels)), every_(every) {}

void HistoryFile::add(const std::vector<double>& row) {
  line_.clear();
  append_digits(line_, static_cast<double>(rows()) * every_);
  for (const double value : row) {
    line_ += ',';
    append_digits(line_, value);
  }
  line_ += '\n';
  RowFile::add(line_);
}

}  // namespace drev::app
