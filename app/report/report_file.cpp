#include "app/report/report_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
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
      stem_(std::filesystem::path(path).stem().string()),
      pdf_(path.ends_with(".pdf")),
      page_(folder_of(path), pdf_ ? stem_ + ".pdf-page" : stem_, "html") {}

ReportFile::~ReportFile() {
  if (complete_) return;
  std::remove(page_.partial_path().c_str());
  if (pdf_) std::remove(partial_pdf().c_str());
}

std::string ReportFile::partial_pdf() const { return folder_of(path_) + "/" + stem_ + ".partial.pdf"; }

void ReportFile::commit(const std::string& page) {
  page_.write(page);
  if (!pdf_) {
    page_.commit();
    complete_ = true;
    return;
  }
  page_.flush();
  print_as_pdf(page_.partial_path(), partial_pdf());
  if (std::rename(partial_pdf().c_str(), path_.c_str()) != 0)
    throw OutputError("cannot write " + path_ + ": " + std::strerror(errno));
}

}  // namespace drev::app
