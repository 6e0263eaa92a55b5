#include <drev/app/model_file/model_file.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app/base/json_values.hpp"
#include "app/base/output_file.hpp"
#include "app/cli/command_line.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/import/imported.hpp"
#include "app/model_file/tree.hpp"

namespace drev::app {

namespace {

/// A table that a spreadsheet has written in another encoding is refused here, where its place is known.
void check_encoding(const std::string& text, const std::string& file) {
  std::size_t at = text.find('\0');
  if (at == text.npos) try {
      Json(text).dump();
      return;
    } catch (const Json::type_error& error) {
      const std::string said = error.what(), before = "at index ";
      at = std::stoul(said.substr(said.find(before) + before.size()));
    }
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  throw ModelError({{file + ":" + std::to_string(line), "", "", "",
                     "is no text in UTF-8, such as a file in Latin-1 or UTF-16: save it as UTF-8"}});
}

/// What is written can be read: a fault of the data, a mass without inertia, is found now. Its place is the train's: the
/// line of a file that is not written tells nobody anything.
void check_written(const std::string& toml, const std::string& file) {
  try {
    const ModelFile written(toml, file, "");
    const ModelEntry& entry = written.entry();
    entry.build(Parameters(entry.name, entry.parameters));
  } catch (const ModelError& error) {
    std::vector<Finding> findings = error.findings();
    for (Finding& finding : findings)
      if (const std::size_t end = finding.place.find(": "); finding.place.starts_with(file + ":"))
        finding.place = file + (end == std::string::npos ? "" : finding.place.substr(end));
    throw ModelError(std::move(findings));
  }
}

}  // namespace

int import_command(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  const std::vector<std::string> files = line.list("FILE").value_or(std::vector<std::string>{});
  const std::string file = files.empty() ? "" : files.front();
  const bool json = file.ends_with(".json");
  if (files.size() != 1 || (!json && !file.ends_with(".csv")))
    findings.push_back({kCommandLine, "FILE", file, "", "must be one file, .json of openTorsion or .csv"});
  const auto out = line.option("--out");
  if (out && !out->ends_with(".toml"))
    findings.push_back({kCommandLine, "--out", *out, "", "must be the name of a .toml file"});
  if (out) check_output("--out", *out, files, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  const std::string text = read_text(file, nullptr);
  check_encoding(text, file);
  const ImportedModel model = json ? import_opentorsion(text, file) : import_mass_elastic(text, file);
  const std::string toml = model.toml(std::filesystem::path(file).filename().string());
  check_written(toml, file);
  for (const std::string& sentence : model.left_out())
    std::fprintf(stderr, "drev: not taken over: %s\n", sentence.c_str());
  if (out) {
    const std::filesystem::path path(*out);
    write_file(folder_of(*out), path.stem().string(), "toml", toml);
  }
  if (line.json) {
    Json object{{"nodes", model.node_count()}, {"not_taken", model.left_out()}};
    object["file"] = out ? Json(*out) : Json();
    print(json_text(object));
  } else {
    print(out ? "Model file " + *out + ", " + std::to_string(model.node_count()) + " nodes\n" : toml);
  }
  return kSuccess;
}

}  // namespace drev::app
