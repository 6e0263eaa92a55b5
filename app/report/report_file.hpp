#pragma once
/// Where a report goes: a page, or the page printed as PDF. The file gets its name when it is complete.
#include <optional>
#include <string>

#include "app/base/output_file.hpp"

namespace drev::app {

/// What speaks against a report of this name on this machine, as a finding says it; nullopt: nothing.
std::optional<std::string> why_no_report(const std::string& path);

class ReportFile {
 public:
  /// path: of an .html or a .pdf file. Opens it. Throws OutputError.
  explicit ReportFile(const std::string& path);
  /// What was not committed is removed.
  ~ReportFile();
  ReportFile(const ReportFile&) = delete;
  ReportFile& operator=(const ReportFile&) = delete;

  /// Writes the page, prints it where that is asked for. Throws OutputError.
  void commit(const std::string& page);
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  OutputFile file_;
  bool complete_ = false;  ///< the report has its name
};

}  // namespace drev::app
