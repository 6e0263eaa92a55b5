#pragma once
/// The combinations of --vary as runs of their own, each with a folder (app/variants/varied.hpp has the values' form),
/// and the run that says what is asked for of all variants.
#include <drev/core/error.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/command_line.hpp"
#include "app/run/run_request.hpp"

namespace drev::app {

struct Variant {
  std::vector<std::pair<std::string, std::string>> parameters;
  /// "backlash_mm=0.1,engine_rpm=750"; empty without parameters.
  std::string name() const;
};

/// Every combination, the last parameter varying fastest; one Variant without parameters where there are no
/// words.
std::vector<Variant> read_variants(const std::vector<std::string>& words, std::vector<Finding>& findings);

/// The parameters of variant i of `count`.
struct VariantList {
  std::uint64_t count = 1;
  std::function<ParameterValues(std::uint64_t)> parameters = [](std::uint64_t) { return ParameterValues{}; };
};

/// The run that the line asks for, with the parameters of the first variant; if these are bad, with those of one that
/// can be built, since a bad variant has its place among the results and says nothing of the others. If there is none
/// among all (of more than 1000: among 1000 of them in equal parts of the list), or the model cannot be built without
/// these parameters, throws ModelError with everything that is wrong with the first one.
RunRequest request_variant(const CommandLine& line, const VariantList& variants);

}  // namespace drev::app
