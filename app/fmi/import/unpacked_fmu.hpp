#pragma once
/// An FMU unpacked to a temporary folder, with its description and its library loaded.
#include <memory>
#include <string>

#include "app/base/temporary_folder.hpp"
#include "app/fmi/import/fmu_description.hpp"

namespace drev::app {

class UnpackedFmu {
 public:
  /// Throws std::runtime_error with the fault of the file.
  explicit UnpackedFmu(const std::string& file);

  const FmuDescription& description() const { return description_; }
  /// Its name in messages: the name of its file.
  const std::string& name() const { return name_; }
  std::filesystem::path resources() const { return folder_.path / "resources"; }
  /// A function of its library, which is loaded at the first call and remains loaded until the process ends.
  /// Throws std::runtime_error if there is no library for this machine, or the library does not have the
  /// function.
  void* function(const std::string& name) const;

 private:
  void load() const;

  std::string name_;
  TemporaryFolder folder_;
  FmuDescription description_;
  mutable void* library_ = nullptr;
};

/// The FMU of a file: one for all models of the process, unpacked again where the file has changed. Its folder is
/// removed when the process ends.
std::shared_ptr<const UnpackedFmu> unpacked_fmu(const std::string& file);

}  // namespace drev::app
