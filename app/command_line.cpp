#include "app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <iostream>
#include <sstream>

#include "app/commands.hpp"
#include "app/exit_codes.hpp"
#include "app/help_texts.hpp"
#include "models/scene.hpp"

namespace drev::app {

namespace {

constexpr const char* kPlace = "command line";

/// What CLI11 fills; an option that was not given stays empty.
struct Raw {
  std::string model;
  std::vector<std::string> sets, records, methods;
  // More than one is an error.
  std::vector<std::string> method, step, tolerance, out, every, count, contact, limit, accuracy;
  bool json = false;
};

void add_text(CLI::App& sub, const std::string& option, std::vector<std::string>& target,
              const std::string& type, const std::string& meaning) {
  sub.add_option(option, target, meaning)->option_text(type)->allow_extra_args(false);
}

void add_model_options(CLI::App& sub, Raw& raw) {
  sub.allow_extras();  // unknown options are reported with the nearest right one
  sub.add_option("MODEL", raw.model, "Name of the model; drev list shows them")->option_text(" ");
  sub.add_option("--set", raw.sets, "Changes settings; as often as needed")
      ->option_text("NAME=VALUE ...");
  sub.add_flag("--json", raw.json, "Prints one JSON object and nothing else");
}

void add_run_options(CLI::App& sub, Raw& raw) {
  add_model_options(sub, raw);
  add_text(sub, "--method", raw.method, "METHOD",
           "Time integration; default: what suits the model; see below");
  add_text(sub, "--step", raw.step, "SECONDS", "Time step; default: the model's");
  add_text(sub, "--tolerance", raw.tolerance, "T",
           "Relative: of exact, default 1e-10; of any other method, whose steps it controls");
  add_text(sub, "--accuracy", raw.accuracy, "A",
           "Finds the figures to the relative error A and states the error of each");
  add_text(sub, "--out", raw.out, "DIR", "Creates DIR with history.csv and summary.json");
  add_text(sub, "--record", raw.records, "CHANNEL,...",
           "Columns of history.csv; default: the model's");
  add_text(sub, "--every", raw.every, "SECONDS",
           "Interval of history.csv; default: about duration / 1000");
}

void add_modes_options(CLI::App& sub, Raw& raw) {
  add_model_options(sub, raw);
  add_text(sub, "--count", raw.count, "N", "Elastic modes; default: 10, or all if fewer");
  add_text(sub, "--contact", raw.contact, "STATE", "Contacts: closed (default) or open");
}

void add_chart_options(CLI::App& sub, Raw& raw) {
  add_model_options(sub, raw);
  sub.add_option("--methods", raw.methods, "Methods drawn; default: all that fit the model")
      ->option_text("METHOD ...");
  add_text(sub, "--limit", raw.limit, "SECONDS",
           "Processor time of the longest run drawn; default: 1");
  add_text(sub, "--out", raw.out, "DIR",
           "Creates DIR with chart.csv, error_over_time.svg and error_over_work.svg");
}

std::vector<std::string> option_names(const CLI::App& sub) {
  std::vector<std::string> names;
  for (const CLI::Option* option : sub.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

bool looks_like_option(const std::string& text) {
  return text.size() > 1 && text[0] == '-' && !std::isdigit(static_cast<unsigned char>(text[1])) &&
         text[1] != '.';
}

/// "; did you mean ..." or the command that has the option.
std::string option_hint(const std::string& name, const CLI::App& sub) {
  for (const CLI::App* other : sub.get_parent()->get_subcommands({}))
    if (other->get_option_no_throw(name) != nullptr)
      return "; drev " + other->get_name() + " has it";
  return did_you_mean(name, option_names(sub));
}

/// What stands on the command line and is known to nobody.
void report_extras(const std::vector<std::string>& extras, const CLI::App& sub,
                   std::vector<Finding>& findings) {
  bool unknown_option = false;
  for (const std::string& extra : extras) {
    if (!looks_like_option(extra)) continue;
    unknown_option = true;
    const std::string name = extra.substr(0, extra.find('='));
    findings.push_back({kPlace, "option", name, "",
                        "is no option of drev " + sub.get_name() + option_hint(name, sub)});
  }
  if (unknown_option) return;  // the other words may be its values
  for (const std::string& extra : extras)
    findings.push_back({kPlace, "argument", extra, "",
                        extra.find('=') == std::string::npos ? "is one too many"
                                                             : "must be written --set " + extra});
}

/// --set a=1 MODEL: the model came to stand among the settings.
void find_model_among_sets(Raw& raw) {
  if (!raw.model.empty()) return;
  const auto found = std::find_if(raw.sets.begin(), raw.sets.end(), [](const std::string& text) {
    return text.find('=') == std::string::npos;
  });
  if (found == raw.sets.end()) return;
  raw.model = *found;
  raw.sets.erase(found);
}

void take_sets(const Raw& raw, CommandLine& line) {
  for (const std::string& text : raw.sets) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      line.findings.push_back({kPlace, "--set", text, "", "must be name=value"});
      continue;
    }
    const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
    const auto same = std::find_if(line.settings.begin(), line.settings.end(),
                                   [&](const auto& setting) { return setting.first == name; });
    if (same != line.settings.end())
      line.findings.push_back({kPlace, "--set", text, "", "was set already, to " + same->second});
    else
      line.settings.emplace_back(name, value);
  }
}

void take_text(const std::string& option, const std::vector<std::string>& given,
               std::optional<std::string>& target, std::vector<Finding>& findings) {
  if (given.size() > 1) {
    findings.push_back({kPlace, option, given[1], "", "was given already, as " + given[0]});
    return;
  }
  for (const std::string& value : given) {
    if (value.empty() || value.starts_with("--"))
      findings.push_back({kPlace, option, value, "", "needs a value"});
    else
      target = value;
  }
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

void take_records(const Raw& raw, CommandLine& line) {
  if (raw.records.empty()) return;
  line.record.emplace();
  for (const std::string& list : raw.records)
    for (const std::string& name : split(list)) {
      if (name.empty() || name.starts_with("--"))
        line.findings.push_back({kPlace, "--record", list, "", "must be CHANNEL,CHANNEL,..."});
      else if (std::count(line.record->begin(), line.record->end(), name) > 0)
        line.findings.push_back({kPlace, "--record", name, "", "is named twice"});
      else
        line.record->push_back(name);
    }
}

void take_methods(const Raw& raw, CommandLine& line) {
  if (raw.methods.empty()) return;
  line.methods.emplace();
  for (const std::string& name : raw.methods) {
    if (name.empty() || name.starts_with("--"))
      line.findings.push_back({kPlace, "--methods", name, "", "must be a method"});
    else if (std::count(line.methods->begin(), line.methods->end(), name) > 0)
      line.findings.push_back({kPlace, "--methods", name, "", "is named twice"});
    else
      line.methods->push_back(name);
  }
}

int no_command(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  if (words.empty()) {
    std::cerr << "drev: no command given; it is one of run, modes, list, chart. drev --help says more.\n";
    return kBadInput;
  }
  const std::string& word = words.front();
  std::cerr << "drev: '" << word << "' is no "
            << (looks_like_option(word) ? "option of drev itself" : "command");
  std::vector<std::string> models;
  for (const SceneEntry& entry : scenes()) models.push_back(entry.name);
  if (std::find(models.begin(), models.end(), word) != models.end())
    std::cerr << "; did you mean 'drev run " << word << "'?\n";
  else if (looks_like_option(word))
    std::cerr << did_you_mean(word, {"--help", "--version"}) << "\n";
  else
    std::cerr << (word == "help" ? "; did you mean --help?"
                                 : did_you_mean(word, {"run", "modes", "list", "chart"}))
              << "\nThe commands are run, modes, list, chart.\n";
  return kBadInput;
}

}  // namespace

ParsedCommandLine parse_command_line(int argc, char** argv) {
  CLI::App app("drev: torsional dynamics of drivetrains", "drev");
  app.set_version_flag("--version", "drev " DREV_VERSION);
  app.allow_extras();
  app.footer(std::string(kMainExamples) + "\n" + kExitCodesHelp);
  Raw raw;
  CLI::App* run = app.add_subcommand("run", "Simulates a model in time and prints what it found");
  add_run_options(*run, raw);
  run->footer(std::string(kMethodsHelp) + "\n" + kRunExamples + "\n" + kExitCodesHelp);
  CLI::App* modes = app.add_subcommand("modes", "Natural frequencies of a model");
  add_modes_options(*modes, raw);
  modes->footer(kModesExamples);
  CLI::App* list = app.add_subcommand("list", "The models; or one model's settings and channels");
  add_model_options(*list, raw);
  list->footer(kListExamples);
  CLI::App* chart =
      app.add_subcommand("chart", "Error of the methods against run time and work, on one model");
  add_chart_options(*chart, raw);
  chart->footer(std::string(kMethodsHelp) + "\n" + kChartExamples);
  try {
    app.parse(argc, argv);
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
  if (chosen.empty()) return {.exit_code = no_command(app)};

  const CLI::App& sub = *chosen.front();
  find_model_among_sets(raw);
  CommandLine line{.model = raw.model, .json = raw.json};
  line.command = &sub == run     ? CommandLine::Command::run
                 : &sub == modes ? CommandLine::Command::modes
                 : &sub == chart ? CommandLine::Command::chart
                                 : CommandLine::Command::list;
  if (chosen.size() > 1)
    line.findings.push_back(
        {kPlace, "command", chosen[1]->get_name(), "", "is a second one; give one command"});
  for (const std::string& word : app.remaining())
    line.findings.push_back({kPlace, looks_like_option(word) ? "option" : "argument", word, "",
                             "must stand after the command " + sub.get_name()});
  report_extras(sub.remaining(), sub, line.findings);
  take_sets(raw, line);
  take_text("--method", raw.method, line.method, line.findings);
  take_text("--step", raw.step, line.step, line.findings);
  take_text("--tolerance", raw.tolerance, line.tolerance, line.findings);
  take_text("--out", raw.out, line.out, line.findings);
  take_text("--every", raw.every, line.every, line.findings);
  take_text("--count", raw.count, line.count, line.findings);
  take_text("--contact", raw.contact, line.contact, line.findings);
  take_text("--accuracy", raw.accuracy, line.accuracy, line.findings);
  take_text("--limit", raw.limit, line.limit, line.findings);
  take_records(raw, line);
  take_methods(raw, line);
  return {.command = std::move(line)};
}

}  // namespace drev::app
