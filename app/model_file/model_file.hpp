#pragma once
/// A model file as a model case: the model with its parameters, and its runs. docs/model_file.md
/// describes the format. load_plugins() enters the elements that plugins give files.
#include <drev/app/model_file/position.hpp>
#include <drev/models/model_case.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drev::app {

struct Document;

/// Options of `drev run` that a file gives, by name ("--method"), as the command line would.
struct RunOptions {
  std::map<std::string, std::string> values;
  std::map<std::string, Position> places;
};

class ModelFile {
 public:
  /// `run`: a table of [run], laid over what [run] itself says; empty: [run] alone. Throws ModelError with
  /// everything that is wrong with the file.
  ModelFile(const std::string& path, const std::string& run);
  /// The same of a text; `path` is its name, and its folder that of includes and tables.
  ModelFile(const std::string& text, const std::string& path, const std::string& run);

  /// Its build() throws ModelError by file, line and column.
  const ModelEntry& entry() const { return entry_; }
  RunOptions run_options(const Parameters& parameters) const;
  std::vector<std::string> run_names() const;

 private:
  std::shared_ptr<const Document> document_;
  std::string run_;
  ModelEntry entry_;
};

/// Whether a MODEL of the command line means a file: it ends in .toml, or names a file and no built-in model.
bool is_model_file(const std::string& model);

/// Takes in the elements of plugins (plugin.hpp): loads shared libraries, which stay until the program ends; their types then stand in every model file.
/// Throws ModelError with what is wrong with each: no such file, no plugin of drev, one for another drev, a
/// type that is there already. The program must export its symbols (CMake: ENABLE_EXPORTS), as the command
/// drev does.
void load_plugins(const std::vector<std::string>& files);

/// Those that were loaded, as they were named.
const std::vector<std::string>& loaded_plugins();

}  // namespace drev::app
