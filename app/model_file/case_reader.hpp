#pragma once
/// From the sections of a model file, with values for its parameters, to a model case.
#include <drev/app/model_file/model_file.hpp>

#include "app/model_file/document.hpp"
#include "app/model_file/read_values.hpp"

namespace drev::app {

struct FileCase {
  std::optional<ModelCase> model_case;  ///< none where something is wrong
  RunOptions options;
  std::vector<Finding> findings;
};

/// What values of the file are read with.
ReadContext context_of(const Document& document, const Parameters& parameters);

/// `run` as in ModelFile. With options_only, nodes and elements are passed over and there is no model case.
FileCase read_case(const Document& document, const Parameters& parameters, const std::string& run,
                   bool options_only = false);

/// Values for parameters that a named run sets: laid over the defaults.
void set_run_parameters(const Document& document, const std::string& run, std::vector<Parameter>& parameters,
                        std::vector<Finding>& findings);

}  // namespace drev::app
