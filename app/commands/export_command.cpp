#include <filesystem>

#include "app/base/json_values.hpp"
#include "app/base/output_file.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/model_file/writing/export.hpp"

namespace drev::app {

int export_command(const CommandLine& line) {
  const ModelRequest model = request_model(line);
  const std::string text = export_model(*model.entry, model.parameters, model.model_case);
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
