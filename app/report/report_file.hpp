#pragma once
/// The file of a report: a page, or the page printed as PDF. It gets its name when it is complete.
#include <optional>
#include <string>

#include "app/base/output_file.hpp"

namespace drev::app {

/// Why a report of this name cannot be made on this machine, in the words of a finding; nullopt: it can.
std::optional<std::string> why_no_report(const std::string& path);

class ReportFile {
 public:
  /// Opens the file. path: path of an .html or a .pdf file. Throws OutputError.
  explicit ReportFile(const std::string& path);
  /// Removes a file that was not committed.
  ~ReportFile();
  ReportFile(const ReportFile&) = delete;
  ReportFile& operator=(const ReportFile&) = delete;

  /// Writes the page, and prints it if the file is a PDF. Throws OutputError.
  void commit(const std::string& page);
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  OutputFile file_;
  bool complete_ = false;  ///< true: the report has its name
};

}  // namespace drev::app
