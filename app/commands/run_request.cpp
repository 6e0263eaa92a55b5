#include "app/commands/run_request.hpp"

#include <drev/core/channel.hpp>
#include <drev/solvers/accuracy/accuracy.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/reduction/reduction_choice.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/base/text_layout.hpp"
#include "app/cli/method_option.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/option_values.hpp"
#include "app/report/report_file.hpp"
#include "app/results/hdf5_file.hpp"
#include "app/run/excitation.hpp"
#include "app/run/run_up.hpp"
#include "solvers/stepping/stability_limit.hpp"

namespace drev::app {

namespace {

constexpr double kMostRows = 1e8;  // of one run
// Steps of one run, where --step says how long they are; where the method finds them only the fewest possible are known.
constexpr double kMostSteps = 1e10, kMostFoundSteps = 1e12;

/// About x, as 1, 2 or 5 times a power of ten.
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

/// The channels that an option asks for, by their names.
std::vector<std::string> read_channels(const char* option, OverRun integrals, const ModelRequest& model,
                                       const CommandLine& line, bool all_parameters_right,
                                       std::vector<Finding>& findings) {
  std::vector<std::string> names;
  if (!line.list(option)) return names;
  try {
    for (const Channel& channel : find_channels(model.system, *line.list(option), integrals))
      names.push_back(channel.name());
  } catch (const ModelError& error) {
    for (Finding finding : error.findings()) {
      if (!all_parameters_right) finding.range += " (with the parameters that are right)";
      findings.push_back(std::move(finding));
    }
  }
  return names;
}

/// A node that can turn without a nominal speed.
void check_orders_of(const ModelRequest& model, const CommandLine& line, std::vector<Finding>& findings) {
  const auto node = line.option("--orders-of");
  if (!node) return;
  const std::vector<std::string>& names = model.system.node_names();
  if (std::find(names.begin(), names.end(), *node) == names.end())
    findings.push_back({kCommandLine, "--orders-of", *node, "", "is none of the nodes"});
  else if (!turns_actually(model.system, model.model_case.duration))
    findings.push_back({kCommandLine, "--orders-of", *node, "",
                        "is for models in which nothing turns nominally, or whose reference shaft runs up "
                        "freely; orders are of the reference shaft"});
  else if (!turned_with(model.model_case.model, model.system, *node))
    findings.push_back(
        {kCommandLine, "--orders-of", *node, "", "cannot turn: it is held, or an element ties it to ground"});
}

/// The tolerance of exact propagation, or of controlled steps.
double read_tolerance(const CommandLine& line, bool exact, std::vector<Finding>& findings) {
  const auto text = line.option("--tolerance");
  if (!text) return exact ? ExactOptions{}.tolerance : 0.0;
  return read_plain("--tolerance", *text, exact ? ExactOptions::kTolerance : TransientOptions::kTolerance,
                    findings);
}

std::optional<double> read_accuracy(const CommandLine& line, std::vector<Finding>& findings) {
  const auto text = line.option("--accuracy");
  if (!text) return {};
  const double value = read_plain("--accuracy", *text, AccuracyOptions::kAccuracy, findings);
  const std::string why = "cannot be given with --accuracy, which finds it";
  if (const auto step = line.option("--step")) findings.push_back({kCommandLine, "--step", *step, "s", why});
  if (const auto tolerance = line.option("--tolerance"))
    findings.push_back({kCommandLine, "--tolerance", *tolerance, "", why});
  return value;
}

/// What error a reduction may add, as asked for.
std::optional<double> read_reduce(const CommandLine& line, std::vector<Finding>& findings) {
  const auto text = line.option("--reduce");
  if (!text || *text == "off") return {};
  if (line.option("--accuracy"))
    findings.push_back({kCommandLine, "--reduce", *text, "",
                        "cannot be given with --accuracy, whose figures are the whole model's"});
  return read_part("--reduce", *text, kReductionErrors, "off, or ", findings);
}

Start read_start(const CommandLine& line, Start model_start, std::vector<Finding>& findings) {
  const auto text = line.option("--start");
  if (!text) return model_start;
  if (const auto start = start_of(*text)) return *start;
  findings.push_back({kCommandLine, "--start", *text, "",
                      "must be rest, static or periodic" + did_you_mean(*text, start_names())});
  return Start::rest;
}

std::optional<Settle> read_settle(const CommandLine& line, const std::optional<Settle>& model_settle,
                                  double duration, const std::string& limit, std::vector<Finding>& findings) {
  const auto text = line.option("--settle");
  if (!text) return model_settle;
  if (*text == "auto") return Settle{};
  double value = 0.0;
  if (!read_number(*text, value) || !(value >= 0.0 && value < duration))
    findings.push_back({kCommandLine, "--settle", *text, "s",
                        "must be auto, or a time from 0 s to less than " +
                            (std::isfinite(duration) ? to_text(duration) + " s " : std::string("the ")) +
                            limit});
  return Settle{value};
}

/// A stepping method: with a tolerance, steps controlled by it; else constant ones. With --accuracy, methods
/// of an order above 2, which constant steps over contact changes would take from them, are controlled.
Method stepping(const std::string& name, const CommandLine& line, double step,
                std::vector<Finding>& findings) {
  const std::size_t before = findings.size();
  check_step_scheme("--method", name, findings);
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
  if (line.option("--method") && *line.option("--method") != kExact)
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
  if (model) check_exact("--method", model->system, findings);
  return {{.name = kExact, .tolerance = read_tolerance(line, true, findings)}, reason};
}

/// A run that no one could wait for, or whose steps rounding would spoil; any method may take its place where none was
/// asked for.
void check_duration(const System& system, bool any_method, MethodChoice& choice, double duration,
                    std::vector<Finding>& findings) {
  const Method& method = choice.method;
  if (least_steps(system, method, duration) <= kMostFoundSteps) return;
  if (any_method) choice = try_methods(system, choice, duration).choice;
  const double steps = least_steps(system, method, duration);
  if (steps <= kMostFoundSteps) return;
  const double longest = duration * kMostFoundSteps / steps;
  const double digit = std::pow(10.0, std::floor(std::log10(longest)) - 1.0);  // the second of it
  findings.push_back({kCommandLine, "--duration", to_text(duration), "s",
                      "is too long: " + to_text(method) + " would take at least " + short_digits(steps, 2) +
                          " steps, more than " + short_digits(kMostFoundSteps, 2) + "; take at most " +
                          short_digits(digit * std::floor(longest / digit), 2) + " s"});
}

/// Constant steps that grow without bound. A reduction, which takes the fastest motions away, is run as it is.
void check_stability(const System& system, const Method& method, std::vector<Finding>& findings) {
  if (method.exact() || method.controlled()) return;
  if (const auto why = why_unstable(system, step_scheme(method.name), method.step))
    findings.push_back({kCommandLine, "--step", to_text(method.step), "s", *why});
}

/// Options of the file's run that the command line leaves open. Any say on the method there is the whole say.
void take_file_options(const ModelFile& model, const Parameters& parameters, CommandLine& line) {
  const RunOptions file = model.run_options(parameters);
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
  for (const char* option : {"--start", "--settle", "--out"}) take(option);
  if (const auto at = file.places.find("--duration"); at != file.places.end() && !given("--duration"))
    line.from_file["--duration"] = at->second.text() + ": run";  // the model has the value
  if (const auto at = file.places.find("--step"); at != file.places.end() && !given("--step"))
    line.from_file["--step"] = at->second.text() + ": run";
  if (given("--out") || given("--report") || line.keeps_history) take("--every");
}

/// The same of a file whose model cannot be built, so that what is wrong with its run is said at once.
void take_options_of_refused(CommandLine& line) try {
  if (const auto file = open_model_file(line, line.option("--run").value_or("")))
    take_file_options(*file, Parameters(file->entry().name, file->entry().parameters), line);
} catch (const ModelError&) {
  // build_model() says it
}

/// Gives the model the duration asked for. Where a parameter is the duration, it has this value then, so that what is
/// stated as parameters is what was run.
void set_duration(ModelRequest& model, double asked, std::vector<Finding>& findings) {
  constexpr const char* kParameter = "duration_s";
  const auto& known = model.parameters.known();
  const bool has = std::any_of(known.begin(), known.end(), [](const Parameter& p) {
    return p.name == kParameter && p.kind == Parameter::Kind::number;
  });
  if (has && model.parameters.number(kParameter) == model.model_case.duration) try {
      Parameters parameters = model.parameters;
      parameters.set(kParameter, short_digits(asked, 17));
      parameters.check();
      ModelCase model_case = model.entry->build(parameters);
      if (model_case.duration == asked) {
        model.system = model_case.model.build();
        model.model_case = std::move(model_case);
        model.parameters = std::move(parameters);
        return;
      }
    } catch (const ModelError& error) {
      for (Finding finding : error.findings()) {
        if (finding.parameter == kParameter) finding.place = kCommandLine, finding.parameter = "--duration";
        findings.push_back(std::move(finding));
      }
    }
  model.model_case.duration = asked;
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

/// What is wrong with where results go, and in which form.
void check_outputs(const CommandLine& line, const std::vector<std::string>& read,
                   std::vector<Finding>& findings) {
  for (const char* option : {"--record", "--every", "--format"})
    if (!line.option("--out") && !line.option("--report") && line.list(option) &&
        (!line.keeps_history || option == std::string("--format")))
      findings.push_back(
          {kCommandLine, option, "", "", "needs --out DIR or --report FILE, where to write the channels"});
  if (const auto jobs = line.option("--jobs"))
    findings.push_back({kCommandLine, "--jobs", *jobs, "", "is for several runs"});
  if (line.option("--format") && line.option("--report") && !line.option("--out"))
    findings.push_back({kCommandLine, "--format", "", "", "needs --out DIR"});
  if (const auto out = line.option("--out"))
    for (const char* name :
         {"/history.csv", "/history.h5", "/waterfall.csv", "/summary.json", "/report.html"})
      check_output("--out", *out + name, read, findings);
  if (const auto events = line.option("--events")) {
    check_output("--events", *events, read, findings);
    if (!events->ends_with(".csv"))
      findings.push_back({kCommandLine, "--events", *events, "", "must be the name of a .csv file"});
  }
  if (const auto report = line.option("--report")) {
    check_output("--report", *report, read, findings);
    namespace fs = std::filesystem;
    const auto out = line.option("--out");
    if (const auto why = why_no_report(*report))
      findings.push_back({kCommandLine, "--report", *report, "", *why});
    else if (out &&
             fs::path(*report).lexically_normal() == (fs::path(*out) / "report.html").lexically_normal())
      findings.push_back({kCommandLine, "--report", *report, "", "is written by --out already"});
  }
}

}  // namespace

RunRequest request_run(const CommandLine& given) {
  CommandLine line = given;
  std::vector<Finding> findings = line.findings;
  const std::size_t before = findings.size();
  std::optional<ModelRequest> model = build_model(line, findings);
  if (model && model->file) take_file_options(*model->file, model->parameters, line);
  if (!model) take_options_of_refused(line);
  const bool parameters_right = findings.size() == before;

  if (const auto text = line.option("--duration")) {
    constexpr Range kDuration{1e-12, 1e12};
    const double asked = read_time("--duration", *text, kDuration, "", findings);
    if (model && kDuration.holds(asked)) set_duration(*model, asked, findings);
  }
  const double duration = model ? model->model_case.duration : 1.0;
  const std::string limit = model ? "(the run's duration)" : "run's duration";
  const double high = model ? duration : HUGE_VAL;
  const std::size_t before_method = findings.size();
  MethodChoice method = find_method(model, line, findings);
  const std::optional<double> accuracy = read_accuracy(line, findings);
  const bool any_method =
      !line.option("--method") && !line.option("--step") && !line.option("--tolerance") && !accuracy;
  Method& chosen = method.method;
  if (line.option("--step") && !chosen.exact())
    chosen.step = read_time("--step", *line.option("--step"), {duration / kMostSteps, high}, limit, findings);
  if (model && findings.size() == before_method)
    check_duration(model->system, any_method, method, duration, findings);
  const std::optional<double> reduce = read_reduce(line, findings);
  if (model && findings.size() == before_method && line.option("--method") && !accuracy && !reduce)
    check_stability(model->system, chosen, findings);
  const Start start = read_start(line, model ? model->model_case.start : Start::rest, findings);
  const std::optional<Settle> settle =
      read_settle(line, model ? model->model_case.settle : std::nullopt, high, limit, findings);
  double every = model ? round_number(duration / 1000) : 0.0;
  if (line.option("--every"))
    every = read_time("--every", *line.option("--every"), {duration / kMostRows, high}, limit, findings);
  check_outputs(line, model ? model->model_case.files : std::vector<std::string>{}, findings);
  std::vector<std::string> record, rainflow;
  if (model) {
    record = read_channels("--record", OverRun::taken, *model, line, parameters_right, findings);
    rainflow = read_channels("--rainflow", OverRun::refused, *model, line, parameters_right, findings);
  }
  if (model && !line.list("--record")) record = model->model_case.channels;
  const std::vector<std::string> formats = line.list("--format").value_or(std::vector<std::string>{});
  const bool hdf5 = std::count(formats.begin(), formats.end(), "hdf5") > 0;
  if (hdf5) {
    std::vector<std::string> columns{"time_s"};
    columns.insert(columns.end(), record.begin(), record.end());
    if (const auto why = why_no_hdf5(columns))
      findings.push_back({kCommandLine, "--format", "hdf5", "", "cannot have all columns: " + *why});
  }
  if (model) check_orders_of(*model, line, findings);
  blame_file(line, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  return {std::move(*model),
          chosen,
          accuracy,
          method.reason,
          any_method,
          reduce,
          any_method && !line.option("--reduce"),
          line.option("--out"),
          std::move(record),
          every,
          hdf5,
          line.option("--report"),
          line.option("--every") ? std::optional(every) : std::nullopt,
          line.model + (line.option("--run") ? " --run " + *line.option("--run") : ""),
          start,
          settle,
          line.option("--duration") ? std::optional(duration) : std::nullopt,
          line.option("--events"),
          line.keeps_history,
          std::move(rainflow),
          line.options.contains("--energy"),
          line.option("--orders-of").value_or("")};
}

}  // namespace drev::app
