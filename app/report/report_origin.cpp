#include "app/report/report_origin.hpp"

#include <drev/app/model_file/model_file.hpp>
#include <drev/core/version.hpp>

#include <chrono>
#include <ctime>

#include "app/report/report_model.hpp"

namespace drev::app {

namespace {

std::string now() {
  const std::time_t time = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  ::gmtime_r(&time, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
  return text;
}

}  // namespace

void add_origin(Json& data) {
  data["version"] = DREV_VERSION;
  data["made"] = now();
}

Json inputs_array(const Parameters& parameters, const VariedTexts& varied) {
  Json inputs = Json::array();
  for (std::size_t i = 0; i < parameters.known().size(); ++i) {
    const Parameter& parameter = parameters.known()[i];
    const auto text = varied.find(parameter.name);
    inputs.push_back({{"name", parameter.name},
                      {"value", text != varied.end() ? text->second : parameters.values()[i]},
                      {"varied", text != varied.end()},
                      {"default", parameter.default_text},
                      {"unit", parameter.unit},
                      {"range", parameter.range()},
                      {"meaning", parameter.meaning}});
  }
  return inputs;
}

std::string model_options(const Parameters& parameters, const VariedTexts& varied) {
  std::string text;
  for (std::size_t i = 0; i < parameters.known().size(); ++i)
    if (parameters.values()[i] != parameters.known()[i].default_text &&
        !varied.contains(parameters.known()[i].name))
      text += " --set " + parameters.known()[i].name + "=" + parameters.values()[i];
  for (const std::string& plugin : loaded_plugins()) text += " --plugin " + plugin;
  return text;
}

Json page_data(const std::string& kind, const std::string& title, const ModelRequest& model,
               const std::string& words, const VariedTexts& varied) {
  Json data;
  data["kind"] = kind;
  add_origin(data);
  data["command"] = words + model_options(model.parameters, varied);
  data["title"] = title;
  data["about"] = model.entry->summary.empty() ? model.model_case.note : model.entry->summary;
  data["model_name"] = model.entry->name;
  data["inputs"] = inputs_array(model.parameters, varied);
  data["model"] = model_object(model.model_case.model, model.system);
  return data;
}

}  // namespace drev::app
