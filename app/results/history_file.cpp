#include "app/results/history_file.hpp"

#include <cstdio>

#include "app/base/csv_cell.hpp"

namespace drev::app {

namespace {

void append(std::string& line, double value) {
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%.17g", value);
  line.append(text, static_cast<std::size_t>(length));
}

}  // namespace

HistoryFile::HistoryFile(const std::string& directory, const std::vector<std::string>& channels, double every)
    : file_(directory, "history", "csv"), every_(every) {
  line_ = "time_s";
  for (const std::string& channel : channels) line_ += "," + csv_cell(channel);
  line_ += "\n";
  file_.write(line_);
}

void HistoryFile::add(const std::vector<double>& row) {
  if (!error_.empty()) return;
  line_.clear();
  append(line_, static_cast<double>(rows_) * every_);
  for (const double value : row) {
    line_ += ',';
    append(line_, value);
  }
  line_ += '\n';
  try {
    file_.write(line_);
    ++rows_;
    if (Clock::now() - flushed_ > std::chrono::seconds(1)) {
      file_.flush();
      flushed_ = Clock::now();
    }
  } catch (const OutputError& error) {
    error_ = error.what();
  }
}

void HistoryFile::close(bool complete) {
  if (!error_.empty()) return;
  try {
    if (complete)
      file_.commit();
    else
      file_.flush();
  } catch (const OutputError& error) {
    error_ = error.what();
  }
}

}  // namespace drev::app
