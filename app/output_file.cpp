#include "app/output_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace drev::app {

namespace {

constexpr std::size_t kBuffer = 1 << 16;

std::string message(const std::string& path, const std::string& reason) {
  return "cannot write " + path + ": " + reason;
}

}  // namespace

void create_directory(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error && !std::filesystem::is_directory(directory, error))
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw OutputError(message(directory, error.message()));
}

OutputFile::OutputFile(const std::string& directory, const std::string& name,
                       const std::string& extension)
    : path_(directory + "/" + name + "." + extension),
      partial_(directory + "/" + name + ".partial." + extension) {
  descriptor_ = ::open(partial_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(partial_, errno);
  // Two processes must not write one file, nor may one empty what the other has just completed.
  struct stat opened {
  }, named{};
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 || ::fstat(descriptor_, &opened) != 0 ||
      ::stat(partial_.c_str(), &named) != 0 || opened.st_ino != named.st_ino) {
    ::close(descriptor_);
    throw OutputError(message(partial_, "another process is writing it"));
  }
  if (S_ISREG(opened.st_mode) && ::ftruncate(descriptor_, 0) != 0) {
    const int error = errno;
    ::close(descriptor_);
    fail(partial_, error);
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::fail(const std::string& path, int error) const {
  throw OutputError(message(path, std::strerror(error)));
}

void OutputFile::write(const std::string& text) {
  buffer_ += text;
  if (buffer_.size() >= kBuffer) flush();
}

void OutputFile::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      buffer_.clear();
      fail(partial_, error);
    }
    done += static_cast<std::size_t>(count);
  }
  buffer_.clear();
}

void OutputFile::commit() {
  flush();
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail(partial_, errno);
  if (std::rename(partial_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail(path_, errno);
}

}  // namespace drev::app
