#include <drev/app/model_file/model_file.hpp>

#include <algorithm>
#include <filesystem>

#include "app/model_file/case_reader.hpp"
#include "app/model_file/part.hpp"

namespace drev::app {

ModelFile::ModelFile(const std::string& path, const std::string& run)
    : ModelFile(read_text(path, nullptr), path, run) {}

ModelFile::ModelFile(const std::string& text, const std::string& path, const std::string& run) : run_(run) {
  auto document = std::make_shared<Document>(read_document(text, path));
  std::vector<Finding> findings = document->findings;
  const std::vector<std::string> runs = document->run_names();
  if (!run.empty() && std::count(runs.begin(), runs.end(), run) == 0)
    findings.push_back(
        {"command line", "--run", run, "",
         "is no run of " + path + (runs.empty() ? "; it has none besides [run]" : did_you_mean(run, runs))});
  set_run_parameters(*document, run, document->parameters, findings);
  entry_ = {document->name, document->summary, document->parameters, {}};
  document_ = document;
  if (!findings.empty()) {
    // What else is wrong, as far as it can be told with the defaults.
    const FileCase rest = read_case(*document, Parameters(entry_.name, entry_.parameters), run);
    findings.insert(findings.end(), rest.findings.begin(), rest.findings.end());
    limit_findings(findings, document->at);
    throw ModelError(std::move(findings));
  }
  entry_.build = [document, run](Parameters parameters) {
    parameters.check();
    FileCase result = read_case(*document, parameters, run);
    if (!result.model_case) throw ModelError(std::move(result.findings));
    return std::move(*result.model_case);
  };
}

RunOptions ModelFile::run_options(const Parameters& parameters) const {
  return read_case(*document_, parameters, run_, true).options;
}

std::vector<std::string> ModelFile::run_names() const { return document_->run_names(); }

bool is_model_file(const std::string& model) {
  if (model.ends_with(".toml")) return true;
  const auto built_in = [&](const ModelEntry& entry) { return entry.name == model; };
  std::error_code error;
  return std::none_of(ready_made_models().begin(), ready_made_models().end(), built_in) &&
         std::filesystem::is_regular_file(model, error);
}

}  // namespace drev::app
