#include "app/cli/command_line.hpp"

#include <drev/core/version.hpp>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <sstream>

#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/help_texts.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"

namespace drev::app {

namespace {

/// What CLI11 fills; an option that was not given stays empty.
struct Raw {
  std::string model;
  std::vector<std::string> models;  ///< where there can be several
  std::vector<std::string> sets;
  std::map<std::string, std::vector<std::string>> options;
  bool json = false, quiet = false;
};

void add_options(CLI::App& sub, const CommandEntry& command, Raw& raw) {
  sub.allow_extras();  // unknown options are reported with the nearest right one
  if (command.takes_model) {
    std::string meaning = "Name of the model, as drev list shows them, or a model file, FILE.toml";
    if (command.takes_models) meaning += ",\nor several, or directories of files, with --out";
    if (command.takes_models)
      sub.add_option("MODEL", raw.models, meaning)->option_text("...");
    else
      sub.add_option("MODEL", raw.model, meaning)->option_text(" ");
  }
  if (command.takes_model || command.takes_sets)
    sub.add_option("--set", raw.sets, "Changes parameters; as often as needed")
        ->option_text("NAME=VALUE ...");
  CLI::Option* quiet = sub.add_flag("--quiet", raw.quiet, "Prints nothing but what is wrong");
  if (command.has_json)
    sub.add_flag("--json", raw.json, "Prints one JSON object and nothing else")->excludes(quiet);
  for (const OptionEntry& option : command.options)
    if (option.values == OptionEntry::Values::none)
      sub.add_flag_callback(
          option.name, [&given = raw.options[option.name]] { given = {"given"}; }, option.meaning);
    else
      sub.add_option(option.name, raw.options[option.name], option.meaning)
          ->option_text(option.type)
          ->allow_extra_args(option.values == OptionEntry::Values::words);
  sub.footer(command.footer);
}

/// The option that is meant by one that does not exist: the first that begins so, else the nearest. The dashes, which all
/// have, make none nearer. Empty: there is none.
std::string meant_option(const std::string& name, const CLI::App& sub) {
  const std::string bare = name.substr(std::min(name.find_first_not_of('-'), name.size()));
  std::vector<std::string> names;
  for (const CLI::Option* option : sub.get_options())
    for (const std::string& known : option->get_lnames()) names.push_back(known);
  const auto longer = std::find_if(names.begin(), names.end(),
                                   [&](const std::string& known) { return known.starts_with(bare); });
  const std::string meant = longer != names.end() ? *longer : nearest_name(bare, names);
  return meant.empty() ? meant : "--" + meant;
}

bool looks_like_option(const std::string& text) {
  return text.size() > 1 && text[0] == '-' && !std::isdigit(static_cast<unsigned char>(text[1])) &&
         text[1] != '.';
}

/// "; did you mean ..." or the command that has the option.
std::string option_hint(const std::string& name, const CLI::App& sub) {
  const std::string meant = meant_option(name, sub);
  const std::string question = meant.empty() ? meant : "; did you mean '" + meant + "'?";
  for (const CLI::App* other : sub.get_parent()->get_subcommands({}))
    if (other->get_option_no_throw(name) != nullptr)
      return (meant.starts_with(name) ? question + " (" : "; ") + "drev " + other->get_name() + " has " +
             (meant.starts_with(name) ? name + ")" : "it");
  return question;
}

/// How a NAME=VALUE behind no option must be written: by the option that the ones before it belong to (--vary A=1:2 B=3:4), or
/// by --set.
std::string must_be_written(const std::string& word, const std::vector<std::string>& words) {
  const auto has_no_equals = [](const std::string& before) { return before.find('=') == std::string::npos; };
  const std::reverse_iterator end(std::find(words.begin(), words.end(), word));
  const auto option = std::find_if(end, words.rend(), [&](const std::string& before) {
    return looks_like_option(before) || has_no_equals(before);
  });
  const bool belongs = option != words.rend() && option != end && looks_like_option(*option);
  return "must be written " + (belongs ? option->substr(0, option->find('=')) : "--set") + " " + word;
}

/// What stands on the command line and is known to nobody.
void report_extras(const std::vector<std::string>& extras, const CLI::App& sub,
                   const std::vector<std::string>& words, std::vector<Finding>& findings) {
  bool unknown_option = false;
  for (const std::string& extra : extras) {
    if (!looks_like_option(extra)) continue;
    unknown_option = true;
    const std::string name = extra.substr(0, extra.find('='));
    findings.push_back({kCommandLine, "option", name, "",
                        "is no option of drev " + sub.get_name() + option_hint(name, sub)});
  }
  if (unknown_option) return;  // the other words may be its values
  for (const std::string& extra : extras)
    findings.push_back(
        {kCommandLine, "argument", extra, "",
         extra.find('=') == std::string::npos ? "is one too many" : must_be_written(extra, words)});
}

bool names_model(const std::string& word) {
  std::error_code error;
  return is_built_in(word) || std::filesystem::exists(word, error);
}

/// A word behind an option that does not exist is its value rather than one of several models.
void drop_values_of_unknown(const std::vector<std::string>& words, const std::vector<std::string>& extras,
                            Raw& raw) {
  for (const std::string& extra : extras) {
    const auto option = std::find(words.begin(), words.end(), extra);
    if (!looks_like_option(extra) || extra.find('=') != extra.npos || words.end() - option < 2) continue;
    const auto value = std::find(raw.models.begin(), raw.models.end(), *(option + 1));
    if (raw.models.size() > 1 && value != raw.models.end()) raw.models.erase(value);
  }
}

/// --set a=1 MODEL: models came to stand among the parameters.
void find_models_among_sets(Raw& raw, bool several) {
  for (auto set = raw.sets.begin(); set != raw.sets.end();) {
    if (set->find('=') == std::string::npos && (raw.models.empty() || (several && names_model(*set)))) {
      raw.models.push_back(*set);
      set = raw.sets.erase(set);
    } else {
      ++set;
    }
  }
}

/// MODEL a=1: a parameter without --set.
void find_sets_among_models(Raw& raw, const std::vector<std::string>& words, std::vector<Finding>& findings) {
  std::erase_if(raw.models, [&](const std::string& word) {
    const bool set = word.find('=') != std::string::npos && !names_model(word);
    if (set) findings.push_back({kCommandLine, "argument", word, "", must_be_written(word, words)});
    return set;
  });
}

void take_sets(const Raw& raw, CommandLine& line) {
  for (const std::string& text : raw.sets) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      line.findings.push_back({kCommandLine, "--set", text, "", "must be name=value"});
      continue;
    }
    const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
    const auto same = std::find_if(line.parameters.begin(), line.parameters.end(),
                                   [&](const auto& parameter) { return parameter.first == name; });
    if (same != line.parameters.end())
      line.findings.push_back({kCommandLine, "--set", text, "", "was set already, to " + same->second});
    else
      line.parameters.emplace_back(name, value);
  }
}

/// False, and a finding, if an option has choices and the value is none of them.
bool check_choice(const OptionEntry& option, const std::string& value, std::vector<Finding>& findings) {
  const std::vector<std::string>& choices = option.choices;
  if (choices.empty() || std::count(choices.begin(), choices.end(), value) > 0) return true;
  findings.push_back({kCommandLine, option.name, value, "",
                      "must be " + join(choices, " or ") + did_you_mean(value, choices)});
  return false;
}

/// A name that ends as a file does is no directory's: the option is of another command, or its value meant otherwise.
bool names_file(const OptionEntry& option, const std::string& value) {
  return option.type == std::string("DIR") && (value.ends_with(".csv") || value.ends_with(".json") ||
                                               value.ends_with(".html") || value.ends_with(".pdf"));
}

void take_option(const OptionEntry& option, const std::vector<std::string>& given, CommandLine& line) {
  const auto report = [&](const std::string& value, const std::string& why) {
    line.findings.push_back({kCommandLine, option.name, value, "", why});
  };
  if (given.empty()) return;
  std::vector<std::string>& taken = line.options[option.name];
  if (option.values == OptionEntry::Values::none) {
    taken = given;
    return;
  }
  if (option.values == OptionEntry::Values::one) {
    if (given.size() > 1)
      report(given[1], "was given already, as " + given[0]);
    else if (given[0].empty() || given[0].starts_with("--"))
      report(given[0], "needs a value");
    else if (names_file(option, given[0]))
      report(given[0], "must be the name of a directory, which several files are written into");
    else if (check_choice(option, given[0], line.findings))
      taken = given;
    if (taken.empty()) line.options.erase(option.name);
    return;
  }
  const bool commas = option.values == OptionEntry::Values::commas;
  for (const std::string& text : given)
    for (const std::string& name : commas ? split(text, ',') : std::vector{text}) {
      if (name.empty() || name.starts_with("--"))
        report(text, std::string("must be ") + option.type);
      else if (std::count(taken.begin(), taken.end(), name) > 0)
        report(name, "is named twice");
      else
        check_choice(option, taken.emplace_back(name), line.findings);
    }
}

std::vector<std::string> names_of(const std::vector<CommandEntry>& commands) {
  std::vector<std::string> names;
  for (const CommandEntry& command : commands) names.push_back(command.name);
  return names;
}

int no_command(const CLI::App& app, const std::vector<CommandEntry>& commands) {
  const std::vector<std::string> words = app.remaining();
  if (words.empty()) {
    std::cerr << "drev: no command given; it is one of " << join(names_of(commands))
              << ". drev --help says more.\n";
    return kBadInput;
  }
  const std::string& word = words.front();
  std::cerr << "drev: '" << word << "' is no "
            << (looks_like_option(word) ? "option of drev itself" : "command");
  if (is_built_in(word))
    std::cerr << "; did you mean 'drev run " << word << "'?\n";
  else if (looks_like_option(word))
    std::cerr << did_you_mean(word, {"--help", "--version"}) << "\n";
  else
    std::cerr << (word == "help" ? "; did you mean --help?" : did_you_mean(word, names_of(commands)))
              << "\nThe commands are " << join(names_of(commands)) << ".\n";
  return kBadInput;
}

}  // namespace

bool blamed(const std::vector<Finding>& findings, const std::string& option) {
  return std::any_of(findings.begin(), findings.end(),
                     [&](const Finding& finding) { return finding.parameter == option; });
}

ParsedCommandLine parse_command_line(int argc, char** argv, const std::vector<CommandEntry>& commands) {
  CLI::App app("drev: torsional dynamics of drivetrains", "drev");
  app.set_version_flag("--version", "drev " DREV_VERSION);
  app.allow_extras();
  app.footer(std::string(kMainExamples) + "\n" + kExitCodesHelp);
  Raw raw;
  for (const CommandEntry& command : commands)
    add_options(*app.add_subcommand(command.name, command.summary), command, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string said = error.what();
    std::cerr << "drev: " << kCommandLine << ": " << said.substr(0, said.find(':')) << ", needs a value\n";
    return {.exit_code = kBadInput};
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // help, version
      std::ostringstream text;
      app.exit(error, text, text);
      print(text.str());
      return {};
    }
    std::cerr << "drev: " << error.what() << "\nRun with --help for more information.\n";
    return {.exit_code = kBadInput};
  }
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  if (chosen.empty()) return {.exit_code = no_command(app, commands)};

  const CLI::App& sub = *chosen.front();
  const CommandEntry& command =
      *std::find_if(commands.begin(), commands.end(),
                    [&](const CommandEntry& entry) { return entry.name == sub.get_name(); });
  CommandLine line{.command = &command, .json = raw.json, .quiet = raw.quiet};
  if (!raw.model.empty()) raw.models = {raw.model};
  const std::vector<std::string> words(argv, argv + argc);
  drop_values_of_unknown(words, sub.remaining(), raw);
  find_models_among_sets(raw, command.takes_models);
  find_sets_among_models(raw, words, line.findings);
  if (!raw.models.empty()) line.model = raw.models.front();
  if (command.takes_models) line.options["MODEL"] = raw.models;
  if (chosen.size() > 1)
    line.findings.push_back(
        {kCommandLine, "command", chosen[1]->get_name(), "", "is a second one; give one command"});
  for (const std::string& word : app.remaining())
    line.findings.push_back({kCommandLine, looks_like_option(word) ? "option" : "argument", word, "",
                             word == "help"
                                 ? "is no command; did you mean 'drev " + sub.get_name() + " --help'?"
                                 : "must stand after the command " + sub.get_name()});
  report_extras(sub.remaining(), sub, words, line.findings);
  take_sets(raw, line);
  for (const OptionEntry& option : command.options) take_option(option, raw.options[option.name], line);
  return {.command = std::move(line)};
}

}  // namespace drev::app
