#pragma once
/// A model as an FMU for co-simulation: modelDescription.xml, the model's files, and drev's library.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/base/temporary_folder.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

struct FmuRequest {
  std::string file;                          ///< path of the .fmu file
  std::string model;                         ///< path of the model file as given; empty: a built-in model
  std::optional<std::string> text = {};      ///< text of the model file, if it is not to be read
  std::string run = {};                      ///< named run of the model file; empty: [run]
  std::vector<std::string> torques, speeds;  ///< nodes whose torque or speed is an input
  std::vector<std::string> outputs;          ///< channels that are outputs
  int fmi = 3;                               ///< version of FMI: 2 or 3
};

/// drev_fmu.so and the libraries that it needs: for the command those installed with it, for the Python
/// package those unpacked for the lifetime of this object.
class FmuLibrary {
 public:
  /// Throws OutputError if they are missing.
  FmuLibrary();
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::optional<TemporaryFolder> unpacked_;
  std::filesystem::path folder_;
};

/// Throws ModelError for an invalid model or invalid inputs or outputs, OutputError if the file cannot be
/// written.
void export_fmu(const ModelRequest& model, const FmuRequest& request);

}  // namespace drev::app
