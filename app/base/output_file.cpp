#include "app/base/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace drev::app {

namespace {

constexpr std::size_t kBuffer = 1 << 16;

std::string message(const std::string& path, const std::string& reason) {
  return "cannot write " + path + ": " + reason;
}

[[noreturn]] void fail(const std::string& path, int error) {
  throw OutputError(message(path, std::strerror(error)));
}

void empty(int descriptor, const std::string& path) {
  if (::ftruncate(descriptor, 0) == 0) return;
  const int error = errno;
  ::close(descriptor);
  fail(path, error);
}

/// 0, or errno.
int write_all(int descriptor, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::write(descriptor, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    done += static_cast<std::size_t>(count);
  }
  return 0;
}

/// To the disk; 0, or errno.
int sync(int descriptor) { return ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS ? 0 : errno; }

}  // namespace

int open_to_write(const std::string& path, int flags, int access) {
  const int descriptor =
      ::open(path.c_str(), access | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | flags, 0666);
  if (descriptor < 0 && errno == ENOENT && (flags & O_CREAT) == 0) return -1;
  const auto refuse = [&](const std::string& reason) {
    if (descriptor >= 0) ::close(descriptor);
    throw OutputError(message(path, reason));
  };
  if (descriptor < 0 && errno == ELOOP) refuse("it is a symbolic link, which is not followed; remove it");
  if (descriptor < 0 && errno != ENXIO) fail(path, errno);
  struct stat opened {
  }, named{};
  if (descriptor < 0 || ::fstat(descriptor, &opened) != 0 || !S_ISREG(opened.st_mode))
    refuse("it is no regular file; remove it");
  // Nor may another change what this one has just given its name.
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 || ::lstat(path.c_str(), &named) != 0 ||
      opened.st_ino != named.st_ino)
    refuse("another process, or another output of this command, is writing it");
  return descriptor;
}

void sync_directory(const std::string& directory) {
  const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // what cannot be opened cannot be asked to
  sync(descriptor);
  ::close(descriptor);
}

void create_directory(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error && !std::filesystem::is_directory(directory, error))
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw OutputError(message(directory, error.message()));
}

std::string folder_of(const std::string& path) {
  const std::filesystem::path file(path);
  return file.has_parent_path() ? file.parent_path().string() : ".";
}

std::string partial_path(const std::string& path) {
  const std::filesystem::path file(path);
  return (file.parent_path() / (file.stem().string() + ".partial" + file.extension().string())).string();
}

void write_file(const std::string& directory, const std::string& name, const std::string& extension,
                const std::string& text) {
  OutputFile file(directory, name, extension);
  file.write(text);
  file.commit();
}

OutputFile::OutputFile(const std::string& directory, const std::string& name, const std::string& extension)
    : path_(directory + "/" + name + "." + extension), partial_(drev::app::partial_path(path_)) {
  descriptor_ = open_to_write(partial_, O_CREAT, O_WRONLY);
  empty(descriptor_, partial_);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(const std::string& text) {
  buffer_ += text;
  if (buffer_.size() >= kBuffer) flush();
}

void OutputFile::flush() {
  const int error = write_all(descriptor_, buffer_);
  if (error == 0) written_ += static_cast<off_t>(buffer_.size());
  buffer_.clear();
  if (error == 0) return;
  // What a full disk took of it is no whole row.
  const int cut = ::ftruncate(descriptor_, written_);
  static_cast<void>(cut);
  if (written_ == 0) std::remove(partial_.c_str());  // of which nothing is there
  fail(partial_, error);
}

void OutputFile::commit() {
  flush();
  if (const int error = sync(descriptor_); error != 0) fail(partial_, error);
  if (std::rename(partial_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail(path_, errno);
}

ReplacedFile::ReplacedFile(const std::string& directory, const std::string& name,
                           const std::string& extension)
    : path_(directory + "/" + name + "." + extension),
      partial_(drev::app::partial_path(path_)),
      next_(partial_ + ".next") {
  descriptor_ = open_to_write(partial_, 0, O_WRONLY);
}

ReplacedFile::~ReplacedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ReplacedFile::replace(const std::string& text) {
  const int next = open_to_write(next_, O_CREAT, O_WRONLY);
  empty(next, next_);
  int error = write_all(next, text);
  if (error == 0) error = sync(next);
  if (error == 0 && std::rename(next_.c_str(), partial_.c_str()) != 0) error = errno;
  if (error != 0) {
    std::remove(next_.c_str());
    ::close(next);
    fail(partial_, error);
  }
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = next;
}

void ReplacedFile::commit() {
  if (std::rename(partial_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace drev::app
