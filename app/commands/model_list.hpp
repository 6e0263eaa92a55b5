#pragma once
/// Which models the words of `drev run` mean. A directory stands for the model files directly in it: *.toml,
/// by name, without those that have no `format` at their top and those that another of them includes. What
/// is no TOML is among them: its faults are to be said.
#include <drev/core/error.hpp>

#include <string>
#include <vector>

#include "app/results/many_runs.hpp"

namespace drev::app {

struct ModelList {
  std::vector<NamedModel> models;
  std::vector<SkippedFile> skipped;
};

/// Whether a word of the command line means a directory of models, and no built-in one.
bool is_model_directory(const std::string& word);
/// Names are unique; what is not goes to findings, as do directories without a model.
ModelList list_models(const std::vector<std::string>& words, std::vector<Finding>& findings);

}  // namespace drev::app
