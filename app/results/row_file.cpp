#include "app/results/row_file.hpp"

namespace drev::app {

RowFile::RowFile(const std::string& directory, const std::string& name, const std::string& header)
    : file_(directory, name, "csv") {
  file_.write(header + "\n");
}

void RowFile::add(const std::string& line) {
  if (!error_.empty()) return;
  try {
    file_.write(line);
    ++rows_;
    if (Clock::now() - flushed_ > std::chrono::seconds(1)) {
      file_.flush();
      flushed_ = Clock::now();
    }
  } catch (const OutputError& error) {
    error_ = error.what();
  }
}

void RowFile::close(bool complete) {
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
