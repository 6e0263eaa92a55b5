#pragma once
/// A folder of its own in the system's place for temporary files, for as long as it lives. Those that killed processes
/// have left are removed when the next one is made: a living process holds a lock on its folder.
#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <stdlib.h>
#include <string>
#include <sys/file.h>
#include <unistd.h>

#include "app/base/output_file.hpp"

namespace drev::app {

class TemporaryFolder {
 public:
  /// Throws OutputError.
  TemporaryFolder() {
    remove_abandoned();
    std::string name = (std::filesystem::temp_directory_path() / (std::string(kPrefix) + "XXXXXX")).string();
    if (mkdtemp(name.data()) == nullptr) throw OutputError("cannot create the folder " + name);
    path = name;
    lock_ = locked(path);
  }
  ~TemporaryFolder() {
    if (getpid() == owner_) {  // a forked child has a copy
      std::error_code none;
      std::filesystem::remove_all(path, none);
    }
    if (lock_ >= 0) close(lock_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path path;

 private:
  static constexpr const char* kPrefix = "drev_fmu_";
  static constexpr std::chrono::minutes kYoung{1};  ///< it may not have its lock yet

  /// A lock on a folder, which ends with the process; -1: another one has it, or it cannot be opened.
  static int locked(const std::filesystem::path& folder) {
    const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
    if (descriptor >= 0 && flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
    if (descriptor >= 0) close(descriptor);
    return -1;
  }

  static void remove_abandoned() {
    std::error_code none;
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::temp_directory_path(none), none)) {
      if (!entry.path().filename().string().starts_with(kPrefix)) continue;
      const auto changed = entry.last_write_time(none);
      if (none || now - changed < kYoung) continue;
      const int lock = locked(entry.path());
      if (lock < 0) continue;
      std::filesystem::remove_all(entry.path(), none);
      close(lock);
    }
  }

  pid_t owner_ = getpid();
  int lock_ = -1;
};

}  // namespace drev::app
