#include <drev/advice/advise.hpp>

#include "advice/recipe.hpp"
#include "app/base/interrupt.hpp"
#include "app/base/json_values.hpp"
#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/option_values.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"

namespace drev::app {

namespace {

struct AdviseRequest {
  ModelRequest model;
  AdviseOptions options;
};

AdviseRequest request_advise(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  AdviseOptions options{.pause = end_if_interrupted};
  options.figure = line.option("--for").value_or(options.figure);
  if (const std::optional<std::string> text = line.option("--within"))
    if (const double within = read_part("--within", *text, AdviseOptions::kWithin, "", findings);
        AdviseOptions::kWithin.holds(within))
      options.within = within;  // else it is blamed already, and the default stands in
  if (model) try {
      figure_options(model->model_case, model->system, options);
    } catch (const ModelError& error) {
      for (Finding finding : error.findings()) {
        finding.place = kCommandLine;
        finding.parameter = "--for";
        findings.push_back(std::move(finding));
      }
    }
  if (!findings.empty()) throw ModelError(std::move(findings));
  return {std::move(*model), options};
}

std::string parts(double part, int significant) { return short_digits(100.0 * part, significant); }

std::string rung_row(const Rung& rung, std::size_t width, bool chosen) {
  std::string row = (chosen ? "> " : "  ") + pad_right(rung.name, width);
  if (!rung.unsuitable.empty()) return row + "  cannot be used: " + rung.unsuitable + "\n";
  row += pad_left(digits(rung.value, 5), 13);
  row += rung.leaves_out.empty() ? pad_left("", 12) : pad_left(parts(rung.difference, 3), 12);
  row += " +- " + pad_right(parts(rung.difference_error, 2), 9);
  row += pad_left(short_digits(rung.cost, 2), 9);
  return row + (rung.holds ? "   yes\n" : "   no\n");
}

std::string as_text(const AdviseRequest& request, const Advice& advice) {
  const std::string& name = request.model.entry->name;
  std::string text = name + ": " + wrap(parameters_text(request.model.parameters), name.size() + 2) + "\n";
  std::size_t width = 5;
  for (const Rung& rung : advice.rungs) width = std::max(width, rung.name.size());
  text += "  " + pad_right("model", width) + pad_left("[" + advice.unit + "]", 13) +
          pad_left("off by [%]", 12) + pad_right("", 13) + pad_left("cost", 9) + "   holds\n";
  for (std::size_t i = 0; i < advice.rungs.size(); ++i)
    text += rung_row(advice.rungs[i], width, i == advice.chosen);
  text += "\n" + wrap(advice.sentence, 0);
  if (!advice.best().evidence.empty()) text += "\nEvidence: " + wrap(advice.best().evidence + ".", 10);
  for (const std::string& note : advice.notes) text += "\n" + wrap(note, 0);
  if (!request.model.model_case.note.empty()) text += "\n" + wrap(request.model.model_case.note, 0);
  return text;
}

Json as_json(const AdviseRequest& request, const Advice& advice) {
  Json object;
  object["model"] = request.model.entry->name;
  object["parameters"] = parameters_object(request.model.parameters);
  object["figure"] = advice.figure;
  object["unit"] = advice.unit;
  object["within"] = number(advice.within);
  object["statistic"] = advice.statistic;
  object["rungs"] = Json::array();
  for (const Rung& rung : advice.rungs) {
    const bool suits = rung.unsuitable.empty();
    const auto value = [&](double x) { return suits ? number(x) : Json(nullptr); };
    Json r;
    r["name"] = rung.name;
    r["leaves_out"] = text_or_null(rung.leaves_out);
    r["unsuitable"] = text_or_null(rung.unsuitable);
    r["value"] = value(rung.value);
    r["error"] = value(rung.error);
    r["difference"] = value(rung.difference);
    r["difference_error"] = value(rung.difference_error);
    r["seconds"] = value(rung.seconds);
    r["cost"] = value(rung.cost);
    r["method"] = suits && !rung.recipe->turns ? Json(to_text(rung.recipe->method)) : Json(nullptr);
    r["holds"] = rung.holds;
    r["evidence"] = text_or_null(rung.evidence);
    object["rungs"].push_back(std::move(r));
  }
  object["chosen"] = advice.best().name;
  object["advice"] = advice.sentence;
  object["notes"] = advice.notes;
  object["note"] = text_or_null(request.model.model_case.note);
  return object;
}

}  // namespace

int advise_command(const CommandLine& line) {
  const AdviseRequest request = request_advise(line);
  watch_signals();
  const Advice advice = advise(request.model.model_case, request.options);
  print(line.json ? json_text(as_json(request, advice)) : as_text(request, advice));
  return kSuccess;
}

}  // namespace drev::app
