#pragma once
/// From the sections of a model file, with values for its parameters, to a scene.
#include "app/model_file/document.hpp"
#include "app/model_file/model_file.hpp"

namespace drev::app {

struct FileScene {
  std::optional<Scene> scene;  ///< none where something is wrong
  RunOptions options;
  std::vector<Finding> findings;
};

/// `run` as in ModelFile. With options_only, nodes and elements are passed over and there is no scene.
FileScene read_scene(const Document& document, const Settings& settings, const std::string& run,
                     bool options_only = false);

/// Values for parameters that a named run sets: laid over the defaults.
void set_run_parameters(const Document& document, const std::string& run, std::vector<Setting>& settings,
                        std::vector<Finding>& findings);

}  // namespace drev::app
