#pragma once
/// A folder of its own in the system's place for temporary files, for as long as it lives.
#include <filesystem>
#include <stdlib.h>
#include <string>
#include <unistd.h>

#include "app/base/output_file.hpp"

namespace drev::app {

class TemporaryFolder {
 public:
  /// Throws OutputError.
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "drev_fmu_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw OutputError("cannot create the folder " + name);
    path = name;
  }
  ~TemporaryFolder() {
    if (getpid() != owner_) return;  // a forked child has a copy
    std::error_code none;
    std::filesystem::remove_all(path, none);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path path;

 private:
  pid_t owner_ = getpid();
};

}  // namespace drev::app
