#pragma once
/// A model with its parameters, built: what every command computes from.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/system.hpp>
#include <drev/models/model_case.hpp>

#include <memory>

namespace drev::app {

struct ModelRequest {
  std::shared_ptr<const ModelEntry> entry;
  std::shared_ptr<const ModelFile> file;  ///< null for a built-in model
  Parameters parameters;
  ModelCase model_case;
  System system;
};

}  // namespace drev::app
