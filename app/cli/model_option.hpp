#pragma once
/// The MODEL of a command line with its --set and --run, built.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/command_line.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

/// The names of the built-in models, and whether one of them is meant.
std::vector<std::string> built_in_names();
bool is_built_in(const std::string& model);

/// The model file that is meant; null: a built-in model. Throws ModelError with everything wrong with the file.
std::shared_ptr<const ModelFile> open_model_file(const CommandLine& line, const std::string& run);
/// The parameters of the MODEL, with their defaults; nothing if there is no such model, or what is wrong with its file.
std::optional<Parameters> model_parameters(const CommandLine& line);
/// A finding on `option` for each value that is not finite, with what the model's parameter of that name may be.
void check_finite(const char* option, const CommandLine& line,
                  const std::vector<std::pair<std::string, std::string>>& values,
                  std::vector<Finding>& findings);
/// The model as far as it can be built; nothing if it cannot. What is wrong goes to findings.
std::optional<ModelRequest> build_model(const CommandLine& line, std::vector<Finding>& findings);
/// A finding if the file, or the partial one that becomes it, is one of those that are read.
void check_output(const char* option, const std::string& file, const std::vector<std::string>& read,
                  std::vector<Finding>& findings);
/// The model of a command that needs nothing else. Throws ModelError with everything wrong with the line.
ModelRequest request_model(const CommandLine& line);

}  // namespace drev::app
