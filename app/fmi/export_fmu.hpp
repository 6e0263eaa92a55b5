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
  std::string file;                          ///< .fmu
  std::string model;                         ///< the model file as given; empty: a built-in model
  std::optional<std::string> text = {};      ///< of the model file, where it is not to be read
  std::string run = {};                      ///< of it; empty: [run]
  std::vector<std::string> torques, speeds;  ///< nodes
  std::vector<std::string> outputs;          ///< channels
  int fmi = 3;                               ///< 2 or 3
};

/// drev_fmu.so and the libraries that it needs: of the command those installed with it, of the Python package unpacked
/// for as long as this lives.
class FmuLibrary {
 public:
  /// Throws OutputError where they are not there.
  FmuLibrary();
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::optional<TemporaryFolder> unpacked_;
  std::filesystem::path folder_;
};

/// Throws ModelError for a model, inputs or outputs that cannot be, OutputError where the file cannot be written.
void export_fmu(const ModelRequest& model, const FmuRequest& request);

}  // namespace drev::app
