#include "app/fmi/zip_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <minizip/zip.h>

#include "app/base/output_file.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kPart = std::size_t{1} << 24;  // number of bytes given to minizip at once

/// minizip says that it failed, and the system why: errno is 0 before the call.
std::string reason() { return errno != 0 ? std::string(": ") + std::strerror(errno) : ""; }

}  // namespace

ZipFile::ZipFile(const std::string& path) : path_(path), partial_(partial_path(path)) {
  std::error_code none;
  std::filesystem::remove(partial_, none);  // a link would be followed
  errno = 0;
  zip_ = zipOpen64(partial_.c_str(), APPEND_STATUS_CREATE);
  if (zip_ == nullptr) throw OutputError("cannot create " + partial_ + reason());
}

ZipFile::~ZipFile() {
  if (zip_ == nullptr) return;
  zipClose(zip_, nullptr);
  std::error_code none;
  std::filesystem::remove(partial_, none);
}

void ZipFile::add(const std::string& name, std::string_view content) {
  errno = 0;
  zip_fileinfo info{};
  info.tmz_date = {0, 0, 0, 1, 0, 1980};  // a fixed date: the same bytes at any time
  bool good = zipOpenNewFileInZip64(zip_, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                                    Z_BEST_SPEED, 0) == ZIP_OK;
  while (good && !content.empty()) {
    const std::size_t part = std::min(content.size(), kPart);
    good = zipWriteInFileInZip(zip_, content.data(), static_cast<unsigned>(part)) == ZIP_OK;
    content.remove_prefix(part);
  }
  if (!good || zipCloseFileInZip(zip_) != ZIP_OK)
    throw OutputError("cannot write " + name + " into " + partial_ + reason());
}

void ZipFile::commit() {
  errno = 0;
  const bool closed = zipClose(zip_, nullptr) == ZIP_OK;
  zip_ = nullptr;
  if (!closed) {
    const std::string why = reason();
    std::remove(partial_.c_str());
    throw OutputError("cannot complete " + partial_ + why);
  }
  std::error_code error;
  std::filesystem::rename(partial_, path_, error);
  if (error) throw OutputError("cannot give " + partial_ + " its name: " + error.message());
}

}  // namespace drev::app
