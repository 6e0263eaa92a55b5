#pragma once
/// history.csv: time_s and the recorded channels, one row each at k * every, k = 0, 1, 2, ...; 17
/// significant digits, with which every double reads back as it was. Names as csv_cell() has them.
#include <chrono>
#include <string>
#include <vector>

#include "app/base/output_file.hpp"

namespace drev::app {

class HistoryFile {
 public:
  /// Opens the file and writes its header. Throws OutputError.
  HistoryFile(const std::string& directory, const std::vector<std::string>& channels, double every);

  /// The next row; on disk within about a second. After a failure nothing more is written.
  void add(const std::vector<double>& row);
  /// What went wrong; empty if nothing did.
  const std::string& error() const { return error_; }
  long rows() const { return rows_; }

  /// The run is over. complete: history.csv, otherwise history.partial.csv stays. Sets error().
  void close(bool complete);
  const std::string& path() const { return file_.path(); }
  const std::string& partial_path() const { return file_.partial_path(); }

 private:
  using Clock = std::chrono::steady_clock;
  OutputFile file_;
  double every_;
  long rows_ = 0;
  std::string line_, error_;
  Clock::time_point flushed_ = {};  ///< the first row goes to the disk at once
};

}  // namespace drev::app
