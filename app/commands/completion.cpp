#include "app/commands/completion.hpp"

#include <drev/app/model_file/model_file.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/system.hpp>
#include <drev/models/model_case.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <algorithm>

#include "app/base/text_layout.hpp"
#include "app/commands/commands.hpp"

namespace drev::app {

namespace {

/// The model that the words name: its model case, and its file if it is one. Both null: none, or a file with
/// faults.
struct TypedModel {
  std::shared_ptr<const ModelEntry> entry = {};
  std::shared_ptr<const ModelFile> file = {};
};

TypedModel model_in(const std::vector<std::string>& words) {
  for (const ModelEntry& entry : ready_made_models())
    if (std::find(words.begin(), words.end(), entry.name) != words.end())
      return {{std::shared_ptr<const void>(), &entry}};
  for (const std::string& word : words) try {
      if (!word.ends_with(".toml")) continue;
      const auto file = std::make_shared<const ModelFile>(word, "");
      return {{file, &file->entry()}, file};
    } catch (const ModelError&) {
      return {};
    }
  return {};
}

std::vector<std::string> settings_of(const ModelEntry& entry, const std::string& word) {
  std::vector<std::string> offered;
  const std::size_t equals = word.find('=');
  for (const Parameter& parameter : entry.parameters) {
    if (equals == word.npos) offered.push_back(parameter.name + "=");
    if (word.substr(0, equals) != parameter.name) continue;
    for (const std::string& choice : parameter.choices) offered.push_back(parameter.name + "=" + choice);
  }
  return offered;
}

std::vector<std::string> channels_of(const ModelEntry& entry, const std::string& word) {
  const std::size_t comma = word.rfind(',');
  const std::string before = comma == word.npos ? "" : word.substr(0, comma + 1);
  const System system = entry.build(Parameters(entry.name, entry.parameters)).model.build();
  std::vector<std::string> offered;
  for (const Channel& channel : all_channels(system)) offered.push_back(before + channel.name());
  return offered;
}

std::vector<std::string> values_of(const OptionEntry& option, const TypedModel& model,
                                   const std::string& word) {
  const std::string name = option.name;
  if (name == "--method" || name == "--methods") return names_of(methods());
  if (!option.choices.empty()) return option.choices;
  if (name == "--record" && model.entry) return channels_of(*model.entry, word);
  if (name == "--run" && model.file) return model.file->run_names();
  return {};
}

std::vector<std::string> offered_for(const std::vector<std::string>& words) {
  const auto& table = commands();
  std::vector<std::string> offered;
  if (words.size() < 2) {
    for (const CommandEntry& command : table) offered.push_back(command.name);
    offered.insert(offered.end(), {"--help", "--version"});
    return offered;
  }
  const auto command = std::find_if(table.begin(), table.end(),
                                    [&](const CommandEntry& entry) { return entry.name == words.front(); });
  if (command == table.end()) return {};
  const std::string& word = words.back();
  const TypedModel model = model_in(words);
  // The option that the word belongs to: the one before it, or before the words before it.
  const auto option = std::find_if(words.rbegin() + 1, words.rend(),
                                   [](const std::string& text) { return text.starts_with("--"); });
  if (word.starts_with("-")) {
    for (const OptionEntry& entry : command->options) offered.push_back(entry.name);
    if (command->takes_model) offered.push_back("--set");
    if (command->has_json) offered.push_back("--json");
    offered.insert(offered.end(), {"--quiet", "--help"});
    return offered;
  }
  if (option != words.rend() && (*option == "--set" || *option == "--vary") && model.entry)
    return settings_of(*model.entry, word);
  for (const OptionEntry& entry : command->options) {
    if (option == words.rend() || entry.name != *option) continue;
    if (entry.values == OptionEntry::Values::none) break;
    if (option == words.rbegin() + 1 || entry.values == OptionEntry::Values::words)
      return values_of(entry, model, word);
  }
  if (command->takes_model && !model.entry)
    for (const ModelEntry& entry : ready_made_models()) offered.push_back(entry.name);
  return offered;
}

/// Plugins named before the last word: the model file may need them. What is wrong with them the command
/// says.
void load_named_plugins(const std::vector<std::string>& words) {
  const std::string option = "--plugin";
  for (std::size_t i = 0; i + 1 < words.size(); ++i) try {
      if (words[i].starts_with(option + "=")) load_plugins(split(words[i].substr(option.size() + 1), ','));
      if (words[i] == option && i + 2 < words.size()) load_plugins(split(words[i + 1], ','));
    } catch (const ModelError&) {
    }
}

}  // namespace

std::vector<std::string> completions(const std::vector<std::string>& words) {
  load_named_plugins(words);
  std::vector<std::string> offered = offered_for(words);
  const std::string word = words.empty() ? "" : words.back();
  std::erase_if(offered, [&](const std::string& text) { return !text.starts_with(word); });
  return offered;
}

}  // namespace drev::app
