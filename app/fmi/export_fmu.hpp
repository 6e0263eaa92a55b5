#pragma once
/// A model as an FMU for co-simulation: modelDescription.xml, the model's files, and drev's library.
#include <string>
#include <vector>

#include "app/run/model_request.hpp"

namespace drev::app {

struct FmuRequest {
  std::string file;                          ///< .fmu
  std::string model;                         ///< the model file as given; empty: a built-in model
  std::string run = {};                      ///< of it; empty: [run]
  std::vector<std::string> torques, speeds;  ///< nodes
  std::vector<std::string> outputs;          ///< channels
  int fmi = 3;                               ///< 2 or 3
};

/// The folder of drev_fmu.so and of the libraries that it needs; empty: it is not there.
std::string fmu_library_folder();

/// Throws ModelError for a model, inputs or outputs that cannot be, OutputError where the file cannot be written.
void export_fmu(const ModelRequest& model, const FmuRequest& request);

}  // namespace drev::app
