#include <drev/core/channel.hpp>

#include <filesystem>
#include <iostream>

#include "app/base/json_values.hpp"
#include "app/base/output_file.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/fmi/export_fmu.hpp"
#include "app/model_file/writing/export.hpp"
#include "core/names/channel_pattern.hpp"

namespace drev::app {

namespace {

/// Outputs may be actual motions, too, which are no channels: patterns alone are looked up.
std::vector<std::string> without_patterns(const std::vector<std::string>& names, const System& system,
                                          std::vector<Finding>& findings) {
  std::vector<std::string> all;
  for (const AskedChannel& one : asked_channels(system, names)) {
    all.push_back(one.name);
    if (!is_pattern(one.name)) continue;
    try {
      find_channels(system, {one.name});
    } catch (const ModelError& error) {
      findings.insert(findings.end(), error.findings().begin(), error.findings().end());
    }
  }
  return all;
}

/// drev export MODEL --fmu FILE.
int export_as_fmu(const CommandLine& line, const ModelRequest& model) {
  FmuRequest request{.file = *line.option("--fmu"),
                     .model = model.file ? line.model : "",
                     .text = line.text,
                     .run = line.option("--run").value_or(""),
                     .torques = line.list("--torque").value_or(std::vector<std::string>{}),
                     .speeds = line.list("--speed").value_or(std::vector<std::string>{}),
                     .outputs = line.list("--record").value_or(model.model_case.channels),
                     .fmi = line.option("--fmi").value_or("3") == "2" ? 2 : 3};
  std::vector<Finding> findings;
  request.outputs = without_patterns(request.outputs, model.system, findings);
  const std::filesystem::path path(request.file);
  if (!path.has_stem() || path.extension() != ".fmu")
    findings.push_back(
        {kCommandLine, "--fmu", request.file, "", "must be the name of a file that ends in .fmu"});
  if (line.option("--out"))
    findings.push_back({kCommandLine, "--out", *line.option("--out"), "", "is given together with --fmu"});
  if (!findings.empty()) throw ModelError(std::move(findings));
  export_fmu(model, request);
  return kSuccess;
}

}  // namespace

int export_command(const CommandLine& line) {
  const ModelRequest model = request_model(line);
  if (line.option("--fmu")) return export_as_fmu(line, model);
  for (const char* option : {"--torque", "--speed", "--record", "--fmi"})
    if (line.options.count(option) > 0)
      throw ModelError({{kCommandLine, option, "", "", "is for --fmu, which is not there"}});
  const RunOptions options = model.file ? model.file->run_options(model.parameters) : RunOptions{};
  const std::string text = export_model(*model.entry, model.parameters, model.model_case, options);
  if (const std::string left_out = left_out_of(model.model_case); !left_out.empty())
    std::cerr << "drev: left out: " << left_out << "\n";
  const std::optional<std::string> out = line.option("--out");
  if (!out) {
    print(line.json ? json_text({{"file", text}}) : text);
    return kSuccess;
  }
  const std::filesystem::path path(*out);
  const std::string folder = folder_of(*out);
  if (!path.has_filename() || path.extension() != ".toml")
    throw ModelError({{kCommandLine, "--out", *out, "", "must be the name of a file that ends in .toml"}});
  std::vector<Finding> findings;
  check_output("--out", *out, model.model_case.files, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  create_directory(folder);
  write_file(folder, path.stem().string(), "toml", text);
  return kSuccess;
}

}  // namespace drev::app
