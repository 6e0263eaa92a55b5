#include "app/report/report_file.hpp"

#include <cstdio>
#include <filesystem>

#include "app/report/report_pdf.hpp"

namespace drev::app {

std::optional<std::string> why_no_report(const std::string& path) {
  const std::filesystem::path file(path);
  const bool pdf = file.extension() == ".pdf";
  if (!pdf && file.extension() != ".html") return "must be the name of an .html or a .pdf file";
  if (pdf && find_browser().empty()) return kNoBrowser;
  return {};
}

ReportFile::ReportFile(const std::string& path)
    : path_(path),
      file_(folder_of(path), std::filesystem::path(path).stem().string(),
            std::filesystem::path(path).extension().string().substr(1)) {}

ReportFile::~ReportFile() {
  if (!complete_) std::remove(file_.partial_path().c_str());
}

void ReportFile::commit(const std::string& page) {
  file_.write(path_.ends_with(".pdf") ? print_as_pdf(page, folder_of(path_)) : page);
  file_.commit();
  complete_ = true;
}

}  // namespace drev::app
