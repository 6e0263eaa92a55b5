#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/json_values.hpp"
#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/option_values.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/results/run_json.hpp"

namespace drev::app {

namespace {

struct ModesRequest {
  ModelRequest model;
  ModesOptions options;
};

ModesRequest request_modes(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  ModesOptions options;
  if (line.option("--contact") == "open") options.contact = Contact::open;
  std::optional<int> elastic;
  if (model) elastic = model->system.size() - model->system.rigid_mode_count(options.contact);
  if (const auto count = line.option("--count"))
    options.count = read_count("--count", *count, elastic, ", the model's elastic modes", findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  return {std::move(*model), options};
}

/// Seven digits, or those that rounding leaves and its error.
std::string frequency_text(double frequency, double error) {
  constexpr int kDigits = 7;
  const double known = error > 0.0 ? std::floor(std::log10(frequency / error)) : kDigits;
  if (known >= kDigits) return pad_left(digits(frequency, kDigits), 17);
  return pad_left(digits(frequency, std::max(1, static_cast<int>(known))), 17) + " +- " + digits(error, 1);
}

std::string as_text(const ModelRequest& model, const ModeSet& modes, const std::string& contact) {
  const std::string& name = model.entry->name;
  std::string text = name + ": " + wrap(parameters_text(model.parameters), name.size() + 2);
  text += "contacts " + contact + ", " + std::to_string(modes.rigid_modes) +
          (modes.rigid_modes == 1 ? " rigid mode (0 Hz)\n\n" : " rigid modes (0 Hz)\n\n");
  if (modes.frequency_Hz.empty()) return text + "no elastic mode\n";
  text += "mode   frequency [Hz]\n";
  for (std::size_t i = 0; i < modes.frequency_Hz.size(); ++i)
    text +=
        pad_left(std::to_string(i + 1), 4) + frequency_text(modes.frequency_Hz[i], modes.error_Hz[i]) + "\n";
  if (!model.model_case.note.empty()) text += "\n" + wrap(model.model_case.note, 0);
  return text;
}

}  // namespace

int modes_command(const CommandLine& line) {
  const ModesRequest request = request_modes(line);
  const ModeSet modes = solve_modes(request.model.system, request.options);
  const std::string contact = request.options.contact == Contact::closed ? "closed" : "open";
  if (line.json) {
    Json object = result_object("modes");
    object["model"] = request.model.entry->name;
    object["parameters"] = parameters_object(request.model.parameters);
    object["frequencies_Hz"] = modes.frequency_Hz;
    object["errors_Hz"] = modes.error_Hz;
    object["rigid_modes"] = modes.rigid_modes;
    object["contact"] = contact;
    object["note"] = text_or_null(request.model.model_case.note);
    print(json_text(object));
  } else {
    print(as_text(request.model, modes, contact));
  }
  return kSuccess;
}

}  // namespace drev::app
