#include <drev/core/channel.hpp>

#include <algorithm>

#include "app/base/json_values.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/element_list.hpp"

namespace drev::app {

namespace {

std::string models_as_text() {
  std::size_t width = 0;
  for (const ModelEntry& entry : ready_made_models()) width = std::max(width, entry.name.size() + 2);
  std::string text;
  for (const ModelEntry& entry : ready_made_models())
    text += pad_right(entry.name, width) + wrap(entry.summary, width);
  return text + "\ndrev list MODEL shows a model's parameters and channels.\n";
}

std::string models_as_json() {
  Json list = Json::array();
  for (const ModelEntry& entry : ready_made_models())
    list.push_back({{"name", entry.name}, {"summary", entry.summary}});
  return json_text({{"models", std::move(list)}});
}

/// Nodes and elements that have the same quantities, together: "angle_rad, speed_rad_per_s: a, b, c".
std::string channels_as_text(const System& system) {
  std::vector<std::pair<std::string, std::vector<std::string>>> quantities;  // of every object
  for (const Channel& channel : all_channels(system)) {
    const std::size_t dot = channel.name().rfind('.');
    const std::string object = channel.name().substr(0, dot);
    if (quantities.empty() || quantities.back().first != object) quantities.push_back({object, {}});
    quantities.back().second.push_back(channel.name().substr(dot + 1));
  }
  std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> groups;
  for (const auto& [object, names] : quantities) {
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&, &wanted = names](const auto& g) { return g.first == wanted; });
    if (same == groups.end())
      groups.push_back({names, {object}});
    else
      same->second.push_back(object);
  }
  std::string text;
  for (const auto& [names, objects] : groups)
    text += "  ." + join(names, ", .") + " of\n      " + wrap(join(objects), 6);
  return text;
}

bool has_kind(const System& system, NodeKind kind) {
  for (int i = 0; i < system.node_count(); ++i)
    if (system.node_kind(i) == kind) return true;
  return false;
}

std::string model_as_text(const ModelRequest& model) {
  const ModelEntry& entry = *model.entry;
  std::size_t name = 0, standard = 9, range = 0;  // "default" and two blanks
  const auto default_of = [](const Parameter& s) {
    return s.default_text + (s.unit.empty() ? "" : " " + s.unit);
  };
  for (const Parameter& s : entry.parameters) {
    name = std::max(name, s.name.size() + 2);
    standard = std::max(standard, default_of(s).size() + 2);
    if (s.range().size() < 32) range = std::max(range, s.range().size() + 2);
  }
  std::string text = entry.name + ": " + wrap(entry.summary, entry.name.size() + 2);
  if (!entry.parameters.empty())
    text += "\n" + pad_right("Parameter", name + 2) + pad_right("default", standard) +
            pad_right("range", range) + "meaning\n";
  const std::size_t indent = 2 + name + standard + range;
  for (const Parameter& s : entry.parameters) {
    text += "  " + pad_right(s.name, name) + pad_right(default_of(s), standard);
    if (s.range().size() + 2 > range)
      text += s.range() + "\n" + std::string(indent, ' ');
    else
      text += pad_right(s.range(), range);
    text += wrap(s.meaning, indent);
  }
  text += "\nSimulated: " + short_digits(model.model_case.duration, 6) +
          " s; where a method with constant steps is chosen, in steps of " +
          short_digits(model.model_case.default_step, 4) + " s.\n";
  if (model.file && !model.file->run_names().empty())
    text += "Runs, named by --run: " + join(model.file->run_names()) + ".\n";
  text +=
      "\nChannels recorded unless --record says otherwise:\n  " + wrap(join(model.model_case.channels), 2);
  text += "Channels that can be recorded, written NAME.quantity:\n" + channels_as_text(model.system);
  if (has_kind(model.system, NodeKind::rotational))
    text += "  NODE-NODE.twist_rad: the first node's angle less the second's\n";
  if (has_kind(model.system, NodeKind::translational))
    text += "  NODE-NODE.distance_m: the first node's position less the second's\n";
  if (!model.model_case.note.empty()) text += "\n" + wrap(model.model_case.note, 0);
  return text;
}

std::string kind_text(Parameter::Kind kind) {
  switch (kind) {
    case Parameter::Kind::number:
      return "number";
    case Parameter::Kind::integer:
      return "integer";
    case Parameter::Kind::choice:
      return "choice";
    case Parameter::Kind::order:
      return "order";
  }
  return "";
}

Json setting_as_json(const Parameter& s) {
  const bool numeric = s.kind == Parameter::Kind::number || s.kind == Parameter::Kind::integer;
  return {{"name", s.name},
          {"kind", kind_text(s.kind)},
          {"unit", text_or_null(s.unit)},
          {"default", parameter_value(s, s.default_text)},
          {"range", s.range()},
          {"low", numeric ? number(s.low) : Json()},
          {"high", numeric ? number(s.high) : Json()},
          {"choices", s.choices},
          {"meaning", s.meaning}};
}

std::string model_as_json(const ModelRequest& model) {
  Json object;
  object["model"] = model.entry->name;
  object["summary"] = model.entry->summary;
  object["parameters"] = Json::array();
  for (const Parameter& s : model.entry->parameters) object["parameters"].push_back(setting_as_json(s));
  object["runs"] = model.file ? Json(model.file->run_names()) : Json::array();
  object["duration_s"] = number(model.model_case.duration);
  object["default_step_s"] = number(model.model_case.default_step);
  object["default_channels"] = model.model_case.channels;
  object["channels"] = Json::array();
  for (const Channel& c : all_channels(model.system))
    object["channels"].push_back({{"name", c.name()}, {"unit", c.unit()}});
  object["note"] = text_or_null(model.model_case.note);
  return json_text(object);
}

}  // namespace

int list_command(const CommandLine& line) {
  if (line.option("--elements") && line.model.empty() && line.findings.empty()) {
    print(line.json ? elements_as_json() : elements_as_text());
    return kSuccess;
  }
  if (line.model.empty() && line.parameters.empty() && line.findings.empty()) {
    print(line.json ? models_as_json() : models_as_text());
    return kSuccess;
  }
  const ModelRequest model = request_model(line);
  print(line.json ? model_as_json(model) : model_as_text(model));
  return kSuccess;
}

}  // namespace drev::app
