#pragma once
/// A file of rows that grows with the run. Rows are on disk within about a second; the file gets its own name
/// only when it is complete.
#include <chrono>
#include <string>

#include "app/base/output_file.hpp"

namespace drev::app {

class RowFile {
 public:
  /// Opens DIR/NAME.csv and writes its first line. Throws OutputError.
  RowFile(const std::string& directory, const std::string& name, const std::string& header);

  /// Adds the next row, given with its line end. After a failure nothing more is written.
  void add(const std::string& line);
  /// Description of the failure; empty: there was none.
  const std::string& error() const { return error_; }
  long rows() const { return rows_; }

  /// To be called at the end of the run. complete: the file becomes NAME.csv, otherwise NAME.partial.csv
  /// remains. Sets error().
  void close(bool complete);
  const std::string& path() const { return file_.path(); }
  const std::string& partial_path() const { return file_.partial_path(); }

 private:
  using Clock = std::chrono::steady_clock;
  OutputFile file_;
  long rows_ = 0;
  std::string error_;
  Clock::time_point flushed_ = {};  ///< the first row goes to the disk at once
};

}  // namespace drev::app
