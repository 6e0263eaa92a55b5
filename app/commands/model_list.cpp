#include "app/commands/model_list.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "app/cli/command_line.hpp"
#include "app/cli/model_option.hpp"
#include "app/model_file/tree.hpp"

namespace drev::app {

namespace {

namespace fs = std::filesystem;

/// Nothing if the file cannot be read, or is no TOML.
std::optional<Value> read_root(const std::string& file) {
  try {
    return parse_toml(read_text(file, nullptr), file);
  } catch (const ModelError&) {
    return {};
  }
}

/// The files that a file includes itself, from where drev is started.
std::vector<std::string> included_by(const Value& root, const std::string& file) {
  const Entry* include = root.find("include");
  std::vector<std::string> files;
  const auto add = [&](const Value& name) {
    if (name.is(Value::Kind::text))
      files.push_back((fs::path(file).parent_path() / name.text).lexically_normal().string());
  };
  if (include == nullptr) return files;
  add(include->value);
  for (const Value& name : include->value.items) add(name);
  return files;
}

std::vector<std::string> toml_files(const std::string& directory, std::vector<Finding>& findings) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".toml" && !entry->is_directory())
      files.push_back(entry->path().string());
  if (error) findings.push_back({kCommandLine, "MODEL", directory, "", "cannot be read: " + error.message()});
  std::sort(files.begin(), files.end());
  return files;
}

void add_directory(const std::string& directory, ModelList& list, std::vector<Finding>& findings) {
  const std::size_t before = findings.size();
  const std::vector<std::string> files = toml_files(directory, findings);
  std::map<std::string, std::string> part_of;
  std::vector<std::string> without_format;
  for (const std::string& file : files) {
    const std::optional<Value> root = read_root(file);
    if (!root) continue;
    if (root->find("format") == nullptr) without_format.push_back(file);
    const std::string normal = fs::path(file).lexically_normal().string();
    for (const std::string& part : included_by(*root, file))
      if (part != normal) part_of.emplace(part, file);
  }
  // Files that include each other are parts of nothing: their runs say what is wrong.
  const auto in_a_loop = [&](const std::string& start) {
    std::string file = start;
    for (std::size_t i = 0; i <= part_of.size(); ++i) {
      const auto whole = part_of.find(file);
      if (whole == part_of.end()) return false;
      file = fs::path(whole->second).lexically_normal().string();
    }
    return true;
  };
  const std::size_t models = list.models.size();
  for (const std::string& file : files) {
    const std::string normal = fs::path(file).lexically_normal().string();
    const auto whole = in_a_loop(normal) ? part_of.end() : part_of.find(normal);
    if (std::count(without_format.begin(), without_format.end(), file) > 0)
      list.skipped.push_back({file, "it has no 'format' at its top, so it is no model file"});
    else if (whole != part_of.end())
      list.skipped.push_back({file, "it is a part of " + whole->second});
    else
      list.models.push_back({fs::path(file).stem().string(), file});
  }
  if (list.models.size() == models && findings.size() == before)
    findings.push_back({kCommandLine, "MODEL", directory, "", "is a directory without a model file, *.toml"});
}

}  // namespace

bool is_model_directory(const std::string& word) {
  std::error_code error;
  return !is_built_in(word) && fs::is_directory(word, error);
}

namespace {

/// A slash behind the name of a directory is not of the name.
std::string name_of(const std::string& word) {
  if (is_built_in(word)) return word;
  return fs::path(word.substr(0, word.find_last_not_of('/') + 1)).stem().string();
}

}  // namespace

ModelList list_models(const std::vector<std::string>& words, std::vector<Finding>& findings) {
  ModelList list;
  for (const std::string& word : words)
    if (is_model_directory(word))
      add_directory(word, list, findings);
    else
      list.models.push_back({name_of(word), word});
  const auto is_same = [](const std::string& one, const std::string& other) {
    std::error_code error;
    return one == other || fs::equivalent(one, other, error);
  };
  std::map<std::string, std::string> named;
  for (const NamedModel& model : list.models)
    if (model.name == "." || model.name == ".." || model.name.starts_with("runs."))
      findings.push_back({kCommandLine, "MODEL", model.model, "",
                          "has the name '" + model.name + "', which no folder of results can have"});
  for (const NamedModel& model : list.models)
    if (const auto [same, added] = named.emplace(model.name, model.model); !added)
      findings.push_back(
          {kCommandLine, "MODEL", model.model, "",
           (is_same(model.model, same->second) ? "is given twice" : "has the name of " + same->second) +
               "; both results would be in DIR/" + model.name});
  return list;
}

}  // namespace drev::app
