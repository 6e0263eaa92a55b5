#include "app/cli/model_option.hpp"

#include <drev/app/model_file/model_file.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "app/base/output_file.hpp"
#include "app/base/text_layout.hpp"

namespace drev::app {

namespace {

void take_findings(const ModelError& error, std::vector<Finding>& findings) {
  findings.insert(findings.end(), error.findings().begin(), error.findings().end());
}

/// The parameters that are right; what is wrong with the others goes to findings.
Parameters right_parameters(const ModelEntry& entry, const CommandLine& line,
                            std::vector<Finding>& findings) {
  Parameters right(entry.name, entry.parameters);
  for (const auto& [name, value] : line.parameters) {
    Parameters probe(entry.name, entry.parameters);
    probe.set(name, value);
    try {
      probe.check();
      right.set(name, value);
    } catch (const ModelError& error) {
      take_findings(error, findings);
    }
  }
  return right;
}

/// Null, and a finding, if there is no such built-in model.
const ModelEntry* find_built_in(const std::string& name, std::vector<Finding>& findings) {
  const std::vector<std::string> names = built_in_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return &ready_made_models()[static_cast<std::size_t>(found - names.begin())];
  const std::string hint = did_you_mean(name, names);
  // What is like no model may be the value of an option that does not exist.
  if (findings.empty() || !hint.empty())
    findings.push_back({kCommandLine, "MODEL", name, "",
                        "is no model" + (hint.empty() ? "; the models are " + join(names) : hint) +
                            (name.find('/') != name.npos ? "; a model file ends in .toml" : "")});
  return nullptr;
}

}  // namespace

std::vector<std::string> built_in_names() {
  std::vector<std::string> names;
  for (const ModelEntry& entry : ready_made_models()) names.push_back(entry.name);
  return names;
}

bool is_built_in(const std::string& model) {
  const std::vector<std::string> names = built_in_names();
  return std::find(names.begin(), names.end(), model) != names.end();
}

std::shared_ptr<const ModelFile> open_model_file(const CommandLine& line, const std::string& run) {
  if (line.text) return std::make_shared<const ModelFile>(*line.text, line.model, run);
  if (is_model_file(line.model)) return std::make_shared<const ModelFile>(line.model, run);
  return nullptr;
}

std::optional<Parameters> model_parameters(const CommandLine& line) {
  try {
    const std::shared_ptr<const ModelFile> file = open_model_file(line, line.option("--run").value_or(""));
    std::vector<Finding> none;
    if (const ModelEntry* entry = file ? &file->entry() : find_built_in(line.model, none))
      return Parameters(entry->name, entry->parameters);
  } catch (const ModelError&) {  // build_model() says it
  }
  return std::nullopt;
}

void check_finite(const char* option, const CommandLine& line,
                  const std::vector<std::pair<std::string, std::string>>& values,
                  std::vector<Finding>& findings) {
  std::optional<Parameters> known;
  for (const auto& [name, value] : values) {
    double number = 0.0;
    if (!read_number(value, number) || std::isfinite(number)) continue;
    Finding finding{kCommandLine, std::string(option) + " " + name, value, "", "must be a finite number"};
    if (!known) known = model_parameters(line);
    if (known) {
      Parameters probe = *known;
      probe.set(name, value);
      try {
        probe.check();
      } catch (const ModelError& error) {
        const Finding& own = error.findings().front();
        if (own.parameter == name) finding.unit = own.unit, finding.range = own.range;
      }
    }
    findings.push_back(std::move(finding));
  }
}

std::optional<ModelRequest> build_model(const CommandLine& line, std::vector<Finding>& findings) {
  if (line.model.empty()) {
    // An option that does not exist may have taken the model's name.
    if (findings.empty())
      findings.push_back(
          {kCommandLine, "MODEL", "", "", "is missing; the models are " + join(built_in_names())});
    return {};
  }
  try {
    std::shared_ptr<const ModelFile> file;
    std::shared_ptr<const ModelEntry> entry;
    if ((file = open_model_file(line, line.option("--run").value_or("")))) {
      entry = {file, &file->entry()};
    } else {
      entry = {std::shared_ptr<const void>(), find_built_in(line.model, findings)};
      if (!entry) return {};
      if (const auto run = line.option("--run"))
        findings.push_back(
            {kCommandLine, "--run", *run, "", "is for model files only; " + line.model + " is built in"});
    }
    Parameters parameters = right_parameters(*entry, line, findings);
    ModelCase model_case = entry->build(parameters);
    System system = model_case.model.build();
    return ModelRequest{entry, file, std::move(parameters), std::move(model_case), std::move(system)};
  } catch (const ModelError& error) {
    take_findings(error, findings);
    return {};
  }
}

void check_output(const char* option, const std::string& file, const std::vector<std::string>& read,
                  std::vector<Finding>& findings) {
  for (const std::string& path : {file, partial_path(file)})
    for (const std::string& input : read) {
      std::error_code none;  // where one of them does not exist, they are not the same
      if (!std::filesystem::equivalent(path, input, none)) continue;
      findings.push_back({kCommandLine, option, file, "",
                          "would be written over " + input + ", which is read; give another name"});
      return;
    }
}

ModelRequest request_model(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  return std::move(*model);
}

}  // namespace drev::app
