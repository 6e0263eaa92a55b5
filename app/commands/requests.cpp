#include "app/commands/requests.hpp"

#include <drev/core/channel.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/base/text_layout.hpp"
#include "app/report/report_file.hpp"

namespace drev::app {

namespace {

constexpr double kMostSteps = 1e10, kMostRows = 1e8;                 // of one run
constexpr double kLeastTolerance = 1e-15, kLargestTolerance = 1e-3;  // of exact propagation
constexpr double kLeastOfSteps = 1e-13, kLargestOfSteps = 0.1;       // of controlled steps
constexpr double kLeastAccuracy = 1e-12, kLargestAccuracy = 0.5;
constexpr double kLeastReduce = 1e-6, kLargestReduce = 0.5, kPartOfTolerance = 0.1;

void take_findings(const ModelError& error, std::vector<Finding>& findings) {
  findings.insert(findings.end(), error.findings().begin(), error.findings().end());
}

/// The parameters that are right; what is wrong with the others goes to findings.
Parameters right_settings(const ModelEntry& entry, const CommandLine& line, std::vector<Finding>& findings) {
  Parameters right(entry.name, entry.parameters);
  for (const auto& [name, value] : line.parameters) {
    Parameters probe(entry.name, entry.parameters);
    probe.set(name, value);
    try {
      probe.check();
      right.set(name, value);
    } catch (const ModelError& error) {
      take_findings(error, findings);
    }
  }
  return right;
}

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const ModelEntry& entry : ready_made_models()) names.push_back(entry.name);
  return names;
}

/// Null, and a finding, if there is no such built-in model.
const ModelEntry* find_built_in(const std::string& name, std::vector<Finding>& findings) {
  const std::vector<std::string> names = model_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return &ready_made_models()[static_cast<std::size_t>(found - names.begin())];
  const std::string hint = did_you_mean(name, names);
  // What is like no model may be the value of an option that does not exist.
  if (findings.empty() || !hint.empty())
    findings.push_back({kCommandLine, "MODEL", name, "",
                        "is no model" + (hint.empty() ? "; the models are " + join(names) : hint) +
                            (name.find('/') != name.npos ? "; a model file ends in .toml" : "")});
  return nullptr;
}

/// A finding if there is no such stepping method.
void check_method(const char* option, const std::string& text, std::vector<Finding>& findings) {
  const std::string form =
      "must be exact (without numbers: see --tolerance), average_acceleration, hht[:ALPHA], "
      "generalized_alpha[:RHO_INF], newmark:BETA,GAMMA, linear_acceleration, central_difference, "
      "bathe[:RHO_INF], tr_bdf2, sdirk4, rk4 or dormand_prince";
  try {
    if (!text.ends_with(':') && !text.ends_with(',')) {
      step_scheme(text);
      return;
    }
    findings.push_back({kCommandLine, option, text, "", form});
  } catch (const ModelError& error) {
    for (Finding finding : error.findings()) {
      finding.place = kCommandLine;
      finding.parameter = option + (" " + finding.parameter);
      if (finding.range.starts_with("is no method")) {
        std::vector<std::string> names = step_scheme_names();
        names.insert(names.begin(), "exact");
        finding.range = "is no method" + did_you_mean(text.substr(0, text.find(':')), names) + "; " + form;
      }
      findings.push_back(std::move(finding));
    }
  }
}

/// The model as far as it can be built; nothing if it cannot.
std::optional<ModelRequest> build_model(const CommandLine& line, std::vector<Finding>& findings) {
  if (line.model.empty()) {
    // An option that does not exist may have taken the model's name.
    if (findings.empty())
      findings.push_back(
          {kCommandLine, "MODEL", "", "", "is missing; the models are " + join(model_names())});
    return {};
  }
  try {
    std::shared_ptr<const ModelFile> file;
    std::shared_ptr<const ModelEntry> entry;
    if (is_model_file(line.model)) {
      file = std::make_shared<const ModelFile>(line.model, line.option("--run").value_or(""));
      entry = {file, &file->entry()};
    } else {
      entry = {std::shared_ptr<const void>(), find_built_in(line.model, findings)};
      if (!entry) return {};
      if (const auto run = line.option("--run"))
        findings.push_back(
            {kCommandLine, "--run", *run, "", "is for model files only; " + line.model + " is built in"});
    }
    Parameters parameters = right_settings(*entry, line, findings);
    ModelCase model_case = entry->build(parameters);
    System system = model_case.model.build();
    return ModelRequest{entry, file, std::move(parameters), std::move(model_case), std::move(system)};
  } catch (const ModelError& error) {
    take_findings(error, findings);
    return {};
  }
}

/// A time in s between low and high.
double read_time(const char* option, const std::string& text, double low, double high,
                 const std::string& limit, std::vector<Finding>& findings) {
  const std::string range = "must be between " + to_text(low) + " s and " +
                            (std::isfinite(high) ? to_text(high) + " s" : std::string("the")) +
                            (limit.empty() ? "" : " " + limit);
  double value = 0.0;
  if (!read_number(text, value))
    findings.push_back(
        {kCommandLine, option, text, "", "is not a plain number of seconds, such as 0.001; " + range});
  else if (!(value >= low && value <= high))
    findings.push_back({kCommandLine, option, text, "s", range});
  return value;
}

void check_channels(const ModelRequest& model, const CommandLine& line, bool all_settings_right,
                    std::vector<Finding>& findings) {
  if (!line.list("--record")) return;
  try {
    find_channels(model.system, *line.list("--record"));
  } catch (const ModelError& error) {
    for (Finding finding : error.findings()) {
      if (!all_settings_right) finding.range += " (with the parameters that are right)";
      findings.push_back(std::move(finding));
    }
  }
}

/// The tolerance of exact propagation, or of controlled steps.
double read_tolerance(const CommandLine& line, bool exact, std::vector<Finding>& findings) {
  if (!line.option("--tolerance")) return exact ? ExactOptions{}.tolerance : 0.0;
  const double low = exact ? kLeastTolerance : kLeastOfSteps;
  const double high = exact ? kLargestTolerance : kLargestOfSteps;
  double value = 0.0;
  if (!read_number(*line.option("--tolerance"), value) || !(value >= low && value <= high))
    findings.push_back({kCommandLine, "--tolerance", *line.option("--tolerance"), "",
                        "must be a number from " + short_digits(low, 3) + " to " + short_digits(high, 3)});
  return value;
}

/// What keeps the model from exact propagation.
void check_exact(const std::optional<ModelRequest>& model, const char* option,
                 std::vector<Finding>& findings) {
  if (!model) return;
  if (const std::optional<std::string> why = why_not_exact(model->system))
    findings.push_back({kCommandLine, option, "exact", "", "cannot be used: " + *why});
}

/// What `drev chart` draws unless told otherwise.
std::vector<std::string> chart_methods(const System& system) {
  std::vector<std::string> methods{"average_acceleration",
                                   "generalized_alpha:0.8",
                                   "bathe",
                                   "sdirk4",
                                   "rk4",
                                   "generalized_alpha:0.8@tolerance",
                                   "sdirk4@tolerance",
                                   "dormand_prince@tolerance",
                                   "central_difference"};
  if (!why_not_exact(system)) methods.insert(methods.begin(), "exact");
  return methods;
}

std::optional<double> read_accuracy(const CommandLine& line, std::vector<Finding>& findings) {
  if (!line.option("--accuracy")) return {};
  double value = 0.0;
  if (!read_number(*line.option("--accuracy"), value) ||
      !(value >= kLeastAccuracy && value <= kLargestAccuracy))
    findings.push_back({kCommandLine, "--accuracy", *line.option("--accuracy"), "",
                        "must be a number from " + short_digits(kLeastAccuracy, 3) + " to " +
                            short_digits(kLargestAccuracy, 3)});
  const std::string why = "cannot be given with --accuracy, which finds it";
  if (line.option("--step")) findings.push_back({kCommandLine, "--step", *line.option("--step"), "s", why});
  if (line.option("--tolerance"))
    findings.push_back({kCommandLine, "--tolerance", *line.option("--tolerance"), "", why});
  return value;
}

/// A part of one, as 0.01 or 1%.
double read_part(const char* option, const std::string& text, double low, double high,
                 const std::string& range, std::vector<Finding>& findings) {
  const bool percent = text.ends_with('%');
  double value = 0.0;
  const bool number = read_number(percent ? text.substr(0, text.size() - 1) : text, value);
  if (percent) value /= 100.0;
  if (!number || !(value >= low && value <= high))
    findings.push_back({kCommandLine, option, text, "", range});
  return value;
}

/// What error a reduction may add: as asked for; else a tenth of the tolerance of controlled steps that no
/// one asked for, which are what large models are run with.
std::optional<double> read_reduce(const CommandLine& line, const Method& method, bool any_method,
                                  std::vector<Finding>& findings) {
  const auto text = line.option("--reduce");
  if (!text) {
    if (!any_method || !method.controlled()) return {};
    return kPartOfTolerance * method.tolerance;
  }
  if (*text == "off") return {};
  if (line.option("--accuracy"))
    findings.push_back({kCommandLine, "--reduce", *text, "",
                        "cannot be given with --accuracy, whose figures are the whole model's"});
  return read_part("--reduce", *text, kLeastReduce, kLargestReduce,
                   "must be off, or from 0.0001% to 50%, or 1e-6 to 0.5", findings);
}

/// A stepping method: with a tolerance, steps controlled by it; else constant ones. With --accuracy, methods
/// of an order above 2, which constant steps over contact changes would take from them, are controlled.
Method stepping(const std::string& name, const CommandLine& line, double step,
                std::vector<Finding>& findings) {
  const std::size_t before = findings.size();
  check_method("--method", name, findings);
  Method method{.name = name, .tolerance = read_tolerance(line, false, findings)};
  if (line.option("--accuracy") && findings.size() == before && step_scheme(name).order() > 2)
    method.tolerance = kControlledTolerance;
  if (!method.controlled()) method.step = step;
  return method;
}

/// The method asked for, or the one that suits the model. --step alone asks for constant steps, --tolerance
/// alone for exact propagation, or controlled steps where that cannot be.
MethodChoice find_method(const std::optional<ModelRequest>& model, const CommandLine& line,
                         std::vector<Finding>& findings) {
  const double duration = model ? model->model_case.duration : 1.0;
  const double step = model ? std::min(model->model_case.default_step, duration) : 0.0;
  if (line.option("--method") && *line.option("--method") != "exact")
    return {stepping(*line.option("--method"), line, step, findings), "asked for"};
  if (line.option("--step") && line.option("--tolerance") && !line.option("--method")) {
    findings.push_back({kCommandLine, "--step", *line.option("--step"), "s",
                        "needs a --method with --tolerance, whose largest step it is"});
    return {};
  }
  if (line.option("--step") && !line.option("--method"))
    return {stepping("average_acceleration", line, step, findings), "the default where a step is asked for"};
  if (!line.option("--method") && !line.option("--tolerance"))
    return model ? choose_method(model->system, duration, step) : MethodChoice{};
  const std::string reason =
      line.option("--method") ? "asked for" : "the default where a tolerance is asked for";
  if (!line.option("--method") && model && why_not_exact(model->system))
    return {stepping("dormand_prince", line, step, findings), reason};
  if (line.option("--step"))
    findings.push_back({kCommandLine, "--step", *line.option("--step"), "s",
                        "has no meaning for --method exact, which finds its own; see --tolerance"});
  check_exact(model, "--method", findings);
  return {{.name = "exact", .tolerance = read_tolerance(line, true, findings)}, reason};
}

/// Options of the file's run that the command line leaves open. Any say on the method there is the whole say.
void take_file_options(const ModelRequest& model, CommandLine& line) {
  const RunOptions file = model.file->run_options(model.parameters);
  const auto given = [&](const char* option) { return line.options.contains(option); };
  const auto take = [&](const char* option) {
    const auto value = file.values.find(option);
    if (given(option) || value == file.values.end()) return;
    line.options[option] = {value->second};
    if (const auto at = file.places.find(option); at != file.places.end())
      line.from_file[option] = at->second.text() + ": run";
  };
  if (!given("--method") && !given("--step") && !given("--tolerance") && !given("--accuracy"))
    for (const char* option : {"--method", "--tolerance", "--accuracy"}) take(option);
  take("--out");
  if (given("--out") || given("--report")) take("--every");
}

/// What is wrong with such an option is wrong in the file.
void blame_file(const CommandLine& line, std::vector<Finding>& findings) {
  for (Finding& finding : findings) {
    const auto option = line.from_file.find(finding.parameter.substr(0, finding.parameter.find(' ')));
    if (finding.place != kCommandLine || option == line.from_file.end()) continue;
    finding.place = option->second;
    finding.parameter.erase(0, 2);
  }
}

[[noreturn]] void refuse(std::vector<Finding> findings) { throw ModelError(std::move(findings)); }

}  // namespace

double round_number(double x) {
  int exponent = static_cast<int>(std::floor(std::log10(x)));
  const double mantissa = x / std::pow(10.0, exponent);
  int digit = mantissa < 1.5 ? 1 : mantissa < 3.5 ? 2 : 5;
  if (mantissa >= 7.5) digit = 1, ++exponent;
  // Through text, for the double nearest to the decimal number.
  double value = 0.0;
  read_number(std::to_string(digit) + "e" + std::to_string(exponent), value);
  return value;
}

RunRequest request_run(const CommandLine& given) {
  CommandLine line = given;
  std::vector<Finding> findings = line.findings;
  const std::size_t before = findings.size();
  std::optional<ModelRequest> model = build_model(line, findings);
  if (model && model->file) take_file_options(*model, line);
  const bool settings_right = findings.size() == before;

  const double duration = model ? model->model_case.duration : 1.0;
  const std::string limit = model ? "(the run's duration)" : "run's duration";
  const double high = model ? duration : HUGE_VAL;
  const MethodChoice method = find_method(model, line, findings);
  Method chosen = method.method;
  if (line.option("--step") && !chosen.exact())
    chosen.step = read_time("--step", *line.option("--step"), duration / kMostSteps, high, limit, findings);
  const std::optional<double> accuracy = read_accuracy(line, findings);
  const bool any_method =
      !line.option("--method") && !line.option("--step") && !line.option("--tolerance") && !accuracy;
  const std::optional<double> reduce = read_reduce(line, chosen, any_method, findings);
  double every = model ? round_number(duration / 1000) : 0.0;
  if (line.option("--every"))
    every = read_time("--every", *line.option("--every"), duration / kMostRows, high, limit, findings);
  for (const char* option : {"--record", "--every", "--format"})
    if (!line.option("--out") && !line.option("--report") && line.list(option))
      findings.push_back(
          {kCommandLine, option, "", "", "needs --out DIR or --report FILE, where to write the channels"});
  if (const auto jobs = line.option("--jobs"))
    findings.push_back({kCommandLine, "--jobs", *jobs, "", "is for several runs"});
  if (line.option("--format") && line.option("--report") && !line.option("--out"))
    findings.push_back({kCommandLine, "--format", "", "", "needs --out DIR"});
  if (const auto report = line.option("--report")) {
    namespace fs = std::filesystem;
    const auto out = line.option("--out");
    if (const auto why = why_no_report(*report))
      findings.push_back({kCommandLine, "--report", *report, "", *why});
    else if (out &&
             fs::path(*report).lexically_normal() == (fs::path(*out) / "report.html").lexically_normal())
      findings.push_back({kCommandLine, "--report", *report, "", "is written by --out already"});
  }
  bool hdf5 = false;
  for (const std::string& format : line.list("--format").value_or(std::vector<std::string>{})) {
    hdf5 = hdf5 || format == "hdf5";
    if (format != "csv" && format != "hdf5")
      findings.push_back({kCommandLine, "--format", format, "",
                          "must be csv or hdf5" + did_you_mean(format, {"csv", "hdf5"})});
  }
  if (model) check_channels(*model, line, settings_right, findings);
  blame_file(line, findings);
  if (!findings.empty()) refuse(std::move(findings));
  std::vector<std::string> record = line.list("--record").value_or(model->model_case.channels);
  return {std::move(*model),
          chosen,
          accuracy,
          method.reason,
          any_method,
          reduce,
          line.option("--out"),
          std::move(record),
          every,
          hdf5,
          line.option("--report"),
          line.option("--every") ? std::optional(every) : std::nullopt,
          line.model + (line.option("--run") ? " --run " + *line.option("--run") : "")};
}

ModesRequest request_modes(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  ModesOptions options;
  static const std::vector<std::string> states{"closed", "open"};
  const std::string contact = line.option("--contact").value_or("closed");
  options.contact = contact == "open" ? Contact::open : Contact::closed;
  if (contact != "open" && contact != "closed")
    findings.push_back(
        {kCommandLine, "--contact", contact, "", "must be closed or open" + did_you_mean(contact, states)});
  if (line.option("--count")) {
    double number = 0.0;
    const int elastic = model ? model->system.size() - model->system.rigid_mode_count(options.contact) : 0;
    const std::string range =
        "must be a whole number from 1" +
        (model ? " to " + std::to_string(elastic) + ", the model's elastic modes" : std::string());
    if (!read_number(*line.option("--count"), number) || number != std::floor(number) || number < 1 ||
        (model ? number > elastic : number > 1e9))
      findings.push_back({kCommandLine, "--count", *line.option("--count"), "", range});
    else
      options.count = static_cast<int>(number);
  }
  if (!findings.empty()) refuse(std::move(findings));
  return {std::move(*model), options};
}

ChartRequest request_chart(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  for (const std::string& name : line.list("--methods").value_or(std::vector<std::string>{})) {
    const std::size_t at = name.find("@tolerance");
    if (name == "exact")
      check_exact(model, "--methods", findings);
    else
      check_method("--methods", at == name.npos ? name : name.substr(0, at), findings);
  }
  double limit = 1.0;
  if (line.option("--limit")) limit = read_time("--limit", *line.option("--limit"), 1e-3, 1e4, "", findings);
  if (!findings.empty()) refuse(std::move(findings));
  std::vector<std::string> methods = line.list("--methods").value_or(chart_methods(model->system));
  return {std::move(*model), std::move(methods), limit, line.option("--out")};
}

AdviseRequest request_advise(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  AdviseOptions options;
  options.figure = line.option("--for").value_or(options.figure);
  if (const std::optional<std::string> text = line.option("--within"))
    options.within =
        read_part("--within", *text, 1e-4, 0.5, "must be from 0.01% to 50%, or 1e-4 to 0.5", findings);
  if (model) try {
      figure_options(model->model_case, model->system, options);
    } catch (const ModelError& error) {
      for (Finding finding : error.findings()) {
        finding.place = kCommandLine;
        finding.parameter = "--for";
        findings.push_back(std::move(finding));
      }
    }
  if (!findings.empty()) refuse(std::move(findings));
  return {std::move(*model), options};
}

ModelRequest request_model(const CommandLine& line) {
  std::vector<Finding> findings = line.findings;
  std::optional<ModelRequest> model = build_model(line, findings);
  if (!findings.empty()) refuse(std::move(findings));
  return std::move(*model);
}

}  // namespace drev::app
