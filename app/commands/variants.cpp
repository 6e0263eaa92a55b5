#include "app/commands/variants.hpp"

#include <algorithm>

#include "app/base/text_layout.hpp"
#include "app/cli/model_option.hpp"
#include "app/commands/run_request.hpp"
#include "app/variants/quasi_random.hpp"
#include "app/variants/variant_plan.hpp"

namespace drev::app {

namespace {

constexpr double kMostVariants = 10000;     // folders
constexpr std::uint64_t kMostTried = 1000;  // variants that are built in search of one that can be

CommandLine with_parameters(const CommandLine& line, const ParameterValues& values) {
  CommandLine one = line;
  one.parameters.insert(one.parameters.end(), values.begin(), values.end());
  return one;
}

/// The run's duration with these values of parameters; nullopt: the model cannot be built.
std::optional<double> duration_with(const ModelRequest& base, const ParameterValues& values) {
  try {
    Parameters parameters = base.parameters;
    for (const auto& [name, value] : values) parameters.set(name, value);
    parameters.check();
    return base.entry->build(parameters).duration;
  } catch (const ModelError&) {
    return {};
  }
}

/// A varied parameter that sets the duration of the runs has no effect with --duration, and its column would say what
/// no run had.
void check_duration_varied(const CommandLine& line, const VariantList& variants,
                           std::vector<Finding>& findings) {
  if (!line.option("--duration")) return;
  std::vector<Finding> told;  // request_run() says it
  const std::optional<ModelRequest> base = build_model(line, told);
  if (!told.empty()) return;
  // The first and the last variant differ in every parameter that has several values. One that has a single value may
  // have it already; then the value of --duration shows whether it is the duration.
  const ParameterValues first = variants.parameters(0), last = variants.parameters(variants.count - 1);
  for (std::size_t p = 0; p < first.size(); ++p) {
    const std::string& name = first[p].first;
    bool moved = false;
    for (const std::string& value : {first[p].second, last[p].second, *line.option("--duration")}) {
      const auto duration = duration_with(*base, {{name, value}});
      moved = moved || (duration && *duration != base->model_case.duration);
    }
    if (moved)
      findings.push_back({kCommandLine, "--vary", name, "",
                          "is the duration of the runs, which --duration gives to all: give one of them"});
  }
}

/// The first variant whose model can be built.
std::optional<ParameterValues> buildable_variant(const CommandLine& line, const VariantList& variants) {
  std::vector<Finding> findings;
  const std::optional<ModelRequest> base = build_model(line, findings);
  if (!findings.empty()) return {};
  const std::uint64_t tried = std::min(variants.count, kMostTried);
  for (std::uint64_t k = 0; k < tried; ++k) {
    // One of each part of a long list, in no regular distance, which could be that of a bad value.
    const std::uint64_t first = k * variants.count / tried, end = (k + 1) * variants.count / tried;
    const ParameterValues values = variants.parameters(first + hashed(k, variants.count) % (end - first));
    try {
      Parameters parameters = base->parameters;
      for (const auto& [name, value] : values) parameters.set(name, value);
      parameters.check();
      base->entry->build(parameters).model.build();
      return values;
    } catch (const ModelError&) {  // of this variant
    }
  }
  return {};
}

}  // namespace

std::string Variant::name() const {
  std::vector<std::string> parts;
  for (const auto& [name, value] : parameters) parts.push_back(name + "=" + value);
  return join(parts, ",");
}

std::vector<Variant> read_variants(const std::vector<std::string>& words, std::vector<Finding>& findings) {
  const std::size_t before = findings.size();
  const VariantPlan plan(read_varied(words, kMostVariants, findings), {}, {}, findings);
  if (findings.size() > before) return {Variant{}};
  std::vector<Variant> variants;
  for (std::uint64_t i = 0; i < plan.count(); ++i) variants.push_back({plan.parameters(i)});
  return variants;
}

RunRequest request_variant(const CommandLine& line, const VariantList& variants) {
  CommandLine asked = line;
  check_duration_varied(line, variants, asked.findings);
  try {
    return request_run(with_parameters(asked, variants.parameters(0)));
  } catch (const ModelError&) {
    const auto values = asked.findings.empty() ? buildable_variant(asked, variants) : std::nullopt;
    if (!values) throw;
    return request_run(with_parameters(asked, *values));
  }
}

}  // namespace drev::app
