#include <drev/core/version.hpp>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <thread>

#include "app/base/csv_cell.hpp"
#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/base/progress.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/cli/model_option.hpp"
#include "app/cli/option_values.hpp"
#include "app/cli/print.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/run_variants.hpp"
#include "app/variants/optimum.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kTold = 10;        // of the best variants
constexpr std::size_t kFailedTold = 20;  // of those that failed, as text

struct OptimumRequest {
  VariantStudy study;
  OptimumOptions options;
};

/// Which figure, and whether its largest value is meant.
std::pair<std::string, bool> goal_of(const CommandLine& line, std::vector<Finding>& findings) {
  const auto least = line.option("--minimise"), largest = line.option("--maximise");
  if (least.has_value() == largest.has_value())
    findings.push_back({kCommandLine, "--minimise", "", "",
                        std::string(least ? "cannot be given with --maximise" : "or --maximise is needed") +
                            ": the figure meant, such as max_torque_Nm"});
  return {least ? *least : largest.value_or(""), largest.has_value()};
}

std::vector<std::string> names_of(const std::vector<FigureColumn>& figures) {
  std::vector<std::string> names;
  for (const FigureColumn& column : figures) names.push_back(column.name);
  return names;
}

/// Where something else is wrong: the figures that the model has with the parameters that are right. None: not known.
std::vector<std::string> figures_of_model(const CommandLine& line) {
  std::vector<Finding> told;
  const std::optional<ModelRequest> model = build_model(line, told);
  if (!model) return {};
  try {
    return names_of(figure_columns(model->model_case, model->system,
                                   line.list("--record").value_or(std::vector<std::string>{})));
  } catch (const ModelError&) {
    return {};
  }
}

OptimumRequest request_optimum(const CommandLine& line) {
  std::vector<Finding> findings;
  OptimumOptions options;
  const auto [figure, largest] = goal_of(line, findings);
  options.largest = largest;
  const auto count = [&](const char* option, int most, auto& value) {
    if (const auto text = line.option(option))
      value = static_cast<std::remove_reference_t<decltype(value)>>(
          read_count(option, *text, most, "", findings));
  };
  count("--variants", static_cast<int>(OptimumOptions::kMostVariants), options.variants);
  count("--seed", 1000000000, options.seed);
  options.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  count("--jobs", kMostThreads, options.threads);
  std::vector<Finding> of_words;  // study_of() says them
  double combinations = 1.0;
  for (const Varied& v :
       read_varied(line.list("--vary").value_or(std::vector<std::string>{}), 0.0, of_words)) {
    if (v.kind == Varied::Kind::normal)
      findings.push_back(
          {kCommandLine, "--vary", v.name + "=" + v.text, "", "has no bounds: give NAME=uniform(LOW,HIGH)"});
    combinations *= v.count() == 0 ? HUGE_VAL : static_cast<double>(v.count());
  }
  CommandLine asked = line;
  if (combinations > static_cast<double>(options.variants))
    asked.options["--sample"] = {"lhs:" + std::to_string(first_sample(options.variants)) + ":" +
                                 std::to_string(options.seed)};
  std::optional<VariantStudy> study;
  try {
    study.emplace(study_of(asked));
  } catch (const ModelError& error) {
    findings.insert(findings.begin(), error.findings().begin(), error.findings().end());
  }
  const std::vector<std::string> names = study ? names_of(study->figures()) : figures_of_model(line);
  if (const auto at = std::find(names.begin(), names.end(), figure); at != names.end())
    options.figure = static_cast<std::size_t>(at - names.begin());
  else if (!names.empty() && !figure.empty())
    findings.push_back({kCommandLine, largest ? "--maximise" : "--minimise", figure, "",
                        "is no figure of the model; there are " + join(names) + did_you_mean(figure, names) +
                            "; --record CHANNEL adds CHANNEL.max and CHANNEL.min"});
  if (!findings.empty()) throw ModelError(std::move(findings));
  return {std::move(*study), std::move(options)};
}

std::string values_text(const ParameterValues& values) {
  std::vector<std::string> parts;
  for (const auto& [name, text] : values) parts.push_back(name + "=" + text);
  return join(parts, " ");
}

/// The numbers of the variants that failed.
std::vector<std::size_t> failed_in(const Optimum& optimum) {
  std::vector<std::size_t> failed;
  for (std::size_t i = 0; i < optimum.tried.size(); ++i)
    if (optimum.tried[i].status != VariantStatus::success) failed.push_back(i);
  return failed;
}

/// How many of the variants that have the figure have a warning.
std::size_t warned_in(const Optimum& optimum) {
  return static_cast<std::size_t>(
      std::count_if(optimum.order.begin(), optimum.order.end(),
                    [&](std::size_t i) { return !optimum.tried[i].reason.empty(); }));
}

Json optimum_object(const OptimumRequest& request, const Optimum& optimum) {
  const FigureColumn& figure = request.study.figures()[request.options.figure];
  Json object{{"$schema", "urn:drev:optimum:1"}, {"kind", "optimum"}, {"drev", DREV_VERSION}};
  object["status"] = optimum.interrupted ? "interrupted" : optimum.order.empty() ? "failed" : "success";
  object["study"] = request.study.description();
  object["study"].erase("files");
  object["figure"] = figure.name;
  object["unit"] = figure.unit;
  object["goal"] = request.options.largest ? "largest" : "least";
  object["variants"] = optimum.tried.size();
  object["without_figure"] = optimum.tried.size() - optimum.order.size();
  object["with_warning"] = warned_in(optimum);
  object["all_combinations"] = optimum.all;
  object["best"] = Json::array();
  for (std::size_t i = 0; i < std::min(kTold, optimum.order.size()); ++i) {
    const TriedVariant& tried = optimum.tried[optimum.order[i]];
    object["best"].push_back({{"value", number(tried.figure)},
                              {"variant", optimum.order[i]},
                              {"varied", values_object(tried.values)},
                              {"warning", text_or_null(tried.reason)}});
  }
  object["failures"] = Json::array();
  const std::vector<std::size_t> failed = failed_in(optimum);
  for (std::size_t i = 0; i < std::min(kFailuresKept, failed.size()); ++i) {
    const TriedVariant& tried = optimum.tried[failed[i]];
    object["failures"].push_back({{"variant", failed[i]},
                                  {"status", status_text(tried.status)},
                                  {"varied", values_object(tried.values)},
                                  {"reason", tried.reason}});
  }
  return object;
}

/// Which variants failed and why.
std::string failures_text(const Optimum& optimum) {
  const std::vector<std::size_t> failed = failed_in(optimum);
  std::string text;
  for (std::size_t i = 0; i < std::min(kFailedTold, failed.size()); ++i) {
    const TriedVariant& tried = optimum.tried[failed[i]];
    text += wrap(values_text(tried.values) + ": " + status_text(tried.status) + ": " + tried.reason, 2);
  }
  if (failed.size() > kFailedTold)
    text += "  " + std::to_string(failed.size() - kFailedTold) +
            " more failed; tried.csv of --out DIR lists all\n";
  return text;
}

/// Which variants were computed.
std::string extent_text(const OptimumRequest& request, const Optimum& optimum) {
  if (optimum.all) return "all combinations";
  if (request.study.plan().sampling()) return "by a Latin hypercube and a search from its best";
  return "interrupted before all " + std::to_string(request.study.plan().count()) +
         " combinations were computed";
}

/// Whether the best variant is certain to be the best of all.
std::string certainty_text(const OptimumRequest& request, const Optimum& optimum) {
  if (!optimum.all && request.study.plan().sampling())
    return std::string("no: a search proves nothing; see whether another --seed finds ") +
           (request.options.largest ? "more" : "less");
  if (!optimum.all) return "no: nothing is known of the combinations that were not computed";
  if (const std::size_t warned = warned_in(optimum); warned > 0)
    return "no: " + std::to_string(warned) + " of the " + std::to_string(optimum.tried.size()) +
           " combinations have a warning, marked with *";
  if (optimum.order.size() == optimum.tried.size()) return "yes: every combination was computed";
  return "among the " + std::to_string(optimum.order.size()) + " of " + std::to_string(optimum.tried.size()) +
         " combinations that have a figure; nothing is known of the rest";
}

std::string optimum_text(const OptimumRequest& request, const Optimum& optimum) {
  const FigureColumn& figure = request.study.figures()[request.options.figure];
  const std::string unit = figure.unit.empty() ? "" : " " + figure.unit;
  // "deflection_deg" has it in its name.
  std::string suffix = "_" + figure.unit;
  std::erase(suffix, ' ');
  const std::string in_head = figure.name.ends_with(suffix) ? "" : unit;
  std::string text;
  if (!optimum.order.empty())
    if (const TriedVariant& best = optimum.tried[optimum.order[0]]; !best.reason.empty())
      text += "*** WARNING: " + values_text(best.values) + ": " + best.reason + "\n\n";
  text += labelled("variants", std::to_string(optimum.tried.size()) + " of " + request.study.request().words +
                                   ", " + extent_text(request, optimum)) +
          labelled("method", to_text(request.study.request().method));
  const std::size_t failed = failed_in(optimum).size(),
                    none = optimum.tried.size() - optimum.order.size() - failed;
  if (failed > 0) text += labelled("failed", std::to_string(failed) + " of them") + failures_text(optimum);
  if (none > 0) text += labelled("without figure", std::to_string(none) + " of them, which succeeded");
  if (optimum.interrupted && !optimum.order.empty())
    text += labelled("interrupted", "this is the best so far");
  if (optimum.order.empty())
    return text + labelled("optimum", optimum.tried.empty() ? "none: no variant was computed"
                                                            : "none: no variant succeeded");
  const TriedVariant& best = optimum.tried[optimum.order[0]];
  const bool all_equal =
      optimum.order.size() > 1 && best.figure == optimum.tried[optimum.order.back()].figure;
  text += labelled((request.options.largest ? "largest " : "least ") + figure.name,
                   digits(best.figure, 8) + unit) +
          labelled("at", all_equal ? "any: all " + std::to_string(optimum.order.size()) + " have this figure"
                                   : values_text(best.values)) +
          labelled("certain", certainty_text(request, optimum)) + "\nThe best variants\n";
  std::vector<std::vector<std::string>> rows{{"parameters", figure.name + in_head}};
  for (std::size_t i = 0; i < std::min(kTold, optimum.order.size()); ++i) {
    const TriedVariant& tried = optimum.tried[optimum.order[i]];
    rows.push_back({values_text(tried.values) + (tried.reason.empty() ? "" : " *"), digits(tried.figure, 8)});
  }
  text += columns_text(rows);
  if (warned_in(optimum) > 0) text += "* with a warning, which tried.csv of --out DIR has\n";
  return text;
}

/// A row a variant, in the order of computation.
std::string tried_csv(const OptimumRequest& request, const Optimum& optimum) {
  std::string csv;
  for (const Varied& v : request.study.plan().varied()) csv += csv_cell(v.name) + ",";
  csv += "status," + csv_cell(request.study.figures()[request.options.figure].name) + ",reason\n";
  for (const TriedVariant& tried : optimum.tried) {
    for (const auto& [name, value] : tried.values) csv += csv_cell(value) + ",";
    csv += std::string(status_text(tried.status)) + ",";
    if (std::isfinite(tried.figure)) csv += short_digits(tried.figure, 17);
    csv += "," + csv_cell(tried.reason) + "\n";
  }
  return csv;
}

}  // namespace

int optimise_command(const CommandLine& line) {
  OptimumRequest request = request_optimum(line);
  watch_signals();
  Progress shown;
  request.options.go_on = [&](double part) {
    shown.update(part);
    return !interrupted();
  };
  const Optimum optimum = find_optimum(request.study, request.options);
  shown.clear();
  const Json object = optimum_object(request, optimum);
  if (const auto out = line.option("--out")) {
    create_directory(*out);
    write_file(*out, "tried", "csv", tried_csv(request, optimum));
    write_file(*out, "optimum", "json", json_text(object));
  }
  print(line.json ? json_text(object) : optimum_text(request, optimum));
  if (optimum.interrupted) {
    std::fprintf(stderr, "drev: interrupted; the optimum is that of the %zu variants computed so far\n",
                 optimum.tried.size());
    return kInterrupted;
  }
  return optimum.order.empty() ? kNotTrusted : kSuccess;
}

}  // namespace drev::app
